//! The library of parts; what its parts mean is compared with descriptions written out, in
//! `tests/accepted/library_*`.

use super::{accept, refuse, warnings};

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
        assert!(
            inside || USES.iter().any(|source| called(&source)),
            "`{name}`"
        );
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
        text.contains("in `PointMass` `m` is in kg, this is in m"),
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
    let own = with("use parts; part Rod(x) { coord q; }");
    assert!(
        refuse(&own)
            .to_string()
            .contains("the library has a part `Rod`")
    );
}
