//! Coordinates without a unit that are angles all the same.

use super::weighed::derived;

#[test]
fn coordinates_of_which_sines_are_taken_are_angles_without_a_unit() {
    let source = "mechanism Test {
        const l = 2;
        coord a; coord b: 1; coord c: rad; coord d; coord x; coord y: m; coord e: 1;
        let along = a + b/2;
        kinetic 1/2*(der(a)^2 + der(b)^2 + der(c)^2 + der(d)^2 + der(x)^2 + der(e)^2)
              + 1/2*der(y)^2;
        potential x + sin(c) + e^2;
        constraint l*cos(along) = x;
        force tan(d)*x on x;
    }";
    let (mechanism, equations) = derived(source);
    let names: Vec<&str> = equations
        .unitless_angles(&mechanism)
        .iter()
        .map(|j| mechanism.coordinates[*j].name.as_str())
        .collect();
    assert_eq!(names, ["a", "b", "d"]);
}
