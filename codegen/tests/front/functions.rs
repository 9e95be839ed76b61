//! Functions that a description declares.

use super::{accept, assert_close, output, refuse_saying, warnings, with};

const Q: f64 = 0.51;
const W: f64 = 0.80;

#[test]
fn a_function_has_the_value_of_its_formula_at_the_values_of_its_arguments() {
    let source = with("fn f(x, y) = x^2 - 3*y; output y = f(w, f(q, 1));");
    assert_close(output(&accept(&source), "y"), W * W - 3.0 * (Q * Q - 3.0));
}

#[test]
fn an_argument_hides_what_has_its_name_outside_and_only_inside() {
    let source = with("fn f(q) = q + w; output y = f(2) + q;");
    assert_close(output(&accept(&source), "y"), 2.0 + W + Q);
}

#[test]
fn a_function_sees_nothing_of_the_loop_that_calls_it() {
    let source = with("fn f(x) = i*x; for i in 0..2 { output y = f(q); }");
    refuse_saying(&source, "`i` is not declared");
    let source = with("fn f(x) = sum(i in 0..3, i*x); for i in 0..2 { output y = f(i); }");
    assert_close(output(&accept(&source), "y[1]"), 3.0);
}

#[test]
fn a_function_and_a_quantity_may_have_one_name() {
    let source = with("fn f(x) = 2*x; let f = f(q); output y = f(f);");
    assert_close(output(&accept(&source), "y"), 4.0 * Q);
}

#[test]
fn a_function_gives_sizes_and_constants() {
    let source = with(
        "fn twice(n) = 2*n; const K = twice(2); coord p[twice(K)]; kinetic sum(i in 0..8, der(p[i])^2);",
    );
    assert_eq!(accept(&source).coordinates.len(), 10);
    let source = with("fn f(n) = q*n; const K = f(2); output y = K;");
    refuse_saying(&source, "`q` is a coordinate");
}

#[test]
fn the_value_of_a_function_is_in_the_unit_that_it_declares() {
    let source =
        with("param L: m = 1; fn f(x): m = 2*x; output y: m = L + f(1); output z: s = f(2);");
    refuse_saying(&source, "`z` is declared in s, its value is in m");
}

#[test]
fn a_finding_inside_a_function_names_the_place_of_its_use_once() {
    let source = with("fn f(x) = x + [1, 2]; output y = f(q); output z = f(w);");
    let found = super::refuse(&source);
    let text = found.render("test.mech", &source);
    assert_eq!(found.error_count(), 1, "{text}");
    assert!(text.contains("in the function `f`, used here"), "{text}");
}

#[test]
fn functions_and_arguments_that_nothing_uses_are_warned_of() {
    let text = warnings(&with("fn f(x, y) = x; output z = q; fn _g(x, _y) = x;"));
    assert!(text.contains("the function `f` is never used"), "{text}");
    assert!(text.contains("`y` is never used"), "{text}");
    assert_eq!(text.matches("never used").count(), 2, "{text}");
}

#[test]
fn functions_inside_one_another_end_with_a_message_and_not_with_the_stack() {
    let chain: String = (1..5000)
        .map(|i| format!("fn f{i}(x) = 1 + f{}(x);", i - 1))
        .collect();
    let source = with(&format!("fn f0(x) = x; {chain} output y = f4999(q);"));
    refuse_saying(&source, "too many functions call one another");
}
