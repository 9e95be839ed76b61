//! What a description doesn't need is left out of its program, and `bricard show` says
//! so: each on a pair of descriptions that differ in that one thing.

use bricard_codegen::{CompileSettings, compile_source};
use std::fs;
use std::path::Path;
use std::process::Command;

/// What `show` says is left out.
fn left_out(test: &str, source: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("skipping");
    fs::create_dir_all(&folder).expect("a folder can be made");
    let file = folder.join(format!("{test}.mech"));
    fs::write(&file, source).expect("the folder is ours");
    let show = Command::new(env!("CARGO_BIN_EXE_bricard"))
        .arg("show")
        .arg(&file)
        .output()
        .expect("the command starts");
    assert!(show.status.success(), "{source}");
    let text = String::from_utf8(show.stdout).expect("the command prints text");
    let section = text.split_once("\nleft out\n");
    section.map_or(String::new(), |(_, section)| section.to_string())
}

fn code(source: &str) -> String {
    let compiled = compile_source(source, "pair", "pair.mech", &CompileSettings::default());
    let compiled = compiled.unwrap_or_else(|errors| panic!("{}", errors.render("pair", source)));
    compiled.code
}

/// The function of a name in generated code, to the next function.
fn function<'a>(code: &'a str, name: &str) -> &'a str {
    let (_, rest) = code.split_once(&format!("fn {name}")).expect(name);
    rest.split_once("\n        fn ")
        .map_or(rest, |(body, _)| body)
}

/// Checks that a line about something stands below `with` alone.
fn differs(test: &str, about: &str, [without, with]: [&str; 2]) -> String {
    let (plain, said) = (left_out(test, without), left_out(test, with));
    assert!(!plain.contains(about), "{about}\n{plain}");
    let line = said.lines().find(|line| line.contains(about));
    line.unwrap_or_else(|| panic!("{about}\n{said}"))
        .to_string()
}

const CART: &str = "mechanism Cart { param m: kg = 1; param l: m = 2; const g: m/s^2 = 9.81;
    coord x: m; coord a: rad; let P = [x + l*sin(a), -l*cos(a)];
    kinetic 1/2*m*der(x)^2 + 1/2*m*norm2(der(P)); potential m*g*P.y; start { a = 1; } }";

/// The cart with its mass at a distance that does not turn.
const SLIDES: &str = "mechanism Cart { param m: kg = 1; param l: m = 2; const g: m/s^2 = 9.81;
    coord x: m; coord a: m; let P = [x + a, -l];
    kinetic 1/2*m*der(x)^2 + 1/2*m*norm2(der(P)); potential m*g*P.y*a/l; start { a = 1; } }";

#[test]
fn a_constant_mass_matrix_has_no_coriolis_terms_and_is_factorised_once() {
    let line = differs("constant", "M is constant", [CART, SLIDES]);
    assert!(line.contains("operations"), "{line}");
    assert!(left_out("constant", SLIDES).contains("Coriolis terms: there are none"));
    assert!(code(SLIDES).contains("constant_mass: true"));
    assert!(code(CART).contains("constant_mass: false"));
}

#[test]
fn constraints_that_stay_what_they_are_are_known() {
    let wire = |law: &str| {
        format!(
            "mechanism Bead {{ param m: kg = 1; param r: m = 2; const w: 1/s = 1;
            coord x: m; coord y: m; kinetic 1/2*m*(der(x)^2 + der(y)^2); {law} start {{ x = 2; y ~ 0; }} }}"
        )
    };
    for (law, flag) in [
        ("constraint x^2 + y^2 = r^2;", "true"),
        ("constraint x^2 + y^2 = r^2*(1 + w*t);", "false"),
        ("constraint der(x) = w*y;", "false"),
    ] {
        let said = format!("scleronomic: {flag}");
        assert!(code(&wire(law)).contains(&said), "{law}");
    }
}

#[test]
fn functions_of_a_coordinate_that_enters_nothing_are_not_written() {
    let sprung = CART.replace("potential m*g*P.y;", "potential m*g*P.y + m*g*x^2/l;");
    let line = differs("ignorable", "(ignorable)", [&sprung, CART]);
    assert!(line.starts_with("functions of x:"), "{line}");
    assert!(function(&code(CART), "terms").contains("let [_, a] = state.q"));
    assert!(function(&code(&sprung), "terms").contains("let [x, a] = state.q"));
}

