//! Names: what they mean, in which order, and what was probably meant.

use super::{
    accept, assert_close, output, refuse, refuse_each, refuse_saying, settings, value, warnings,
    with,
};
use bricard_codegen::internals::analyse;

#[test]
fn declarations_may_come_in_any_order() {
    let source = "mechanism M { output y = a; let a = b + K; let b = 2*q; kinetic der(q)^2; coord q; const K = 2*J; const J = 3; }";
    assert_close(output(&accept(source), "y"), 2.0 * 0.51 + 6.0);
}

#[test]
fn a_long_chain_of_quantities_is_no_deep_recursion() {
    let n = 20_000;
    let chain: String = (0..n)
        .map(|i| format!("let x{i} = x{} + 1;", i + 1))
        .collect();
    let source = with(&format!("{chain} let x{n} = q; output y = x0;"));
    assert_close(output(&accept(&source), "y"), 0.51 + f64::from(n));
}

#[test]
fn circles_are_refused_and_named() {
    let table = "
        let a = b; let b = c + 1; let c = a; ⇒ `a`, `b`, `c` are defined by one another
        let a = a + 1; ⇒ `a` is defined by itself
        const a = b; const b = a; ⇒ `a`, `b` are defined by one another
    ";
    refuse_each(with, table);
    assert_eq!(
        refuse(&with("let a = b; let b = a; let c = a + b; output y = c;")).error_count(),
        1
    );
}

#[test]
fn a_name_is_declared_once() {
    let table = "
        param q = 1; ⇒ `q` is declared twice
        let a = 1; input a = 0; ⇒ `a` is declared twice
        let t = 1; ⇒ `t` is the time already
        for q in 0..2 { } ⇒ `q` is declared twice
        let a = sum(w in 0..2, w); ⇒ `w` is declared twice
        output y = 1; output y = 2; ⇒ `y` is declared twice
        output q = 1; ⇒ `q` is declared twice
        event e: q rising; event e: w rising; ⇒ `e` is declared twice
        let if = 1; ⇒ a word of the language
        let self = 1; ⇒ `self` can't be a name
    ";
    refuse_each(with, table);
}

#[test]
fn outputs_and_events_may_have_the_names_of_other_things() {
    let m = accept(&with("let a = q; output a = a; event a: a rising;"));
    assert_eq!((m.outputs.len(), m.events.len()), (1, 1));
}

#[test]
fn the_nearest_name_is_suggested() {
    let table = "
        param stiffness = 1; let a = stifness; ⇒ did you mean `stiffness`?
        let a = sinn(q); ⇒ did you mean `sin`?
        let a = arctan(q); ⇒ write `atan(x)`
        let a = q(w + 1); ⇒ a product is written `q*(…)`
        let a = sin + 1; ⇒ write `sin(…)`
        let a = velocity; ⇒ declare it, for example `param velocity = 1;`, or `coord velocity;` if it moves
        let a = phi; ⇒ declare it, for example `param phi
    ";
    refuse_each(with, table);
    refuse_saying(
        "mechanism M { coord q: metre; kinetic der(q)^2; }",
        "unknown unit `metre`",
    );
}

#[test]
fn constants_and_defaults_are_built_of_constants() {
    let table = "
        param a = 1; const b = a; ⇒ a constant is built of numbers and constants; `a` is a parameter
        param a = 1; param b = a; ⇒ the default of a parameter is built of
        const a = t; ⇒ can't depend on the time
        param a = q; ⇒ `q` is a coordinate
        param K = 2; coord p[K]; ⇒ the size of an array is built of
    ";
    refuse_each(with, table);
    let m = accept(&with(
        "const a = 2; param b = sqrt(a)*sin(30*deg); output y = b;",
    ));
    let default = m.graph.constant_value(m.parameters[0].default);
    assert_close(default.unwrap_or(f64::NAN), 2.0_f64.sqrt() / 2.0);
}

#[test]
fn quantities_inside_a_loop_stay_there() {
    let source = with(
        "coord p[2]; for i in 0..2 { let d = b + i; let b = 2*p[i]; kinetic d*der(p[i])^2; output y = d; }",
    );
    let m = accept(&source);
    assert_close(output(&m, "y[1]"), 2.0 * (0.51 + 3.0 * 0.29) + 1.0);
    refuse_saying(
        &with("for i in 0..2 { let d = i; output y = d; } output z = d;"),
        "`d` is not declared",
    );
    refuse_saying(
        &with("for i in 0..2 { param d = 1; }"),
        "declared inside a loop",
    );
}

#[test]
fn what_is_never_used_is_a_warning() {
    let text = warnings(&with(
        "param a = 1; let b = 2; const c = 3; input u = 0; let _d = 4;",
    ));
    for name in ["a", "b", "c", "u"] {
        assert!(
            text.contains(&format!("warning: `{name}` is never used")),
            "{text}"
        );
    }
    assert_eq!(text.matches("warning").count(), 4, "{text}");
    let text = warnings("mechanism M { coord q; coord p[2]; kinetic der(q)^2 + der(p[0])^2; }");
    assert!(
        text.contains("`p[1]` takes part in no energy, force or constraint"),
        "{text}"
    );
    assert_eq!(warnings(&with("param a = 1; force a on q;")), "");
}

#[test]
fn a_build_script_can_change_constants_and_freeze_parameters() {
    let source = with(
        "const N = 2; param a = 3; coord p[N]; let s = sum(i in 0..N, p[i]*a); force s on q; kinetic sum(i in 0..N, der(p[i])^2);",
    );
    let changed = analyse(&source, &settings(&[("N", 5.0)], &["a"]));
    let (m, _) = changed.unwrap_or_else(|errors| panic!("{}", errors.render("test.mech", &source)));
    assert_eq!(m.coordinates.len(), 7);
    assert_eq!(m.parameters.len(), 0);
    assert_eq!(m.constants.len(), 2);
    let decimal = analyse(
        &with("const g = 1; force g on q;"),
        &settings(&[("g", -9.81)], &[]),
    );
    let (m, _) = decimal.unwrap_or_else(|errors| panic!("{errors}"));
    let number = m
        .graph
        .as_number(m.constants[0].value)
        .map(|n| n.to_string());
    assert_eq!(number.as_deref(), Some("-9.81"));
}

#[test]
fn a_build_script_can_change_only_what_there_is() {
    let source = with("const N = 2; param a = 3;");
    for (settings, words) in [
        (
            settings(&[("M", 5.0)], &[]),
            "the constants of the description are N",
        ),
        (
            settings(&[], &["N"]),
            "sets the parameter `N`, which is not declared",
        ),
        (settings(&[("N", f64::NAN)], &[]), "which is not finite"),
    ] {
        let errors = analyse(&source, &settings).expect_err("this was accepted");
        let message = errors.render("test.mech", &source);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn time_and_angles_have_names() {
    assert_close(value("sin(90*deg) + cos(2*pi)"), 2.0);
}
