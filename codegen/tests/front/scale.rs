//! The front end is linear in the size of the file.

use super::{accept, with};
use std::fmt::Write;
use std::hint::black_box;
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

/// Steps of a computation whose every step waits for the one before: about as many
/// nanoseconds on any machine of these years.
const SIMPLE_STEPS: u64 = 100_000_000;

/// The fewest seconds of three runs.
fn seconds(run: impl Fn()) -> f64 {
    let time = || {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    (0..3).map(|_| time()).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_hundred_thousand_tokens_take_no_longer_than_a_billion_simple_steps() {
    let source = description(100_000);
    let simple = seconds(|| {
        let step = |x: u64, i: u64| (x ^ i).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(7);
        black_box((0..black_box(SIMPLE_STEPS)).fold(1, step));
    });
    let reading = seconds(|| drop(accept(&source)));
    assert!(
        reading < 10.0 * simple,
        "{reading} s, and {simple} s for {SIMPLE_STEPS} simple steps"
    );
}

#[test]
fn time_grows_in_proportion_to_size() {
    let time = |tokens: usize| {
        let source = description(tokens);
        seconds(|| drop(accept(&source)))
    };
    let (small, large) = (time(20_000), time(160_000));
    assert!(
        large < 24.0 * small,
        "eight times the size takes {} times as long",
        large / small
    );
}
