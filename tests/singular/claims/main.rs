//! What is claimed of runs through and beside singular positions.
//!
//! `BRICARD_LONG=1` runs many times more of them; build with `--release` then. The
//! command of this package prints the same as a table.

mod accuracy;
mod corners;
mod known;
mod largest;
mod massless;
mod mirrored;
mod narrow;
mod passages;
mod reactions;
mod redundant;
mod references;
mod scalar;
mod scores;
mod sizes;
mod stabilisation;
mod starts;
mod stops;
mod together;
mod tolerances;

/// The seed of all random trials.
const SEED: u64 = 12;

/// Whether the long form was asked for.
fn is_long() -> bool {
    std::env::var_os("BRICARD_LONG").is_some()
}