const HUNG: &str = "mechanism Hung { param m: kg = 1; param l: m = 2; const g: m/s^2 = 9.81;
    coord x: m; coord y: m; kinetic 1/2*m*(der(x)^2 + der(y)^2); potential m*g*y;
    constraint x^2 + y^2 = l^2; start { x = 1; y ~ -1; } }";

#[test]
fn constraints_that_stand_still_have_no_derivatives_by_time() {
    let driven = HUNG
        .replace("= l^2;", "= (l*(1 + 0.1*sin(t/w)))^2;")
        .replace("const g", "const w: s = 1; const g");
    differs(
        "clock",
        "derivatives of the constraints with respect to time",
        [&driven, HUNG],
    );
    let drift = |source: &str| function(&code(source), "position").contains("out.drift");
    assert!(drift(&driven));
    assert!(!drift(HUNG));
}

#[test]
fn without_constraints_nothing_is_projected() {
    differs("free", "there are no constraints", [HUNG, CART]);
    assert!(code(HUNG).contains("fn correction"));
    assert!(!code(CART).contains("fn correction"));
}

#[test]
fn constraints_of_independent_form_have_no_singular_configurations_to_look_for() {
    let fixed = HUNG.replace("param l", "const l");
    let line = differs("independent", "independent at all", [HUNG, &fixed]);
    assert!(line.starts_with("rank decisions, and the search"), "{line}");
    assert!(code(&fixed).contains(" independent: true"));
    assert!(code(HUNG).contains(" independent: false"));
    // Nothing is said where there is nothing to be said of.
    assert!(!left_out("independent", CART).contains("independent at all"));
}

#[test]
fn zeros_shorten_the_solve() {
    // In a full matrix nothing is zero.
    let full = HUNG.replace("der(y)^2)", "der(y)^2 + der(x)*der(y))");
    let line = differs("zeros", "zeros of M and G", [&full, HUNG]);
    let counts: Vec<usize> = line
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|word| word.parse().ok())
        .collect();
    let [zeros, entries, spent, dense] = counts[..] else {
        panic!("{line}");
    };
    assert!(zeros == 2 && entries == 8 && spent < dense, "{line}");
}

#[test]
fn constants_become_numbers() {
    let open = CART.replace("const g", "param g");
    let line = differs("folded", "folded into numbers", [&open, CART]);
    assert!(line.starts_with("1 constant"), "{line}");
    assert!(function(&code(CART), "terms").contains("9.81"));
    assert!(!function(&code(&open), "terms").contains("9.81"));
}

#[test]
fn parts_that_nothing_ties_are_named() {
    let apart = "mechanism Two { param m: kg = 1; param l: m = 2; const g: m/s^2 = 9.81;
        coord x: m; coord a: rad; coord y: m;
        kinetic 1/2*m*(der(x)^2 + der(y)^2) + 1/2*m*l^2*der(a)^2; potential m*g*(l*cos(a) + y);
        constraint x^2 + y^2 = l^2; start { a = 1; x = 2; y ~ 0; } }";
    for tie in [
        "potential m*g/l*x*a*l;",
        "kinetic 1/4*m*(der(x) + l*der(a))^2;",
        "constraint x = l*a;",
        "force m*g*sin(a) on x;",
    ] {
        let tied = apart.replace("constraint x^2", &format!("{tie} constraint x^2"));
        let line = differs("ties", "tie these parts", [&tied, apart]);
        assert!(line.contains("{x, y} and {a};"), "{line}");
    }
    // Together they cost what each costs by itself.
    let spent = |source: &str| {
        let code = code(source);
        let solve = function(&code, "acceleration");
        solve.matches("mul_add").count() + solve.matches(" * ").count()
    };
    let hung = "mechanism Hung { param m: kg = 1; param l: m = 2; const g: m/s^2 = 9.81;
        coord x: m; coord y: m; kinetic 1/2*m*(der(x)^2 + der(y)^2); potential m*g*y;
        constraint x^2 + y^2 = l^2; start { x = 2; y ~ 0; } }";
    let pendulum = "mechanism Pendulum { param m: kg = 1; param l: m = 2; const g: m/s^2 = 9.81;
        coord a: rad; kinetic 1/2*m*l^2*der(a)^2; potential m*g*l*cos(a); start { a = 1; } }";
    assert!(spent(apart) <= spent(hung) + spent(pendulum));
}

