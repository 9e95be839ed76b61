//! Mechanisms that the usual path is not for: too long, or without inertia.

use bricard_codegen::internals::examine;
use bricard_codegen::{CompileSettings, Compiled, compile_source};
use std::fmt::Write;
use std::time::Instant;

fn compiled(source: &str) -> Compiled {
    match compile_source(source, "test", "test.mech", &CompileSettings::default()) {
        Ok(compiled) => compiled,
        Err(errors) => panic!("{}", errors.render("test.mech", source)),
    }
}

/// A chain of bodies that turn about two axes each, with all positions in the world.
pub fn chain(links: usize) -> String {
    let mut text = String::from("mechanism Chain {\n");
    for i in 0..links {
        let _ = writeln!(text, "coord a{i}; coord b{i};");
    }
    let mut point = "[0, 0, 0]".to_string();
    for i in 0..links {
        let turned = (0..=i).rev().fold("[0, 0, -1]".to_string(), |v, k| {
            format!("rotx(a{k})*(roty(b{k})*({v}))")
        });
        let _ = writeln!(
            text,
            "let p{i} = {point} + {turned};\nkinetic norm2(der(p{i}));"
        );
        point = format!("p{i}");
    }
    text + "}"
}

/// Room for machines that are slower than this work is quick, and for builds without
/// optimisation.
fn soon(start: Instant) -> bool {
    let bound = if cfg!(debug_assertions) { 120.0 } else { 15.0 };
    start.elapsed().as_secs_f64() < bound
}

#[test]
fn a_mechanism_that_swells_is_compiled_with_a_warning_that_names_the_longest_lines() {
    let source = chain(8);
    let start = Instant::now();
    let compiled = compiled(&source);
    let warnings = compiled.warnings.render("test.mech", &source);
    assert!(warnings.contains("expressions"), "{warnings}");
    assert!(warnings.contains("kinetic norm2(der(p7))"), "{warnings}");
    assert!(!compiled.code.contains("fn linearised"));
    assert!(soon(start), "{:?}", start.elapsed());
}

#[test]
fn a_mechanism_that_would_take_forever_is_refused_with_the_longest_lines() {
    let source = chain(20);
    let start = Instant::now();
    let refused = compile_source(&source, "test", "test.mech", &CompileSettings::default());
    let errors = refused.expect_err("too long").render("test.mech", &source);
    assert!(errors.contains("more than 150000 expressions"), "{errors}");
    assert!(errors.contains("kinetic norm2(der(p19))"), "{errors}");
    assert!(examine(&source, &CompileSettings::default()).is_err());
    assert!(soon(start), "{:?}", start.elapsed());
}

#[test]
fn a_mechanism_of_usual_size_gets_no_such_warning() {
    let source = chain(2);
    let compiled = compiled(&source);
    assert!(compiled.warnings.is_empty());
    assert!(compiled.code.contains("fn linearised"));
}

#[test]
fn a_large_mechanism_of_short_equations_gets_no_such_warning() {
    let source = include_str!("../../../mechanisms/n_four_bar.mech");
    let source = source.replace("const N = 2;", "const N = 200;");
    let (_, warnings) = examine(&source, &CompileSettings::default()).expect("a mechanism");
    let warnings = warnings.render("test.mech", &source);
    assert!(!warnings.contains("expressions"), "{warnings}");
}

#[test]
fn a_coordinate_without_inertia_gets_no_solve_that_divides_by_zero() {
    let code =
        compiled("mechanism Test { coord q; coord w; kinetic der(q)^2; potential q*w; }").code;
    assert!(!code.contains("fn acceleration("), "{code}");
    let code = compiled("mechanism Test { coord q; coord w; kinetic der(q)^2 + der(w)^2; }").code;
    assert!(code.contains("fn acceleration("), "{code}");
}

#[test]
fn constraint_rows_that_repeat_are_left_out_of_the_solve() {
    let code = compiled(
        "mechanism Test { coord q; coord w; kinetic der(q)^2 + der(w)^2;
         constraint q = w; constraint 2*q = 2*w; }",
    )
    .code;
    assert!(code.contains("redundant: &[1]"), "{code}");
    assert!(code.contains("fn acceleration("), "{code}");
}

#[test]
fn constraint_rows_that_repeat_unseen_get_no_solve_that_divides_by_zero() {
    // Mechanisms of this size are not evaluated.
    let code = compiled(
        "mechanism Test { const N = 66; coord q[N]; kinetic sum(i in 0..N, der(q[i])^2);
         constraint q[0] = q[1]; constraint 2*q[0] = 2*q[1]; }",
    )
    .code;
    assert!(code.contains("redundant: &[]"), "{code}");
    assert!(!code.contains("fn acceleration("), "{code}");
    assert!(!code.contains("fn correction"), "{code}");
}

#[test]
fn no_statement_has_as_many_terms_as_the_energy_of_a_long_row() {
    let source = include_str!("../../../mechanisms/benchmarks/forty_four_bars.mech");
    let compiled = compile_source(source, "row", "row.mech", &CompileSettings::default());
    let code = compiled.expect("a mechanism").code;
    let terms = |statement: &str| ["+ ", "mul_add"].map(|sign| statement.matches(sign).count());
    let sizes = code
        .split(';')
        .map(|statement| terms(statement).iter().sum::<usize>());
    // Its kinetic energy has 202 terms; a sum goes on under another name after 32.
    let longest = sizes.max().unwrap_or(0);
    assert!(longest <= 64, "{longest} terms in one statement");
}
