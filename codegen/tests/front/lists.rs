//! Constants, parameters and inputs of more than one number.

use super::{accept, assert_close, output, refuse_saying, settings, with};
use bricard_codegen::internals::analyse;
use bricard_codegen::{CompileSettings, compile_source};

const LISTS: &str = "const c = [1, 2]; param m[6]: kg = [0, 17.4, 4.8, 0.82, 0.34, 0.09];
    param r = [q0, 5]; const q0 = 3; param I = [[1, 2], [3, 4]]; input u[2] = [t, 7];
    output y = c.x + c.y*r.x + I[1][0] + u[1]; output z: kg = m[5];";

#[test]
fn every_number_of_a_list_has_a_name_and_a_default_of_its_own() {
    let m = accept(&with(LISTS));
    let names = m.parameters.iter().map(|p| p.quantity.name.as_str());
    assert_eq!(
        names.collect::<Vec<_>>(),
        [
            "m[0]", "m[1]", "m[2]", "m[3]", "m[4]", "m[5]", "r.x", "r.y", "I[0][0]", "I[0][1]",
            "I[1][0]", "I[1][1]"
        ]
    );
    let default = |i: usize| m.graph.constant_value(m.parameters[i].default);
    assert_eq!(default(1), Some(17.4));
    assert_eq!(default(6), Some(3.0));
    assert_eq!(m.parameters[5].quantity.unit, "kg");
    let inputs = m.inputs.iter().map(|input| input.quantity.name.as_str());
    assert_eq!(inputs.collect::<Vec<_>>(), ["u[0]", "u[1]"]);
    let parameter = |i: u32| 1.31 + 0.61 * f64::from(i);
    assert_close(output(&m, "z"), parameter(5));
    assert_close(
        output(&m, "y"),
        1.0 + 2.0 * parameter(6) + parameter(10) + (2.17 - 0.31),
    );
}

#[test]
fn fields_and_tables_of_emitted_code_name_the_elements() {
    let source = with(LISTS);
    let code = compile_source(&source, "test", "test.mech", &CompileSettings::default());
    let code = code.expect("a description that is right").code;
    for text in [
        "pub m_5: T",
        "/// `m[5]` (kg)",
        "name: \"m[5]\"",
        "pub r_x: T",
        "pub i_1_0: T",
        "pub u_1: Option<T>",
    ] {
        assert!(code.contains(text), "no `{text}`");
    }
}

#[test]
fn a_build_script_changes_and_freezes_elements() {
    let analyse = |settings| analyse(&with(LISTS), &settings).map(|(m, _)| m);
    let m = analyse(settings(&[("c.x", 8.0), ("q0", 4.0)], &["m", "r.x"])).expect("right");
    assert_eq!(m.parameters.len(), 5);
    let i = 1.31 + 0.61 * 3.0;
    assert_close(output(&m, "y"), 8.0 + 2.0 * 4.0 + i + 1.86);
    assert_close(output(&m, "z"), 0.09);
    let said = |settings| analyse(settings).expect_err("wrong").to_string();
    assert!(said(settings(&[("c.z", 1.0)], &[])).contains("`c.z`, which is not declared"));
    assert!(said(settings(&[("c", 1.0)], &[])).contains("all of `c` to one number"));
    assert!(said(settings(&[], &["m[6]"])).contains("`m[6]`, which is not declared"));
}

#[test]
fn a_unit_behind_a_vector_is_that_of_its_bare_numbers() {
    refuse_saying(
        &with("param L: m = 1; output y: kg = ([0, L] m).y;"),
        "`y` is declared in kg, its value is in m",
    );
    assert_close(
        output(
            &accept(&with(
                "output y = if q < w then [0, q] m/s else [1, 2] m/s;",
            )),
            "y.y",
        ),
        0.51,
    );
}

#[test]
fn an_array_of_one_is_an_array() {
    assert_close(
        output(&accept(&with("const c[1] = [4]; output y = c[0];")), "y"),
        4.0,
    );
}
