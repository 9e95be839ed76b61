//! What is legal in a description but probably not meant, found with numbers.
//!
//! In:  a checked [`Mechanism`] and its equations of motion.
//! Out: warnings: kinetic energy that is negative, statements that are not finite where the motion
//!      begins, coordinates without inertia, equations whose derivatives vanish
//!      where they hold, constraints of velocities that are rates of equations for positions, a
//!      start that can't be assembled or goes with several branches
//!      ([`Lints::warnings`]); equations that follow from others ([`Lints::redundancies`]), and
//!      which of them a solve can leave out ([`Lints::redundant_rows`]).
//!
//! Everything is evaluated at a few random positions that satisfy the constraints,
//! with parameters at their defaults: what is found at all of them is said, what
//! can't be decided is not. Mechanisms above a size are left alone, so that the
//! work is bounded.
//!
//! Not here: errors. A run decides about each position by itself.

mod basis;
mod branch;
mod finite;
mod inertia;
mod integrable;
mod least_squares;
mod negative;
mod numbers;
mod redundant;
mod rows;
mod start;

use crate::derive::Equations;
use crate::diagnostic::Diagnostics;
use crate::model::Mechanism;
use numbers::Numbers;

/// A mechanism looked at with numbers. What several questions need is found once.
#[derive(Debug)]
pub struct Lints<'a> {
    mechanism: &'a Mechanism,
    equations: &'a Equations,
    /// Its motion in numbers; `None` if it is too large.
    motion: Option<Numbers<'a>>,
}

impl<'a> Lints<'a> {
    /// Prepares a mechanism with its equations of motion.
    pub fn of(mechanism: &'a Mechanism, equations: &'a Equations) -> Self {
        Self {
            mechanism,
            equations,
            motion: Numbers::of_motion(mechanism, equations),
        }
    }

    /// Warns of what will hinder a simulation: a negative kinetic energy, a coordinate that
    /// moves without kinetic energy and that no constraint restricts, an equation whose
    /// derivatives vanish where it holds, a start that can't be assembled.
    pub fn warnings(&self) -> Diagnostics {
        let mut found = Diagnostics::new();
        if let Some(numbers) = Numbers::of_start(self.mechanism, self.equations) {
            start::unassembled(&numbers, &mut found);
            finite::statements(&numbers, &mut found);
        }
        if let Some(numbers) = &self.motion {
            let flat = rows::flat(numbers);
            rows::warn_of_flat(numbers, &flat, &mut found);
            integrable::rates(numbers, &mut found);
            if !negative::energy(numbers, &mut found) {
                inertia::massless(numbers, &mut found);
            }
        }
        found
    }

    /// Warns of equations that follow from the others at random positions. A run takes
    /// them as they are; only their reactions are not unique.
    pub fn redundancies(&self) -> Diagnostics {
        let mut found = Diagnostics::new();
        if let Some(numbers) = &self.motion {
            let flat = rows::flat(numbers);
            rows::warn_of_redundant(numbers, &flat, &mut found);
        }
        found
    }

    /// Constraint rows that follow from the others at random positions: the motion is the same
    /// without them. Those that stay are as far from dependence as can be.
    pub fn redundant_rows(&self) -> Vec<usize> {
        self.motion.as_ref().map_or_else(Vec::new, redundant::rows)
    }
}
