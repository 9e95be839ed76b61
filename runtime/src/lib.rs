//! Integrates closed-loop mechanisms straight through their singular positions.
#![cfg_attr(not(feature = "std"), no_std)]

mod model;
mod real;
mod state;

pub use model::{
    Branch, Canvas, ConstraintRow, Direction, Energy, Event, Initial, Interface, Mechanism,
    Position, Quantity, Start, Structure, Terms,
};
pub use real::Real;
pub use state::State;
