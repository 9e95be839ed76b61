//! The library of parts; what its parts mean is compared with descriptions written out, in
//! `tests/accepted/library_*`.

use super::{accept, refuse, warnings};
use bricard_codegen::internals::derive::derive;
use bricard_codegen::internals::expr::Symbol;
use std::f64::consts::PI;

const LIBRARY: &str = include_str!("../../src/parts.mech");
const USES: [&str; 2] = [
    include_str!("../accepted/library_plane.mech"),
    include_str!("../accepted/library_space.mech"),
];
const REFERENCE: &str = include_str!("../../../docs/language.md");

/// The names and the arguments of the parts of the library.
fn parts() -> Vec<(&'static str, &'static str)> {
    let heads = LIBRARY
        .lines()
        .filter_map(|line| line.strip_prefix("part "));
    let heads = heads.filter_map(|head| head.split_once('('));
    heads
        .filter_map(|(name, rest)| Some((name, rest.split_once(')')?.0)))
        .collect()
}

#[test]
fn the_library_has_no_mistakes_of_its_own() {
    let whole = format!("mechanism M {{ coord q; kinetic der(q)^2; {LIBRARY} }}");
    accept(&whole);
    assert!(parts().len() >= 20, "{} parts", parts().len());
}

#[test]
fn every_part_of_the_library_is_compared_with_what_is_written_by_hand() {
    for (name, _) in parts() {
        let called = |source: &&str| source.contains(&format!("= {name}("));
        // A part that another part of the library is made of.
        let inside = LIBRARY.contains(&format!("= {name}("));
        assert!(inside || USES.iter().any(called), "`{name}`");
    }
}

#[test]
fn every_part_of_the_library_is_documented_with_its_arguments() {
    for (name, arguments) in parts() {
        let names = arguments
            .split(',')
            .map(|a| a.split(':').next().unwrap_or_default().trim());
        let names: Vec<_> = names.collect();
        let row = format!("| `{name}({})` |", names.join(", "));
        assert!(REFERENCE.contains(&row), "no row {row}");
    }
}

#[test]
fn every_argument_of_the_library_that_has_a_dimension_has_its_unit() {
    let source = "mechanism M { use parts; param L: m = 1; coord x: m;
        let ball = PointMass([x, 0], L, [0, -9.81]); }";
    let text = refuse(source).render("m.mech", source);
    assert!(
        text.contains("the argument `m` of `PointMass` is in kg, this is in m"),
        "{text}"
    );
}

#[test]
fn a_finding_in_the_library_begins_with_the_place_of_its_use_and_shows_both() {
    let source = "mechanism M { use parts; coord x: m; param J: kg*m^2 = 1; kinetic J/2*der(x)^2/x^2;\n  let ball = PointMass(x, 2, [0, -9.81]); }";
    let text = refuse(source).render("m.mech", source);
    assert!(
        text.starts_with("m.mech:2:14: error: `norm2` takes a vector"),
        "{text}"
    );
    assert!(text.contains("kinetic 1/2*m*norm2(der(p));"), "{text}");
    assert!(text.contains("let ball = PointMass"), "{text}");
}

#[test]
fn the_library_is_known_where_it_is_used_and_nothing_in_it_is_warned_of() {
    let with = |use_it: &str| {
        format!(
            "mechanism M {{ {use_it} coord x: m; let ball = PointMass([x, 0], 2, [0, -9.81]); }}"
        )
    };
    let said = refuse(&with("")).to_string();
    assert!(said.contains("unknown function `PointMass`"), "{said}");
    assert_eq!(warnings(&with("use parts;")), "");
    let fixed = with("use parts; let rod = Rod([0, 0], [x, 0], 2, [0, -9.81]);");
    assert_eq!(warnings(&fixed), "", "an end may be fixed");
    let own = with("use parts; part Rod(x) { coord q; }");
    assert!(
        refuse(&own)
            .to_string()
            .contains("the library has a part `Rod`")
    );
}

