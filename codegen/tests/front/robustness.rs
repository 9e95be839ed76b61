//! Whatever is written, the answer is a mechanism or findings with their places:
//! never a panic, never a hang.

use super::mechanisms::library;
use bricard_codegen::internals::analyse;
use bricard_codegen::{CompileSettings, compile_source};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::fmt::Write;

/// Descriptions that use every part of the language.
fn samples() -> Vec<String> {
    let everything = "/// All of it.\nmechanism All {\n const K = 2; const g: m/s^2 = 9.81; param a: m = 1/2; coord q: rad; coord p[K]: m;
        input u: N*m = if q < 1 then sin(2*t) else -max(q, der(q)); let d[i in 0..K] = [p[i], i*a, 0]; let R = rotz(q)*rotx(-q);
        kinetic 1/2*sum(i in 0..K, norm2(der(R*d[i]))) + q^2^1*der(q)^2; potential (d[0] + d[1]).x*a;
        dissipation 1/2*der(q)^2; force u on q; force [0, 0, a] on d[1];
        for i in 0..K { let x = p[i]; constraint x = a*cos(q + i*90*deg); }
        constraint der(p[0]) = der(p[1]); start { q = 45*deg; for i in 0..K { p[i] ~ 0.7; } der(q) = 1e-3; }
        output w = omega(R); event e: q - pi crossing; draw line([0, 0, 0], d); draw circle(d[0], a/10); }"
        .replace(": m/s^2", "").replace(": m", "").replace(": rad", "").replace(": N*m", "");
    let parts = "mechanism Parts {\n use parts; const v[5] = [1, 2, 3, 4, 5]; param c: m = [1, 0.5]; fn f(x, y: rad): m = x*cos(y)*c + [1, 0] m;
        param w[i in 0..2] = v[i]; input u[2]: N = [t, 1]; part Link(foot: m, n) { coord q: rad; coord s[n]; let tip = foot + rot(q)*c;
        let bob = PointMass(tip, 2, [0, -9.81]); kinetic sum(i in 0..n, der(s[i])^2)*w[0]; force v[1]*w[1] on omega(rot(q));
        start { q = 0.1; } output a = tip; }
        let one = Link([0, 0], 1); let row[i in 0..2] = Link(if i == 0 then one.tip else row[i-1].tip, i + 1);
        constraint row[1].tip = f(2, one.q); force u on row[0].tip; start { row[0].s[0] = 1; } }".to_string();
    vec![everything, parts, library()[0].1.clone()]
}

/// Analyses and renders; the result doesn't matter, coming back does.
fn survive(source: &str) {
    match analyse(source, &CompileSettings::default()) {
        Ok((_, warnings)) => drop(warnings.render("test.mech", source)),
        Err(errors) => {
            assert!(errors.error_count() > 0, "refused without a word: {source}");
            let text = errors.render("test.mech", source);
            assert!(text.starts_with("test.mech:"), "{text}");
        }
    }
}

#[test]
fn the_samples_are_right() {
    for source in samples() {
        super::accept(&source);
    }
}

#[test]
fn a_file_may_end_anywhere() {
    for source in samples() {
        for end in (0..source.len()).filter(|&end| source.is_char_boundary(end)) {
            survive(&source[..end]);
            survive(&format!("{}}}", &source[..end]));
        }
    }
}

/// The pieces of a text: words, numbers, signs, blanks.
fn pieces(source: &str) -> Vec<String> {
    let class = |c: char| {
        (
            c.is_alphanumeric(),
            c.is_whitespace(),
            if c.is_ascii_punctuation() { c } else { ' ' },
        )
    };
    let mut pieces: Vec<String> = Vec::new();
    let mut last = None;
    for character in source.chars() {
        match pieces.last_mut() {
            Some(piece) if last == Some(class(character)) => piece.push(character),
            _ => pieces.push(character.to_string()),
        }
        last = Some(class(character));
    }
    pieces
}

#[test]
fn any_token_may_be_missing_or_doubled() {
    for source in samples() {
        let pieces = pieces(&source);
        for i in 0..pieces.len() {
            survive(&[&pieces[..i], &pieces[i + 1..]].concat().concat());
            survive(
                &[
                    &pieces[..i],
                    &pieces[i..=i],
                    &[" ".to_string()],
                    &pieces[i..],
                ]
                .concat()
                .concat(),
            );
        }
    }
}

