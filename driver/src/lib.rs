//! Runs a mechanism whose type and sizes are forgotten, in the same program or in one of
//! its own.
//!
//! [`erase_type`] makes an [`AnyMechanism`] of a generated mechanism; everything behind it is
//! compiled once for each pair of sizes. [`serve`] puts one behind standard input and
//! output, for a program that does nothing else; [`Link`] is the other end, and an
//! [`AnyMechanism`] too. [`Precise`], with [`serve_precise`] and [`PreciseLink`], is the
//! same for motions to many more digits.
//!
//! Not here: what a run is for. Files, progress and Ctrl-C are the business of whoever
//! watches it ([`Watch`]).

mod any;
mod column;
mod digits;
mod link;
mod precise;
mod scene;
mod segment;
mod serve;
mod wire;
mod writer;

pub use any::{AnyMechanism, EraseType, Given, TimedRun, erase_type, state_of};
pub use column::{Column, WORDS, heads};
pub use digits::{Around, Changes, Exact, Path, Precise};
pub use link::Link;
pub use precise::{PreciseLink, serve_precise};
pub use scene::{Drawn, Scene};
pub use segment::{Reached, Segment, Watch};
pub use serve::{serve, with_room};
