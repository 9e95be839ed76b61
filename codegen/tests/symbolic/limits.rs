//! Mechanisms that the regular path is not for.

use bricard_codegen::{Compiled, Settings, compile_source};

fn compiled(source: &str) -> Compiled {
    match compile_source(source, "test", "test.mech", &Settings::default()) {
        Ok(compiled) => compiled,
        Err(errors) => panic!("{}", errors.render("test.mech", source)),
    }
}

#[test]
fn a_coordinate_without_inertia_gets_no_solve_that_divides_by_zero() {
    let code =
        compiled("mechanism Test { coord q; coord w; kinetic der(q)^2; potential q*w; }").code;
    assert!(!code.contains("fn regular"), "{code}");
    let code = compiled("mechanism Test { coord q; coord w; kinetic der(q)^2 + der(w)^2; }").code;
    assert!(code.contains("fn regular"), "{code}");
}

#[test]
fn constraint_rows_that_repeat_get_no_solve_that_divides_by_zero() {
    let code = compiled(
        "mechanism Test { coord q; coord w; kinetic der(q)^2 + der(w)^2;
         constraint q = w; constraint 2*q = 2*w; }",
    )
    .code;
    assert!(!code.contains("fn regular"), "{code}");
    assert!(!code.contains("fn correction"), "{code}");
}
