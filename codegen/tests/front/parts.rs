//! Parts that a description declares.

use super::{accept, refuse, refuse_saying, warnings, with};
use bricard_codegen::internals::analyse;
use bricard_codegen::{CompileSettings, compile_source};

const PENDULUM: &str = "part Rod(foot, n) { const twice = 2*n; param L: m = twice; coord q; coord p[n];
    kinetic der(q)^2 + sum(i in 0..n, der(p[i])^2)/L*L; constraint pin: q = foot; event low: q rising;
    start { q = 1; der(q) ~ 2; } output y = q; }";

#[test]
fn what_a_part_declares_has_the_name_of_its_use_in_front() {
    let m = accept(&with(&format!(
        "{PENDULUM} let a = Rod(w, 1); let b[i in 0..2] = Rod(i*w, i + 1); start {{ b[1].q = 5; }}"
    )));
    let names: Vec<_> = m.coordinates.iter().map(|q| q.name.as_str()).collect();
    let all = [
        "q",
        "w",
        "a.q",
        "a.p[0]",
        "b[0].q",
        "b[0].p[0]",
        "b[1].q",
        "b[1].p[0]",
        "b[1].p[1]",
    ];
    assert_eq!(names, all);
    let default = |i: usize| m.graph.constant_value(m.parameters[i].default);
    assert_eq!((default(0), default(2)), (Some(2.0), Some(4.0)));
    assert_eq!(m.parameters[2].quantity.name, "b[1].L");
    assert_eq!(m.outputs[2].quantity.name, "b[1].y");
    assert_eq!(m.events[1].name, "b[0].low");
    assert_eq!(m.constraints[2].text, "pin: q = foot in b[1]");
    let held = m.starts.iter().filter(|start| start.held);
    let held: Vec<_> = held
        .map(|s| (s.coordinate, m.graph.constant_value(s.value)))
        .collect();
    assert_eq!(held, [(2, Some(1.0)), (4, Some(1.0)), (6, Some(5.0))]);
}

#[test]
fn a_part_does_not_see_the_names_of_its_neighbours_nor_of_its_use() {
    let source =
        with("part A() { let own = 1; } part B(x) { output y = own; } let a = A(); let b = B(q);");
    refuse_saying(&source, "`own` is not declared");
    let source = with(
        "part C(x) { let own = B(x); output y = own.z; } part B(x) { let z = x + w; let w = 3; } let c = C(q);",
    );
    assert_eq!(super::output(&accept(&source), "c.y"), 3.51);
    refuse_saying(
        &with("part B(x) { output y = i*x; } let b[i in 0..2] = B(q);"),
        "`i` is not declared",
    );
}

#[test]
fn a_finding_in_a_part_names_the_place_of_its_use_once() {
    let source = with(
        "part A(x) { let y = x + [1, 2]; kinetic norm(y); } let a = A(q); let b[i in 0..9] = A(w);",
    );
    let found = refuse(&source);
    let text = found.render("test.mech", &source);
    assert_eq!(found.error_count(), 1, "{text}");
    assert!(text.contains("in the part `A`, used here"), "{text}");
}

#[test]
fn parts_that_nothing_uses_are_warned_of_and_not_the_names_in_them() {
    let text = warnings(&with(
        "part A(x) { let y = x; } part B(x) { let y = x; } let a = A(q);",
    ));
    assert!(text.contains("the part `B` is never used"), "{text}");
    assert_eq!(text.matches("never used").count(), 1, "{text}");
}

#[test]
fn emitted_code_has_fields_with_the_names_of_parts() {
    let source = with(&format!("{PENDULUM} let leg[i in 0..2] = Rod(w, 1);"));
    let code = compile_source(&source, "test", "test.mech", &CompileSettings::default());
    let code = code
        .unwrap_or_else(|e| panic!("{}", e.render("test.mech", &source)))
        .code;
    for text in ["pub leg_1_l: T", "name: \"leg[1].q\"", "name: \"leg[0].L\""] {
        assert!(code.contains(text), "no `{text}`");
    }
}

#[test]
fn a_build_script_changes_constants_of_parts() {
    let source = with(&format!("{PENDULUM} let a = Rod(w, 1);"));
    let mut settings = CompileSettings::default();
    settings.constants = vec![("a.twice".to_string(), 7.0)];
    settings.frozen = vec!["a.L".to_string()];
    let (m, _) = analyse(&source, &settings).expect("right");
    assert!(m.parameters.is_empty());
    let of = |name: &str| m.constants.iter().find(|c| c.quantity.name == name);
    let value = of("a.L").and_then(|c| m.graph.constant_value(c.value));
    assert_eq!(value, Some(7.0));
    let mut settings = CompileSettings::default();
    settings.constants = vec![("a.thrice".to_string(), 7.0)];
    assert!(analyse(&source, &settings).is_err());
}

#[test]
fn a_long_row_of_parts_ends_with_a_message_and_not_with_the_stack() {
    let row = |order: &dyn Fn(i32) -> i32| {
        let link = |i: i32| match i {
            0 => "let a0 = A(q);".to_string(),
            _ => format!("let a{i} = A(a{}.y);", i - 1),
        };
        let links: String = (0..1000).map(|i| link(order(i))).collect();
        with(&format!(
            "part A(x) {{ let y = x + 1; }} {links} output z = a999.y;"
        ))
    };
    assert_eq!(super::output(&accept(&row(&|i| i)), "z"), 1000.51);
    refuse_saying(&row(&|i| 999 - i), "declare each part behind those");
}

#[test]
fn constants_reach_the_parts_inside_a_part() {
    let source = with(
        "part Inner(n) { coord s[n]; kinetic sum(i in 0..n, der(s[i])^2); }
         part Outer(n, x) { let inner = Inner(2*n); let other = Inner(n + 1); output y = x; }
         let a = Outer(2, q);",
    );
    assert_eq!(accept(&source).coordinates.len(), 2 + 4 + 3);
    let source = with("part Inner(n) { coord s[n]; } param n = 2; let a = Inner(n);");
    refuse_saying(
        &source,
        "the size of an array is built of numbers and constants",
    );
}

#[test]
fn parts_without_end_are_refused() {
    let parts = |count: i32, uses: &str| -> String {
        let part = |i: i32| {
            let uses = uses.replace('#', &(i - 1).to_string());
            format!("part P{i}(x) {{ {uses} }} ")
        };
        (1..=count).map(part).collect()
    };
    let deep = parts(3000, "let inner = P#(x);");
    refuse_saying(
        &with(&format!("part P0(x) {{ }} {deep} let p = P3000(q);")),
        "more than 50 parts inside one another",
    );
    let many = parts(40, "let a = P#(x); let b = P#(x);");
    refuse_saying(
        &with(&format!("part P0(x) {{ }} {many} let p = P40(q);")),
        "more than 10000 parts",
    );
}
