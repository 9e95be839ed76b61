//! Starts that are given by formulas.

use super::{accept, assert_close, refuse_each, refuse_saying, state, with};
use bricard_codegen::internals::derive::derive;
use bricard_codegen::internals::examine;
use bricard_codegen::{CompileSettings, compile_source};

#[test]
fn a_formula_with_a_start_value_is_an_equation_for_positions_or_for_velocities() {
    let mut m = accept(&with(
        "param a = 1; part P(x) { start { sin(x) + x = 2; } } let p = P(w);
         start { [q*w, w] = [a, 2]; der(q*w) = 3*a; q^2 + der(w) = 1; }",
    ));
    let texts = m.start_equations.iter().map(|row| row.text.as_str());
    assert_eq!(
        texts.collect::<Vec<_>>(),
        [
            "sin(x) + x = 2 in p",
            "[q*w, w] = [a, 2] [x]",
            "der(q*w) = 3*a",
            "q^2 + der(w) = 1"
        ]
    );
    assert_eq!(m.starts.len(), 1, "w itself has a value");
    let equations = derive(&mut m).expect("equations of a usual length");
    let (q, w, a) = (0.51, 0.80, 1.31);
    let at = |e| m.graph.evaluate(e, &state);
    let positions = equations.start_positions;
    assert_close(at(positions.errors[1]), q * w - a);
    assert_close(at(positions.slopes[1][0]), w);
    let velocities = equations.start_velocities;
    assert_close(at(velocities.errors[0]), -3.0 * a);
    assert_close(at(velocities.slopes[0][1]), q);
    assert_close(at(velocities.errors[1]), q * q - 1.0);
    assert_close(at(velocities.slopes[1][1]), 1.0);
}

#[test]
fn a_start_without_equations_emits_nothing_for_them() {
    let code = |start: &str| {
        let source = with(&format!("start {{ {start} }}"));
        let compiled = compile_source(&source, "test", "test.mech", &CompileSettings::default());
        compiled.expect("a description that is right").code
    };
    assert!(!code("q = 1;").contains("StartEquations"));
    let code = code("q + w = 1;");
    assert!(code.contains("meet::<T, Self, 2, 0, 1, 0>"), "{code}");
}

#[test]
fn what_can_not_be_met_is_refused() {
    let table = "
        start { abs(q) = 1; } ⇒ has to be smooth
        start { der(q)^2 = 1; } ⇒ linear in the velocities
        start { abs(q) ~ 1; } ⇒ has to be smooth
        input u = 1; start { q + u = 1; } ⇒ can't contain an input
        start { q + w = q; } ⇒ built of numbers, constants and parameters
    ";
    refuse_each(with, table);
}

#[test]
fn a_start_that_equations_contradict_is_warned_of() {
    let said = |start: &str| {
        let source = with(&format!("constraint q = 2*w; start {{ {start} }}"));
        let (_, warnings) = examine(&source, &CompileSettings::default()).expect("legal");
        warnings.render("test.mech", &source)
    };
    assert_eq!(said("q = 1; q + w = 3/2; der(q + w) = 1;"), "");
    assert!(said("q = 1; q + w = 1;").contains("the start can't be assembled"));
    let held = said("q = 1; der(q) = 2; der(w - q) = 0;");
    assert!(held.contains("the held velocities contradict"), "{held}");
}

#[test]
fn components_that_are_as_they_begin_anyway_are_no_equations() {
    let m = accept(&with(
        "let R = rot([0, 0, 1], q); start { omega(R) = [0, 0, 10*pi]; }",
    ));
    let texts = m.start_equations.iter().map(|row| row.text.as_str());
    let starts: Vec<_> = m.starts.iter().map(|start| start.velocity).collect();
    assert_eq!((texts.count(), starts), (0, vec![true]));
    refuse_saying(
        &with("let R = rot([0, 0, 1], q); start { omega(R) = [0, 1, 10*pi]; }"),
        "only coordinates, velocities, states and formulas",
    );
    refuse_saying(
        &with("start { [0, 0] = [0, 0]; }"),
        "only coordinates, velocities, states and formulas",
    );
}

#[test]
fn a_function_has_a_start_value_beside_a_name_like_it() {
    accept(
        "mechanism Test { coord q; let sin = 2; coord f; fn f(x) = 2*x; kinetic der(q)^2 + der(f)^2;
         output a = sin; start { sin(q) = 0.5; f(q) ~ 1; f = 1; } }",
    );
}
