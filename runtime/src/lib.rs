//! Integrates closed-loop mechanisms straight through their singular positions.
#![cfg_attr(not(feature = "std"), no_std)]

mod assembly;
mod catalogue;
mod crossing;
mod dynamics;
mod equations;
mod error;
mod extremum;
mod integrator;
mod kink;
mod linalg;
mod model;
mod natural_size;
mod number;
mod observer;
mod once;
mod pace;
mod picture;
mod projection;
mod real;
mod sides;
mod simulate;
mod sincos;
mod singular;
mod stack;
mod state;
mod structure;
mod system;
mod table;
mod tolerance;
mod zeroed;

pub use assembly::{AssemblyError, StartEquations, StartFault, assemble, guess, meet};
pub use catalogue::Visitor;
pub use dynamics::{
    ConstrainedSystem, ConstraintError, Counters, Form, Rank, Settings, Solver, Stabilisation,
};
pub use error::{DynamicsError, Singularity, Watched};
pub use integrator::{
    Dop853, Dp5, IntegrateError, Integrator, Method, Radau5, Radau9, Rk4, Step, Tolerance,
};
pub use model::{
    Acceleration, Canvas, Correction, Described, Differentiated, Energy, Initial, Interface,
    Linearised, Mechanism, Partials, Pivots, Position, Start, Terms, Whole,
};
pub use nalgebra;
#[doc(hidden)]
pub use observer::Grid;
#[cfg(feature = "std")]
pub use observer::Recorder;
pub use observer::{
    BadInterval, ConstraintAudit, EnergyAudit, Observer, Occurrence, OtherBranch, Probe, Sampler,
};
#[doc(hidden)]
pub use picture::Picture;
pub use real::Real;
pub use sides::{Condition, Discontinuity, Sides, Switch, Switches};
pub use simulate::{
    Audit, Failure, Options, Origin, SimulateError, StepControl, Stepper, Summary, simulate,
};
pub use singular::Passage;
pub use stack::with_room;
pub use state::State;
#[doc(hidden)]
pub use structure::written_for;
pub use structure::{
    ConnectedComponent, ConstraintRow, Declared, Direction, Event, Multiplier, Quantity, Structure,
};
pub use system::{AccelerationJacobian, Switching, System};
pub use table::Table;
