//! Formulas and statements as they are written.

use super::{accept, assert_close, refuse, refuse_saying, value, with};

const Q: f64 = 0.51;
const W: f64 = 0.80;

#[test]
fn a_power_binds_tighter_than_a_sign_and_from_right_to_left() {
    assert_close(value("-q^2"), -(Q * Q));
    assert_close(value("2^-1"), 0.5);
    assert_close(value("2^3^2"), 512.0);
    assert_close(value("(2^3)^2"), 64.0);
    assert_close(value("2*-q^2"), -2.0 * Q * Q);
    assert_close(value("q^-w"), Q.powf(-W));
}

#[test]
fn quotients_and_differences_associate_from_the_left() {
    assert_close(value("8/4/2"), 1.0);
    assert_close(value("8 - 4 - 2"), 2.0);
    assert_close(value("8/4*2"), 4.0);
    assert_close(value("1 - -q - +w"), 1.0 + Q - W);
}

#[test]
fn literals_are_exact() {
    let m = accept(&with(
        "output a = 1/3 + 1/6; output b = 0.1 + 0.2; output c = 1e-3*1_000;",
    ));
    let number = |i: usize| m.graph.as_number(m.outputs[i].value).map(|n| n.to_string());
    assert_eq!(number(0).as_deref(), Some("1/2"));
    assert_eq!(number(1).as_deref(), Some("0.3"));
    assert_eq!(number(2).as_deref(), Some("1"));
}

#[test]
fn a_dot_behind_a_number_is_told_from_a_range_and_a_component() {
    assert_close(value("sum(i in 0..3, i)"), 3.0);
    assert_close(value("sum(i in 1 .. 2*2, i)"), 6.0);
    assert_close(value("2.*q"), 2.0 * Q);
    assert_close(value("[q, w].y"), W);
    assert_close(value("[[q, 1], [2, w]][1][0]"), 2.0);
    assert_close(value("[[q, 1], [2, w]][1].y"), W);
}

#[test]
fn a_choice_reaches_as_far_as_it_can() {
    assert_close(value("if q < w then 1 else 2 + 10"), 1.0);
    assert_close(value("1 + if q > w then 1 else 2 + 10"), 13.0);
    assert_close(value("if q >= w then 1 else if q != w then 2 else 3"), 2.0);
    assert_close(value("if 1 == 1 then q else w"), Q);
    assert_close(value("if q <= q then 4 else 5"), 4.0);
}

#[test]
fn every_function_means_what_it_is_called() {
    assert_close(
        value("sin(q) + cos(q) + tan(q)"),
        Q.sin() + Q.cos() + Q.tan(),
    );
    assert_close(
        value("asin(q) + acos(q) + atan(q)"),
        Q.asin() + Q.acos() + Q.atan(),
    );
    assert_close(
        value("sinh(q) + cosh(q) + tanh(q)"),
        Q.sinh() + Q.cosh() + Q.tanh(),
    );
    assert_close(
        value("exp(q) + ln(q) + sqrt(q)"),
        Q.exp() + Q.ln() + Q.sqrt(),
    );
    assert_close(
        value("abs(-q) + sign(-q) + min(q, w) + max(q, w)"),
        Q - 1.0 + Q + W,
    );
    assert_close(value("atan2(q, w)"), Q.atan2(W));
    assert_close(value("90*deg + pi"), 1.5 * std::f64::consts::PI);
    assert_close(value("t"), 0.37);
}

#[test]
fn the_derivative_in_time_follows_the_chain_rule() {
    let (dq, dw) = (-0.83, -0.83 + 0.47);
    assert_close(value("der(q*sin(w))"), dq * W.sin() + Q * W.cos() * dw);
    assert_close(value("der(t^2*q)"), 2.0 * 0.37 * Q + 0.37 * 0.37 * dq);
    assert_close(value("der([q, w]).y"), dw);
    assert_close(value("der(3)"), 0.0);
}

#[test]
fn doc_comments_go_to_what_follows_them() {
    let source = "/// Two\n/// lines.\nmechanism M {\n  /// an angle\n  coord q: rad; // aside\n  /** a mass */ param m: kg = 1;\n  kinetic m*der(q)^2; }";
    let source = source.replace("param m: kg", "param m");
    let m = accept(&source);
    assert_eq!(m.docs, "Two\nlines.");
    assert_eq!(m.coordinates[0].docs, "an angle");
    assert_eq!(m.parameters[0].quantity.docs, "a mass");
}

