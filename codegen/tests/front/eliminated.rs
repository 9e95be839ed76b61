//! What goes and what stays where coordinates that constraints give are eliminated.

use super::accept;
use bricard_codegen::Builder;
use bricard_codegen::internals::derive::eliminate;
use bricard_codegen::internals::model::Mechanism;
use std::fs;
use std::path::Path;

/// A mechanism of two points and an angle, and more statements, with what can go gone.
fn less(statements: &str) -> Mechanism {
    let source = format!(
        "mechanism Test {{ param k = 2; coord x; coord y; coord z; coord phi;
         kinetic der(x)^2 + der(y)^2 + der(z)^2 + k*der(phi)^2; {statements} }}"
    );
    eliminate(accept(&source)).expect("equations of a usual length")
}

/// The names of the coordinates that are left.
fn left(statements: &str) -> Vec<String> {
    let coordinates = less(statements).coordinates;
    coordinates.into_iter().map(|q| q.name).collect()
}

/// What a declared coordinate is.
fn value(mechanism: &Mechanism, name: &str) -> String {
    let found = mechanism.described.iter().find(|c| c.quantity.name == name);
    let position = found.expect("it was declared").position;
    mechanism
        .graph
        .text(position, &|symbol| mechanism.symbol_text(symbol))
}

#[test]
fn a_coordinate_goes_if_a_constraint_is_linear_in_it_with_a_number() {
    assert_eq!(left("constraint x = sin(phi);"), ["y", "z", "phi"]);
    assert_eq!(
        left("constraint 2*x + 3*phi^2 = cos(t);"),
        ["y", "z", "phi"]
    );
    assert_eq!(
        left("constraint [x, y] = [cos(phi), sin(phi)];"),
        ["z", "phi"]
    );
}

#[test]
fn of_several_the_one_declared_last_goes() {
    assert_eq!(left("constraint x + y = z;"), ["x", "y", "phi"]);
}

#[test]
fn a_chain_goes_in_whatever_order_it_is_written() {
    for statements in [
        "constraint x = sin(phi); constraint y = x^2 + phi^3; constraint z = x*y + y;",
        "constraint z + sin(y) = x*phi + y^2; constraint y = x^2; constraint x = cos(phi);",
    ] {
        let mechanism = less(statements);
        let names: Vec<&str> = mechanism.coordinates.iter().map(|q| &*q.name).collect();
        assert_eq!(names, ["phi"], "{statements}");
        for coordinate in &mechanism.described {
            let symbols = mechanism.graph.symbols(coordinate.position);
            assert!(symbols.len() <= 1, "{statements}: {symbols:?}");
        }
    }
}

#[test]
fn what_may_vanish_or_is_no_position_or_is_held_stays() {
    let all = ["x", "y", "z", "phi"];
    for statements in [
        "constraint k*x = sin(phi) + x^2 + y^2 + z^2;",
        "constraint x*phi + y^2 = z^2;",
        "constraint der(x) = phi*der(y);",
        "constraint x = sin(phi); start { x = 0.5; phi ~ 0.5; }",
        "constraint x = sin(phi); start { der(x) = 0.5; }",
    ] {
        assert_eq!(left(statements), all, "{statements}");
    }
}

#[test]
fn a_guess_that_alone_tells_where_others_are_keeps_its_coordinate() {
    assert_eq!(left("constraint x = sin(phi); start { x ~ 0.5; }").len(), 4);
    assert_eq!(
        left("constraint x = sin(phi); start { x ~ 0.5; phi ~ 0.5; }").len(),
        3
    );
    assert_eq!(left("constraint x = sin(t); start { x ~ 0.5; }").len(), 3);
    assert_eq!(left("constraint x = sin(phi);").len(), 3);
}

#[test]
fn one_coordinate_stays_whatever_the_constraints_say() {
    let driven = "constraint x = sin(t); constraint y = cos(t); constraint z = t; \
                  constraint phi = x + y;";
    let mechanism = less(driven);
    assert_eq!(mechanism.coordinates.len(), 1);
    assert_eq!(mechanism.constraints.len(), 1);
}

#[test]
fn a_constraint_that_follows_from_those_that_went_goes_with_them() {
    let mechanism = less("constraint x = sin(phi); constraint 2*x = 2*sin(phi);");
    assert_eq!(mechanism.constraints.len(), 0);
    assert_eq!(mechanism.coordinates.len(), 3);
}

#[test]
fn without_such_constraints_nothing_changes() {
    let mechanism = less("constraint x^2 + y^2 = 1;");
    assert_eq!(mechanism.coordinates.len(), 4);
    assert!(mechanism.described.is_empty());
}

#[test]
fn parameters_stay_open_and_guesses_go_with_their_coordinate() {
    let mechanism = less("constraint x = k*sin(phi); start { x ~ 0.4; phi ~ 0.2; der(phi) = k; }");
    assert_eq!(value(&mechanism, "x"), "k*sin(phi)");
    let starts: Vec<(usize, bool)> = mechanism
        .starts
        .iter()
        .map(|s| (s.coordinate, s.held))
        .collect();
    assert_eq!(starts, [(2, false), (2, true)]);
}

#[test]
fn the_documentation_says_what_was_eliminated() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("eliminated");
    fs::create_dir_all(&folder).expect("a folder can be made");
    let description = folder.join("bead.mech");
    let source = "mechanism Bead { param k = 2; coord phi; coord x; kinetic der(phi)^2 + der(x)^2; \
                  constraint x = k*sin(phi); }";
    fs::write(&description, source).expect("the folder is ours");
    let builder = Builder::new().out_dir(&folder).eliminate(true);
    let warnings = builder.try_compile(&description);
    assert!(warnings.is_ok(), "{warnings:?}");
    let code = fs::read_to_string(folder.join("bead.rs")).expect("the code");
    for part in [
        "1 coordinates, 0 constraint equations",
        "Eliminated: `x = k*sin(phi)`",
        "given_by: Some(ConstraintRow",
        "fn described(",
    ] {
        assert!(code.contains(part), "no `{part}` in {code}");
    }
}
