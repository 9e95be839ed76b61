//! With several degrees of freedom, passages and turnings at any speed are as accurate as
//! the tolerance says.

use crate::{SEED, is_long};
use bricard_runtime::{Method, Options, Whole, assemble, simulate};
use bricard_singular::descriptions::equal_slider_crank::EqualSliderCrank;
use bricard_singular::{Score, find, run_all};

/// Tolerances and what the end of a short run may be off by.
const FIGURES: [(f64, f64); 2] = [(1e-10, 1e-8), (1e-12, 1e-10)];

fn accurate(name: &str) {
    let series = find(name).expect("it is a series");
    let runs = if is_long() { series.long } else { 30 };
    for (tolerance, bound) in FIGURES {
        let ran = run_all(series.trials(SEED, 0..runs, &[tolerance]));
        let bad = |ran: &&bricard_singular::Ran| {
            // A run that ends in an error is judged by the scores.
            let right = ran.verdict.score == Score::Right && ran.verdict.last <= bound;
            !right && ran.verdict.score != Score::Ended
        };
        let bad: Vec<String> = ran
            .iter()
            .filter(bad)
            .map(|ran| {
                format!(
                    "{}\n    off by {:.1e} {}",
                    ran.trial, ran.verdict.last, ran.verdict.why
                )
            })
            .collect();
        assert!(
            bad.is_empty(),
            "{name}: {} of {runs}\n{}",
            bad.len(),
            bad.join("\n")
        );
    }
}

#[test]
fn turnings_are_accurate() {
    accurate("turning");
}

#[test]
fn slow_passages_are_accurate() {
    accurate("slow");
}

#[test]
fn grazing_motions_are_accurate() {
    accurate("grazing");
}

/// Where the guesses of stages are good, one Newton iteration is enough, and shows no rate of
/// convergence; derivatives must not be kept until they are far off all the same.
#[test]
fn the_energy_error_of_implicit_steps_follows_the_tolerance() {
    for method in [Method::Radau5, Method::Radau9] {
        for tolerance in [1e-6, 1e-7, 1e-8, 1e-9] {
            let mut mechanism = EqualSliderCrank::<f64>::default();
            mechanism.parameters.p0 = 1.0;
            let mechanism: &dyn Whole<f64, 2, 1> = &mechanism;
            let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
            let options = Options {
                method,
                ..Options::dop853(3.0, tolerance)
            };
            let ran = simulate(mechanism, &start, &options, &mut []);
            let summary = ran.unwrap_or_else(|failure| panic!("{failure}"));
            let error = summary.energy_error.expect("it is audited");
            assert!(
                error < 300.0 * tolerance,
                "{method:?} at {tolerance:e}: {error:e} J"
            );
        }
    }
}
