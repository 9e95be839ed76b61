//! Mechanisms written by hand, with exact solutions: what the runtime is tested
//! on before any code is generated.
//!
//! Parameters and end values: Phong & Hoang (2012), section 4, and the exact
//! one-degree-of-freedom reductions of its examples.

mod four_bars;
mod hanging;
mod hung;
mod massless;
mod parallelogram;
mod reference;
mod row;
mod side;
mod slider_crank;
mod small;
mod twice;

pub use bricard_testkit::Reduction;
pub use four_bars::FourBars;
pub use hanging::{Hanging, RODS, place};
pub use hung::{Hung, HungReduced};
pub use massless::Massless;
pub use parallelogram::Parallelogram;
pub use reference::{Passage, Reduced};
pub use row::{Row, sizes};
pub use side::{COUNT, Side};
pub use slider_crank::SliderCrank;
pub use small::{Sled, Spring};
pub use twice::Twice;

use bricard_runtime::{ConstraintRow, Energy, Mechanism, Quantity, State, Structure};

/// Gravitational acceleration (m/s²).
pub const GRAVITY: f64 = 9.81;

/// The energies (J) of a mechanism to which nothing but forces of so much power (W) supplies
/// energy.
pub fn supplied(kinetic: f64, potential: f64, power: f64) -> Energy<f64> {
    Energy {
        kinetic,
        potential,
        balance: kinetic + potential,
        power,
    }
}

/// A mechanism of one degree of freedom that passes a singular position, and the
/// exact motion to compare with.
pub trait Passing<const N: usize, const R: usize>: Mechanism<f64, N, R> {
    /// Its motion as a function of one angle.
    fn reduction(&self) -> Reduction;
    /// The full state that belongs to an angle and its rate.
    fn state(&self, t: f64, angle: f64, rate: f64) -> State<f64, N>;
    /// A singular angle, and the rate with which the paper's motion passes it.
    fn singular(&self) -> (f64, f64);
}

/// A structure with nothing but coordinates and constraints on positions that stay what
/// they are.
pub const fn structure(
    coordinates: &'static [Quantity],
    constraints: &'static [ConstraintRow],
) -> Structure {
    Structure {
        name: "ByHand",
        coordinates,
        constraints,
        conservative: true,
        scleronomic: true,
        ..Structure::PLAIN
    }
}

/// A coordinate that is an angle.
pub const ANGLE: Quantity = Quantity {
    name: "",
    unit: "rad",
    docs: "",
};

/// A coordinate that is a length.
pub const LENGTH: Quantity = Quantity {
    name: "",
    unit: "m",
    docs: "",
};
