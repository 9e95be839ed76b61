//! Mechanisms that are driven through and beside singular positions, each with a motion
//! that is known exactly, and a score for what a run comes to.
//!
//! A [`Series`] makes [`Trial`]s at random from a seed; [`judge`] runs one and compares.
//! Descriptions stand in `descriptions/`, each with a reduction to independent
//! coordinates, without constraints, that the same generator compiles.

// Its simulation of each pair of sizes is shared, where the compiler shares generic code.
use bricard as _;

mod agree;
mod along;
mod exact;
mod judge;
mod planted;
mod planting;
mod series;
mod table;
mod track;
mod trial;
mod workers;

pub use agree::contradiction;
pub use exact::{Exact, exact};
pub use judge::{Score, Verdict, judge};
pub use series::{SERIES, Series, find};
pub use table::{Line, line, print};
pub use trial::{Compare, Set, Trial, Wanted};
pub use workers::{Ran, run_all};

/// What the generator made of the descriptions.
pub mod descriptions {
    include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
}