/// What the Robotics Toolbox (P. Corke) prints at its nominal configuration, `p560.inertia(qn)`
/// in kg m² and `p560.gravload(qn)` in N m, to four places.
const PUMA_MASS: [[f64; 6]; 6] = [
    [3.6594, -0.4044, 0.1006, -0.0025, 0.0, 0.0],
    [-0.4044, 4.4137, 0.3509, 0.0, 0.0024, 0.0],
    [0.1006, 0.3509, 0.9378, 0.0, 0.0015, 0.0],
    [-0.0025, 0.0, 0.0, 0.1925, 0.0, 0.0],
    [0.0, 0.0024, 0.0015, 0.0, 0.1713, 0.0],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.1941],
];
const PUMA_GRAVITY: [f64; 6] = [0.0, 31.6399, 6.0351, 0.0, 0.0283, 0.0];

#[test]
fn a_puma_560_of_parts_has_the_inertia_and_the_gravity_load_of_the_robotics_toolbox() {
    puma_560_is_that_of_the_toolbox(include_str!("../accepted/puma_560.mech"));
}

#[test]
fn the_puma_560_among_the_benchmark_problems_has_them_too() {
    puma_560_is_that_of_the_toolbox(include_str!("../../../mechanisms/benchmarks/puma_560.mech"));
}

fn puma_560_is_that_of_the_toolbox(description: &str) {
    let mut m = accept(description);
    let equations = derive(&mut m).expect("equations of a usual length");
    let nominal = [0.0, 0.25 * PI, PI, 0.0, 0.25 * PI, 0.0];
    let defaults: Vec<f64> = m
        .parameters
        .iter()
        .map(|p| m.graph.constant_value(p.default).expect("a number"))
        .collect();
    let at = |symbol| match symbol {
        Symbol::Coordinate(i) => nominal[i as usize],
        Symbol::Parameter(i) => defaults[i as usize],
        _ => 0.0,
    };
    let mass = m.graph.evaluate_all(&equations.inertial(), &at);
    let force = m.graph.evaluate_all(&equations.force, &at);
    let places = |found: f64, printed: f64| (found - printed).abs() < 0.51e-4;
    for (found, printed) in mass.iter().zip(PUMA_MASS.as_flattened()) {
        assert!(places(*found, *printed), "{mass:?}");
    }
    for (found, printed) in force.iter().zip(PUMA_GRAVITY) {
        assert!(places(-found, printed), "{force:?}");
    }
}

/// Where the legs of the platform stand and what they hold, with the plate raised, from
/// trigonometry alone: feet and heads, by the number of the leg.
fn leg(i: u32) -> ([f64; 3], [f64; 3]) {
    let turn = if i.is_multiple_of(2) { 15.0 } else { -15.0 };
    let at = |radius: f64, angle: f64, z: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [radius * cos, radius * sin, z]
    };
    let angle = 60.0 * f64::from(i);
    (at(1.0, angle + turn, 0.0), at(0.6, angle - turn, 0.9))
}

#[test]
fn a_stewart_platform_of_parts_closes_at_the_distances_of_its_joints_and_at_no_others() {
    let mut m = accept(include_str!("../accepted/stewart_platform.mech"));
    let equations = derive(&mut m).expect("equations of a usual length");
    let plate = [0.0, 0.0, 0.9, 1.0, 0.0, 0.0, 0.0];
    let legs = (0..6).flat_map(|i| {
        let (foot, head) = leg(i);
        let [x, y, z] = [0, 1, 2].map(|k| head[k] - foot[k]);
        let length = (x * x + y * y + z * z).sqrt();
        [f64::atan2(-y, z), f64::asin(x / length), length]
    });
    let q: Vec<f64> = plate.into_iter().chain(legs).collect();
    assert_eq!(q.len(), m.coordinates.len());
    let largest = |q: &[f64]| {
        let at = |symbol| match symbol {
            Symbol::Coordinate(i) => q[i as usize],
            Symbol::Parameter(0) => 1.0,
            Symbol::Parameter(1) => 0.6,
            _ => 0.0,
        };
        let residual = m.graph.evaluate_all(&equations.residual, &at);
        residual
            .into_iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    assert!(largest(&q) < 1e-15, "{}", largest(&q));
    for leg in 0..6 {
        let mut longer = q.clone();
        longer[9 + 3 * leg] += 0.01;
        assert!(largest(&longer) > 1e-3, "leg {leg}");
    }
}
