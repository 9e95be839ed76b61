//! Connected components of constraints and the mass matrix.

use super::weighed::derived;
use bricard_codegen::internals::derive::ConnectedComponent;

/// The components of constraints on six coordinates, of which the mass matrix couples the third
/// and the fourth.
fn components(constraints: &str) -> Vec<ConnectedComponent> {
    let source = format!(
        "mechanism Test {{
            const w: 1/s = 1;
            coord a; coord b; coord c; coord d; coord e; coord f;
            kinetic 1/2*(der(a)^2 + der(b)^2 + der(c)^2 + der(c)*der(d)*cos(c - d) + der(d)^2
                         + der(e)^2 + der(f)^2);
            potential a*f + sin(d);
            {constraints}
        }}"
    );
    derived(&source).1.components
}

/// The coordinates and rows of each.
fn named(constraints: &str) -> Vec<(String, Vec<usize>)> {
    let name = |coordinate: &usize| char::from(b"abcdef"[*coordinate]);
    components(constraints)
        .iter()
        .map(|it| (it.coordinates.iter().map(name).collect(), it.rows.clone()))
        .collect()
}

fn expected(components: &[(&str, &[usize])]) -> Vec<(String, Vec<usize>)> {
    let own = components.iter();
    own.map(|(names, rows)| (names.to_string(), rows.to_vec()))
        .collect()
}

#[test]
fn constraints_and_masses_tie_coordinates_together_and_forces_do_not() {
    let two = "constraint sin(a) = c; constraint cos(b) = e; constraint c^2 = a;";
    let apart: [(&str, &[usize]); 3] = [("acd", &[0, 2]), ("be", &[1]), ("f", &[])];
    assert_eq!(named(two), expected(&apart));
    // A chain of rows ties what none of them ties alone.
    let chain = "constraint a = b; constraint e = d; constraint b = e;";
    let tied: [(&str, &[usize]); 2] = [("abcde", &[0, 1, 2]), ("f", &[])];
    assert_eq!(named(chain), expected(&tied));
}

#[test]
fn what_the_entries_of_a_row_depend_on_is_tied_too() {
    // A skate: its heading is in no entry of its own.
    let skate = "constraint der(a)*sin(f) = der(b)*cos(f);";
    let tied: [(&str, &[usize]); 3] = [("abf", &[0]), ("cd", &[]), ("e", &[])];
    assert_eq!(named(skate), expected(&tied));
    // What the velocity of a constraint depends on.
    let led = "constraint der(a) = w*d;";
    assert_eq!(named(led)[0], ("acd".to_string(), vec![0]));
}

#[test]
fn one_component_of_all_coordinates_is_none() {
    assert_eq!(components("constraint a*b*c = d + e*f;"), []);
    assert_eq!(components(""), []);
}

#[test]
fn each_component_knows_whether_it_stays_what_it_is() {
    let several = "constraint a = b; constraint c = d*(1 + w*t); constraint der(e) = f*w;";
    let still: Vec<bool> = components(several)
        .iter()
        .map(|it| it.scleronomic)
        .collect();
    assert_eq!(still, [true, false, false]);
}
