//! Stress: every case ends in a right answer or in an error that says when and why.
//!
//! `docs/stress.md` lists the cases with what they come to. `BRICARD_LONG=1` adds the
//! longest runs.

// Its simulation of each pair of sizes is shared, where the compiler shares generic code.
use bricard as _;

mod again;
mod case;
mod judge;
mod limits;
mod long;
mod masses;
mod starts;
mod table;