#[test]
fn any_token_may_be_replaced_by_another() {
    let strange = [
        "}",
        "(",
        "mechanism",
        "1e9",
        "sum",
        "der",
        "..",
        "if",
        "q",
        "theta[0]",
        "^",
        "=",
        ";",
        "\u{3b8}",
        "'",
    ];
    for source in samples() {
        let mut pieces = pieces(&source);
        for i in 0..pieces.len() {
            let old = std::mem::replace(&mut pieces[i], strange[i % strange.len()].to_string());
            survive(&pieces.concat());
            pieces[i] = old;
        }
    }
}

/// Random tests run this many cases; `BRICARD_LONG=1` runs a hundred times more.
const CASES: u32 = 1000;

/// Runs a property with a fixed seed, so that a failure is one tomorrow too.
fn forall(strategy: impl Strategy<Value = String>) {
    let cases = if std::env::var_os("BRICARD_LONG").is_some() {
        100 * CASES
    } else {
        CASES
    };
    let rng_seed = RngSeed::Fixed(20_120_115);
    let config = Config {
        cases,
        failure_persistence: None,
        rng_seed,
        ..Config::default()
    };
    let result = TestRunner::new(config).run(&strategy, |source| {
        survive(&source);
        Ok(())
    });
    assert!(result.is_ok(), "{}", result.expect_err("a failure"));
}

#[test]
fn random_words_are_answered() {
    let samples = samples();
    let words: Vec<String> = samples.iter().flat_map(|source| pieces(source)).collect();
    let soup = prop::collection::vec(prop::sample::select(words), 0..60);
    forall(soup.prop_map(|words| super::with(&words.join(" "))));
}

#[test]
fn random_characters_are_answered() {
    forall(prop::collection::vec(any::<char>(), 0..80).prop_map(|c| c.into_iter().collect()));
    forall("[ -~\n]{0,80}".prop_map(|text| format!("mechanism M {{ {text} }}")));
}

/// A formula with one thing many times inside itself.
fn nested(open: &str, inside: &str, close: &str, depth: usize) -> String {
    super::with(&format!(
        "output y = {}{inside}{};",
        open.repeat(depth),
        close.repeat(depth)
    ))
}

#[test]
fn deep_nesting_is_refused_and_fifty_levels_are_not() {
    let forms = [
        ("(", ")"),
        ("[0, ", "].y"),
        ("-", ""),
        ("2^", ""),
        ("sin(", ")"),
        ("if q < 1 then 1 else ", ""),
    ];
    for (open, close) in forms {
        super::accept(&nested(open, "q", close, 40));
        super::refuse_saying(&nested(open, "q", close, 10_000), "inside one another");
    }
    super::refuse_saying(&nested("", "q", "[0]", 10_000), "in a row");
    super::refuse_saying(
        &format!("mechanism M {}", "{".repeat(10_000)),
        "more than 100 brackets",
    );
    let loops = format!(
        "{}{}",
        "for i in 0..1 { ".repeat(10_000),
        "}".repeat(10_000)
    );
    super::refuse_saying(&super::with(&loops), "more than 100 brackets");
    survive(&"/*".repeat(10_000));
    survive(&")".repeat(10_000));
}

#[test]
fn long_formulas_are_not_deep() {
    let mut sum = String::from("q");
    for i in 0..20_000 {
        let _ = write!(sum, " + {i}*q - w*q/2");
    }
    super::accept(&super::with(&format!("output y = {sum};")));
    super::accept(&super::with(&format!(
        "output y = q{};",
        "*w".repeat(20_000)
    )));
}

/// Stack of a thread that a program starts, unless it says otherwise, in bytes.
const SMALL_STACK: usize = 2 << 20;

#[test]
fn what_is_deep_or_long_compiles_on_a_small_stack() {
    // Each quantity within the next: derivatives have products of forty factors.
    let mut within = String::from("let a0 = q;");
    for i in 1..40 {
        let _ = write!(within, "let a{i} = sin(a{}) + {i}*w;", i - 1);
    }
    let terms: Vec<String> = (1..200).map(|i| format!("sin({i}*q)*w")).collect();
    let factors: Vec<String> = (1..60).map(|i| format!("(q + {i})")).collect();
    let work = move || {
        for statements in [
            format!("{within} potential a39;"),
            format!("potential {};", terms.join(" + ")),
            format!("potential {};", factors.join("*")),
            format!("potential {}q{};", "sin(".repeat(50), ")".repeat(50)),
        ] {
            let source = super::with(&statements);
            let compiled =
                compile_source(&source, "test", "test.mech", &CompileSettings::default());
            assert!(compiled.is_ok(), "{statements}");
        }
    };
    let thread = std::thread::Builder::new().stack_size(SMALL_STACK);
    thread.spawn(work).unwrap().join().unwrap();
}