#[test]
fn loops_that_neither_constraints_nor_masses_tie_have_sheets_of_their_own() {
    // A spring between two cranks ties neither.
    let sprung = "mechanism Two { param m: kg = 1; param l: m = 2; param k: N = 3;
        coord a: m; coord b: m; coord c: m; coord d: m;
        kinetic 1/2*m*(der(a)^2 + der(b)^2 + der(c)^2 + der(d)^2); potential k*(a - c)^2/l;
        constraint a^2 + b^2 = l^2; constraint c^2 + d^2 = l^2;
        start { a = l; b ~ 0; c = l; d ~ 0; } }";
    for tie in ["kinetic 1/4*m*(der(a) + der(c))^2;", "constraint a = c;"] {
        let tied = sprung.replace("constraint a^2", &format!("{tie} constraint a^2"));
        let line = differs("sheets", "near a singular configuration", [&tied, sprung]);
        assert!(line.contains("of {a, b} and {c, d},"), "{line}");
        assert!(code(&tied).contains("components: &[]"));
    }
    assert_eq!(code(sprung).matches("ConnectedComponent {").count(), 2);
    // Nothing is said where there are none to be near.
    let fixed = sprung.replace("param l", "const l");
    assert!(!left_out("sheets", &fixed).contains("near a singular"));
}

#[test]
fn outputs_cost_nothing_until_they_are_asked_for() {
    let watched = CART.replace("start {", "output tip: m = P.x*cos(a); start {");
    let line = differs("asked", "outputs (", [CART, &watched]);
    assert!(line.contains("until they are asked for"), "{line}");
    let terms = |source: &str| function(&code(source), "terms").to_string();
    assert_eq!(terms(CART), terms(&watched));
}

#[test]
fn entries_that_are_numbers_are_written_once() {
    let source = |kind: &str| {
        format!(
            "mechanism Bead {{ coord x: m; coord y: m; {kind} m: kg = 2; const g: m/s^2 = 9.81;
            kinetic 1/2*m*(der(x)^2 + der(y)^2); potential m*g*y; {kind} a: 1/m = 3;
            constraint m*y = m*a*x^2; start {{ x = 1; }} }}"
        )
    };
    let [set, frozen] = ["param", "const"].map(source);
    let line = differs("numbers", "the first time", [&set, &frozen]);
    assert!(line.contains("4 entries"), "{line}");
    let code = code(&frozen);
    for buffer in ["terms", "position"] {
        let first = function(&code, &format!("begin_{buffer}"));
        assert!(first.contains("out.mass.data.0[0][0] = "), "{first}");
        assert!(first.contains("out.jacobian.data.0[1][0] = "), "{first}");
        let again = function(&code, &format!("{buffer}("));
        assert!(!again.contains("out.mass"), "{again}");
        assert!(!again.contains("out.jacobian.data.0[1]"), "{again}");
        assert!(again.contains("out.jacobian.data.0[0][0] = "), "{again}");
    }
}

#[test]
fn rows_that_follow_from_others_are_left_out_of_the_solve() {
    let tied = |more: &str| {
        format!(
            "mechanism Tied {{ param m: kg = 1; coord x: m; coord y: m; coord z: m; coord w: m;
            kinetic 1/2*m*(der(x)^2 + der(y)^2 + der(z)^2 + der(w)^2);
            constraint x = y; constraint y = z; {more} start {{ x = 1; y ~ 1; z ~ 1; w ~ 1; }} }}"
        )
    };
    let (independent, follows) = (
        tied("constraint x + y = z + w;"),
        tied("constraint x + y = 2*z;"),
    );
    let line = differs(
        "redundant",
        "row of G in the solve",
        [&independent, &follows],
    );
    assert!(
        line.contains("of 3: ") && line.contains("follows"),
        "{line}"
    );
    assert!(code(&independent).contains("redundant: &[]"));
    let code = code(&follows);
    assert!(
        ["[0]", "[1]", "[2]"]
            .iter()
            .any(|row| code.contains(&format!("redundant: &{row}")))
    );
    assert!(code.contains("fn acceleration("));
}
