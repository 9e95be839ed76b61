//! Integrates closed-loop mechanisms straight through their singular positions.
#![cfg_attr(not(feature = "std"), no_std)]

mod dynamics;
mod error;
mod integrator;
mod catalogue;
mod model;
mod real;
mod state;
mod system;

pub use dynamics::{Counters, Form, Settings, Stabilisation};
pub use error::DynamicsError;
pub use catalogue::Visitor;
pub use integrator::{Dop853, Dp5, IntegrateError, Integrator, Rk4, Step, Tolerance};
pub use model::{
    Branch, Canvas, ConstraintRow, Direction, Energy, Event, Initial, Interface, Mechanism,
    Position, Quantity, Start, Structure, Terms,
};
pub use real::Real;
pub use state::State;
pub use system::System;
pub use nalgebra;