#[test]
fn endless_work_is_refused() {
    super::refuse_saying(
        &super::with("let a = sum(i in 0..1000000000, i);"),
        "a range of 1000000000 indices",
    );
    super::refuse_saying(
        &super::with("for i in 0..9000000000000000000 { }"),
        "is too large",
    );
    let doubling: String = (0..64)
        .map(|i| format!("let x{} = x{i}*x{i} + x{i};", i + 1))
        .collect();
    super::accept(&super::with(&format!(
        "let x0 = q; {doubling} output y = der(x64);"
    )));
}

#[test]
fn loops_that_are_within_bounds_one_by_one_are_refused_together() {
    for (nested, most) in [
        (
            "for i in 0..2000 { for j in 0..2000 { let a = 1; } }",
            "1000000 rounds of loops",
        ),
        (
            "start { for i in 0..2000 { for j in 0..2000 { } } }",
            "1000000 rounds of loops",
        ),
        ("for i in 0..200000 { let a = 1; }", "150000 expressions"),
    ] {
        super::refuse_saying(
            &super::with(nested),
            &format!("unrolled, this description has more than {most}"),
        );
    }
}

#[test]
fn loops_in_which_nothing_stands_cost_nothing_and_are_warned_of() {
    for loops in [
        "for i in 0..1000000 { }",
        "for i in 0..1000000 { for j in 0..1000000 { } }",
    ] {
        let said = super::warnings(&super::with(loops));
        assert_eq!(
            said.matches("nothing stands in this loop").count(),
            1,
            "{said}"
        );
    }
}

#[test]
fn numbers_beyond_all_bounds_are_refused_and_none_becomes_zero() {
    let refused = [
        "2^1000000",
        "(10^300)^300",
        "7^7^7^7",
        "1e400",
        "1e-400",
        "1e-320",
        "10^-400*q",
        "0.1^1000",
        "1e-200*1e-200*q",
        "1e308*1e308",
        "q/(w - w)",
        "q^(10^9)",
    ];
    for formula in refused {
        super::refuse(&super::with(&format!("output y = {formula};")));
    }
    for formula in [
        "q^1000",
        "(1/3)^500*3^500",
        "1e-300*q*1e300",
        "1e-308*q",
        "0e-400*q",
        "0*q",
        "0^3",
    ] {
        super::accept(&super::with(&format!("output y = {formula};")));
    }
}

#[test]
fn numbers_that_leave_all_bounds_while_equations_are_derived_are_refused_or_left_out() {
    let compiled = |statement: &str| {
        let source = format!("mechanism Test {{ coord x; kinetic der(x)^2; {statement} }}");
        let compiled = compile_source(&source, "test", "test.mech", &CompileSettings::default());
        compiled.map_err(|errors| errors.render("test.mech", &source))
    };
    let zigzag = (0..40).map(|i| format!("[{i}, {}1e308]", if i % 2 == 0 { "-" } else { "" }));
    let zigzag: Vec<String> = zigzag.collect();
    for statement in [
        "potential 1e308*x^2;",
        "kinetic 1e308*der(x)^2;",
        "constraint 1e200*x = 0;",
        "force table([[0, -1e308], [1, 1e308]], x) on x;",
        "force table([[0, 0], [1e-308, 1e308]], x) on x;",
        "force spline([[0, 0], [1e-200, 1e308], [1, 0]], x) on x;",
        &format!("force table([{}], x) on x;", zigzag.join(", ")),
        "force 1e308*x on x; force 1e308*x on x;",
    ] {
        let refused = compiled(statement).err();
        let refused = refused.unwrap_or_else(|| panic!("{statement} was accepted"));
        assert!(refused.contains("not finite"), "{refused}");
        assert!(refused.contains("^^^"), "{refused}");
    }
    for statement in [
        "potential 1e306*x^15;",
        "force x*exp(1e308*x) on x;",
        "potential 1e306*x*exp(1e306*x);",
        "output a = der(der(exp(1e200*x)));",
        "coord y; kinetic 1e200*(der(x) + 2*der(y))^2 + 1e200*der(y)^2;",
    ] {
        let code = compiled(statement).map(|compiled| compiled.code);
        let code = code.unwrap_or_else(|refused| panic!("{refused}"));
        assert!(!code.contains("inf"), "{code}");
    }
}
