//! The exact motions are motions of the mechanisms that they are compared with.

use crate::SEED;
use bricard_singular::{SERIES, contradiction};

/// Trials of each series.
const RUNS: usize = 10;
/// Round-off, and the error of dense output at the reductions' tolerance; constraints in
/// units of 1e-8 … 1e8 of their own are among them.
const BOUND: f64 = 1e-7;

#[test]
fn every_reduction_satisfies_the_constraints_and_keeps_the_energy_of_the_whole() {
    let mut seen = 0;
    for series in SERIES {
        for trial in series.trials(SEED, 0..RUNS, &[1e-9]) {
            let Some(off) = contradiction(&trial) else {
                continue;
            };
            assert!(off <= BOUND, "{trial}: off by {off:e}");
            seen += 1;
        }
    }
    assert!(seen > 20 * RUNS, "only {seen} were looked at");
}
