//! Every mechanism of the library runs from its own start with its energy, or power,
//! and its constraints in order; so do fixtures that are hard to run.

use crate::library::time_scale;
use crate::motion::run;
use bricard_runtime::Options;

/// Odd mechanisms: on positions that are singular in unusual ways, or with steps in which
/// they turn many times.
const HARD: [&str; 2] = ["kite", "timed_crank"];

/// How long (s), for a mechanism of usual speed.
const SPAN: f64 = 10.0;

/// Tolerance of the integration.
const TOLERANCE: f64 = 1e-10;

/// Far more steps than any of them needs.
const MOST_STEPS: u64 = 50_000;

/// What the balance of energy may be off (J): the tolerance times some hundred steps,
/// powers of some hundred watts and the growth of errors in chaotic motion.
const ENERGY_ERROR: f64 = 1e-6;

/// What the constraints may be off (m or rad).
const CONSTRAINT_ERROR: f64 = 1e-12;

#[test]
fn every_mechanism_runs_for_ten_seconds_with_energy_and_constraints_in_order() {
    let all = bricard::NAMES.iter().chain(&HARD);
    for name in all.copied() {
        let span = SPAN * time_scale(name);
        let mut options = Options::dop853(span, TOLERANCE);
        options.most_steps = Some(MOST_STEPS);
        let outcome = run(name, &options);
        assert_eq!(outcome.error, None, "{name}");
        assert_eq!(outcome.t, span, "{name}");
        let energy = outcome.energy_error;
        assert!(
            energy <= ENERGY_ERROR,
            "{name}: energy is off by {energy:e} J"
        );
        let constraint = outcome.constraint_error.position;
        assert!(
            constraint <= CONSTRAINT_ERROR,
            "{name}: constraints are off by {constraint:e}"
        );
    }
}
