//! What is compiled once for each scalar.
//!
//! Out: [`Routines`], of which each scalar has one table.
//!
//! Generic functions are compiled where they are called, in the crate of every mechanism.
//! The tables of `f64` and `f32` are part of this crate, and so is the code behind them.

use crate::{Real, assembly, singular};

/// The routines of a scalar.
#[derive(Debug)]
pub struct Routines<T> {
    /// What works on sheets of the constraint set.
    pub(crate) sheet: singular::Routines<T>,
    /// What assembles consistent states.
    pub(crate) assembly: assembly::Routines<T>,
}

impl<T: Real> Routines<T> {
    /// Those of any scalar.
    pub const fn new() -> Self {
        Self {
            sheet: singular::Routines::new(),
            assembly: assembly::Routines::new(),
        }
    }
}
