//! The front end is linear in the size of the file.

use super::{accept, with};
use std::fmt::Write;
use std::time::Instant;

/// A description of about this many tokens: many quantities that use one another.
fn description(tokens: usize) -> String {
    let mut statements = String::from("param a = 1; let x0 = q;");
    for i in 0..tokens / 25 {
        let _ = writeln!(
            statements,
            "let x{} = a*sin(x{i} + {i}) - (w + t)^2/3;",
            i + 1
        );
    }
    let _ = write!(statements, "output y = x{};", tokens / 25);
    with(&statements)
}

#[test]
fn a_hundred_thousand_tokens_take_less_than_a_second() {
    let source = description(100_000);
    let start = Instant::now();
    accept(&source);
    // The bound is for optimised code; the rest leaves room for slow machines.
    let bound = if cfg!(debug_assertions) { 10.0 } else { 1.0 };
    let seconds = start.elapsed().as_secs_f64();
    assert!(seconds < bound, "{seconds} s");
}

#[test]
fn time_grows_in_proportion_to_size() {
    let time = |tokens: usize| {
        let source = description(tokens);
        let run = || {
            let start = Instant::now();
            accept(&source);
            start.elapsed().as_secs_f64()
        };
        (0..3).map(|_| run()).fold(f64::INFINITY, f64::min)
    };
    let (small, large) = (time(20_000), time(160_000));
    assert!(
        large < 24.0 * small,
        "eight times the size takes {} times as long",
        large / small
    );
}
