//! The symbolic engine and the optimiser against arithmetic that shares nothing
//! with them.

mod angles;
mod canonical;
mod columns;
mod components;
mod derivative;
mod independent;
mod jet;
pub(crate) mod joint;
pub mod limits;
mod number;
mod passes;
mod print;
mod program;
mod recipe;
mod ring;
mod shared;
mod solve;
mod text;
mod weighed;
mod zero;

use proptest::test_runner::{Config, RngSeed, TestCaseError};

/// Random tests run this many cases; `BRICARD_LONG=1` runs a hundred times more.
const CASES: u32 = 1000;

/// How many times the first-order bound on round-off two orders of the same
/// operations may differ by.
const SLACK: f64 = 16.0;

/// A fixed seed, so that a failure is one tomorrow too. A failure is shrunk and
/// printed whole.
fn config() -> Config {
    let long = std::env::var_os("BRICARD_LONG").is_some();
    let cases = if long { 100 * CASES } else { CASES };
    Config {
        cases,
        max_global_rejects: cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_120_115),
        ..Config::default()
    }
}

/// Two values are the same but for round-off of a given size.
fn agree(found: f64, exact: f64, round_off: f64) -> Result<(), TestCaseError> {
    let bound = SLACK * round_off + f64::MIN_POSITIVE;
    if (found - exact).abs() <= bound || !round_off.is_finite() {
        return Ok(());
    }
    let message = format!("{found:e} is not {exact:e}: they may differ by {bound:e}");
    Err(TestCaseError::fail(message))
}
