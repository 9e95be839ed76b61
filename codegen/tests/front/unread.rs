//! Parts and functions that nothing uses: what is wrong with them whatever they are given is
//! told, and nothing else.

use super::{accept, with};
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;

/// What a part that nothing uses may say, beside the coordinates `q` and `w`, the rate of `q`
/// and more.
const RIGHT: &[&str] = &[
    "part P(n, foot: m, R) { coord p[n]; let tip = foot + R*[1, 0]; kinetic 1/2*norm2(der(tip)); }",
    "part P(n) { for i in 0..n { constraint q = i; output y = q*i; } }",
    "part P(n) { const k = 2*n; coord p[k]; let a[i in 0..k] = if i == 0 then 0 else a[i-1] + p[i]; \
     output y = a[k-1]; start { for i in 0..k { p[i] ~ i; } } }",
    "part P(n) { let a[i in 0..n] = sum(j in 0..i, a[j]); }",
    "part P(n) { let row[i in 0..n] = Q(i); output y = row[n-1].r + row[0].r; } \
     part Q(x) { let r = x; }",
    "part P(n) { state z[n]; for i in 0..n { der(z[i]) = q - z[i]; } }",
    "part P(n) { param m[n] = 1; param r[i in 0..n] = 0.1*i; output y = m[0] + r[0]; }",
    "part P(x, y) { start { q = 1; } constraint own: x = y; force x on y; event e: x rising; }
     part R(x) { start { q = 2; } constraint own: x = q; draw trace([q, w]); }",
    "part P(v) { output y = v.x + v[2] + cross(v, [1, 2, 0]).z; draw line([0, 0], v); }",
    "use parts; part P(p, A, k) { let s = Spring(p, [0, 0], k, 1); let j = Revolute(p, A, p, A); \
     output y = s.tension; }",
    "part P(f) { input u = f; force table([[0, f], [1, 2]], t)*u on q; }",
    "part P(x) { coord q; output y = q + x; } let P = 3; output z = P;",
    "part P(x) { let a = Q(x, 2); output y = a.b; } part Q(x, n) { coord r[n]; let b = x*r[n-1]; }",
    "part P(n) { for i in 0..n { output y = q; constraint c: q = w; event e: q rising; } \
     for i in n..2*n { output y = w; constraint c: q = w; event e: w rising; } }",
    "part _P() { kinetic 1/2*der(q)^2; }",
    "fn f(x, n) = sum(i in 0..n, x[i]*q) + g2(x).y; fn g2(x) = transpose(x)*[1, 2];",
    "fn f(v: m): m = if v > 0 then v else norm(v);",
];

/// Statements that no argument would make right, with what is said.
const WRONG: &[(&str, &str)] = &[
    ("part P(x) { coord a; coord a; }", "`a` is declared twice"),
    ("part P(x) { coord x; }", "`x` is declared twice"),
    ("part P(x) { potential x*y; }", "`y` is not declared"),
    (
        "part P(n) { for i in 0..n { potential y*i; } }",
        "`y` is not declared",
    ),
    (
        "part P(n) { let a[i in 0..n] = y*i; }",
        "`y` is not declared",
    ),
    (
        "part P(n) { param a[i in 0..n] = y*i; }",
        "`y` is not declared",
    ),
    (
        "part P(n) { output a = sum(i in 0..n, y*i); }",
        "`y` is not declared",
    ),
    (
        "part P(x) { output a = sine(x); }",
        "unknown function `sine`",
    ),
    ("part P(x: foot) { }", "unknown unit `foot`"),
    ("part P(x) { coord a: foot; }", "unknown unit `foot`"),
    (
        "part P(x) { param l: m = 1; param s: s = 1; output a = x*(l + s); }",
        "this sum mixes m and s",
    ),
    (
        "part P(x) { param l: m = 1; kinetic l; }",
        "the kinetic energy is in J",
    ),
    (
        "part P(x) { let own = P(x); }",
        "the part `P` is made of itself",
    ),
    (
        "part P(x) { let a = Q(x); } part Q(x, y) { }",
        "`Q` takes two arguments",
    ),
    (
        "part P(x) { fn f(y) = y; }",
        "can't stand in a part or a loop",
    ),
    (
        "part P(x) { for i in 0..2 { coord a; } }",
        "`a` is declared inside a loop",
    ),
    (
        "use parts; part P(x) { let s = Spring([0, 0], [0, 0, 1], x, 1); }",
        "in the part `Spring`",
    ),
    ("fn f(x) = x*([1, 2] + [1, 2, 3]);", "can't be added"),
    ("fn f(t) = 1;", "`t` is the time already"),
];

/// What is said about a description, whether that is an error or a warning.
fn said(source: &str) -> Vec<String> {
    let findings = match analyse(source, &CompileSettings::default()) {
        Ok((_, warnings)) => warnings,
        Err(errors) => errors,
    };
    let rendered = findings.render("test.mech", source);
    rendered.split("\n\n").map(str::to_string).collect()
}

/// What is said about statements, but for that nothing uses them.
fn mistakes(statements: &str) -> Vec<String> {
    let mut said = said(&with(statements));
    said.retain(|one| !one.is_empty() && !one.contains("is never used"));
    said
}

#[test]
fn what_depends_on_arguments_is_not_judged() {
    for statements in RIGHT {
        assert_eq!(mistakes(statements), [""; 0], "{statements}");
    }
}

#[test]
fn every_part_of_the_library_is_right_without_arguments() {
    let library = include_str!("../../src/parts.mech");
    assert_eq!(mistakes(library), [""; 0]);
}

#[test]
fn what_is_wrong_whatever_the_arguments_are_is_told() {
    for (statements, told) in WRONG {
        let found = mistakes(statements);
        assert!(
            found.iter().any(|one| one.contains(told)),
            "{found:?}: {statements}"
        );
    }
}

/// It changes nothing yet.
#[test]
fn what_nothing_uses_does_not_stop_the_generator() {
    accept(&with("part P(x) { potential y; }"));
}

#[test]
fn a_mistake_is_told_once() {
    let found = mistakes("part P(x) { potential y; } part Q(x) { let p = P(x); }");
    assert_eq!(found.len(), 1, "{found:?}");
    let found = mistakes("part P(x) { potential y; } let p = P(q); part Q(x) { let p = P(x); }");
    assert_eq!(found.len(), 1, "{found:?}");
}