#[test]
fn comments_and_line_ends_of_every_kind_are_blanks() {
    let source = with(
        "// a comment with ( [ { and θ\r\n /* and /* nested */ one */ output y = q; //! inner\n",
    );
    assert_eq!(accept(&source).outputs.len(), 1);
    let marked = format!("\u{feff}{source}");
    assert_eq!(accept(&marked).outputs.len(), 1);
}

#[test]
fn a_constraint_is_quoted_as_it_is_written() {
    let m = accept(&with(
        "for i in 0..2 { constraint [q,  w] // a comment\n = [i, 2*i*t]; }",
    ));
    let texts: Vec<_> = m.constraints.iter().map(|c| c.text.as_str()).collect();
    assert_eq!(texts[0], "[q, w] = [i, 2*i*t] [x] [i=0]");
    assert_eq!(texts[3], "[q, w] = [i, 2*i*t] [y] [i=1]");
}

#[test]
fn words_of_statements_can_be_names() {
    let source = with(
        "param force = 1; param start = 2; let draw = force + start; force draw on q; output event = draw;",
    );
    assert_close(super::output(&accept(&source), "event"), 1.31 + 1.92);
}

#[test]
fn symbols_functions_and_units_have_names_of_their_own() {
    let source = "mechanism M { param m: m = 2; param sin: kg = 1; coord q: rad; param kg: kg = 1;
        kinetic 1/2*(sin + kg)*m^2*der(q)^2; output y = sin(q); }";
    assert_close(super::output(&accept(source), "y"), Q.sin());
}

#[test]
fn several_mistakes_are_found_at_once() {
    let source =
        "mechanism M {\n  coord q rad;\n  kinetic 2m*der(q)^2;\n  potential sin(q\u{20};\n}";
    let count = |source: &str| refuse(source).error_count();
    assert_eq!(
        count(source),
        3,
        "a bracket that isn't closed hides nothing"
    );
    assert_eq!(count(&source.replace("sin(q ", "sin(q +)")), 3);
}

#[test]
fn the_first_line_of_a_message_names_file_line_and_column() {
    let source = "mechanism M {\n  coord q;\n  kinetic der(p)^2;\n}";
    let message = refuse(source).render("a/b.mech", source);
    assert!(
        message.starts_with("a/b.mech:3:15: error: `p` is not declared\n"),
        "{message}"
    );
}

#[test]
fn a_missing_semicolon_is_reported_where_it_is_missing() {
    let source = "mechanism M {\n  coord q\n  kinetic der(q)^2;\n}";
    refuse_saying(source, "test.mech:2:10: error: expected `;`");
    assert_eq!(refuse(source).error_count(), 1);
}

#[test]
fn a_semicolon_that_is_missing_behind_a_number_is_no_unit_and_no_product() {
    for (statements, found) in [
        ("param a = 1\nparam b = 2;", ""),
        ("param a = 1 param b = 2;", ", found `param`"),
        ("let a = 1 let b = 2;", ", found `let`"),
        ("start { q = 1 w = 2; }", ", found `w`"),
        ("start { q = 1 der(w) = 2; }", ", found `der`"),
    ] {
        refuse_saying(&with(statements), &format!("error: expected `;`{found}\n"));
    }
    refuse_saying(&with("param a = 1 kg;"), "a unit can't stand behind");
    refuse_saying(&with("start { q = 1 m; }"), "a unit can't stand behind");
}

#[test]
fn what_is_missing_in_an_empty_file_is_missing_at_its_beginning() {
    for text in ["", "   \n\n   \n", "\n\n// nothing yet\n"] {
        refuse_saying(text, "test.mech:1:1: error: expected `mechanism`");
    }
    let large = " ".repeat(1 << 25);
    refuse_saying(&large, "test.mech:1:1: error: a description of");
}

#[test]
fn a_comma_alone_is_told_where_it_stands_and_hides_nothing() {
    for (statements, place) in [
        ("\n ,\n potential foo;", "2:2: error: expected a statement"),
        ("\n , potential foo;", "2:2: error: expected a statement"),
        (
            "start {\n ,\n q = foo; }",
            "2:2: error: expected an entry, found `,`",
        ),
    ] {
        let description = with(statements);
        refuse_saying(&description, place);
        refuse_saying(&description, "`foo` is not declared");
    }
}

#[test]
fn a_mechanism_without_a_name_is_read_all_the_same() {
    for head in [
        "mechanism",
        "mechanism for",
        "mechanism 3D",
        "mechansim Test",
        "Mechanism Test",
    ] {
        let description = format!("{head} {{ coord q; kinetic der(q)^2; potential foo; }}");
        refuse_saying(&description, "error: ");
        refuse_saying(&description, "`foo` is not declared");
        assert_eq!(refuse(&description).len(), 2, "{head}");
    }
}
