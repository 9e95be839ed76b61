//! What can be evaluated at a state, and how many numbers it is.
//!
//! In:  a quantity, a state.
//! Out: numbers; matrices row by row.

use crate::Embedded;
use crate::input_functions::Driven;
use bricard_runtime::nalgebra::SMatrix;
use bricard_runtime::{
    DynamicsError, Interface, Mechanism, Position, Probe, Solver, State, Structure, Terms,
};

/// What can be evaluated at a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// `M`, `N × N`.
    Mass,
    /// `p₁`, `N`.
    Force,
    /// `A`, `R × N`.
    Jacobian,
    /// `p₂`, `R`.
    Bias,
    /// `g`, `R`.
    Residual,
    /// `A q̇ + b`, `R`.
    Rate,
    /// `q̈`, `N`.
    Acceleration,
    /// `r`, `N`.
    Reaction,
    /// The outputs.
    Outputs,
    /// The functions of the events.
    Events,
    /// Kinetic and potential energy, their balance (J), and the power supplied (W).
    Energy,
    /// Rank, rank at regular positions, sine of the weakest row.
    Rank,
    /// `∂q̈/∂(q, q̇, u)`, a row of [`Quantity::varied`] for each acceleration.
    Slope,
    /// `∂y/∂(q, q̇, u)`, a row of [`Quantity::varied`] for each output.
    OutputSlope,
    /// Derivatives of the functions of the events by `(q, q̇, u)`, a row of [`Quantity::varied`]
    /// for each event.
    EventSlope,
}

impl Quantity {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 15] = [
        Self::Mass,
        Self::Force,
        Self::Jacobian,
        Self::Bias,
        Self::Residual,
        Self::Rate,
        Self::Acceleration,
        Self::Reaction,
        Self::Outputs,
        Self::Events,
        Self::Energy,
        Self::Rank,
        Self::Slope,
        Self::OutputSlope,
        Self::EventSlope,
    ];

    /// The quantity of a number.
    pub fn of(number: i32) -> Option<Self> {
        usize::try_from(number)
            .ok()
            .and_then(|number| Self::ALL.get(number).copied())
    }

    /// By how many numbers is differentiated: coordinates, velocities and states of the
    /// first order, inputs.
    pub fn varied(structure: &Structure) -> usize {
        let velocities = structure.coordinates.len();
        structure.freedoms().len() + velocities + structure.inputs.len()
    }

    /// Whether it is one of derivatives, which a mechanism may lack.
    pub fn is_slope(self) -> bool {
        matches!(self, Self::Slope | Self::OutputSlope | Self::EventSlope)
    }

    /// How many numbers it is.
    pub fn size(self, structure: &Structure, n: usize, r: usize) -> usize {
        match self {
            Self::Mass => n * n,
            Self::Jacobian => r * n,
            Self::Force | Self::Acceleration | Self::Reaction => n,
            Self::Bias | Self::Residual | Self::Rate => r,
            Self::Outputs => structure.outputs.len(),
            Self::Events => structure.events.len(),
            Self::Energy => 4,
            Self::Rank => 3,
            Self::Slope => n * Self::varied(structure),
            Self::OutputSlope => structure.outputs.len() * Self::varied(structure),
            Self::EventSlope => structure.events.len() * Self::varied(structure),
        }
    }
}

/// Writes a quantity at a state, one that is no derivative; there is room for all of it.
pub(crate) fn evaluate<M, const N: usize, const R: usize>(
    driven: &Driven<M>,
    solver: &mut Solver<f64, N, R>,
    quantity: Quantity,
    state: &State<f64, N>,
    out: &mut [f64],
) -> Result<(), DynamicsError<f64>>
where
    M: Embedded<N, R>,
{
    match quantity {
        Quantity::Mass | Quantity::Force | Quantity::Jacobian | Quantity::Bias => {
            let mut terms = Terms::<f64, N, R>::default();
            driven.terms(state, &mut terms);
            match quantity {
                Quantity::Mass => rows(&terms.mass, out),
                Quantity::Force => rows(&terms.force, out),
                Quantity::Jacobian => rows(&terms.jacobian, out),
                _ => rows(&terms.bias, out),
            }
        }
        Quantity::Residual | Quantity::Rate => {
            let mut position = Position::<f64, N, R>::default();
            driven.position(state, &mut position);
            match quantity {
                Quantity::Residual => rows(&position.residual, out),
                _ => rows(&(position.jacobian * state.v + position.drift), out),
            }
        }
        Quantity::Acceleration => rows(&solver.on(driven).acceleration(state)?, out),
        Quantity::Reaction => rows(&solver.on(driven).reaction(state)?.1, out),
        Quantity::Outputs => Probe::outputs(&mut solver.on(driven), state, out, &mut [])?,
        Quantity::Events => driven.events(state, out),
        Quantity::Energy => {
            let energy = driven.energy(state);
            let values = [
                energy.kinetic,
                energy.potential,
                energy.balance,
                energy.power,
            ];
            out.copy_from_slice(&values);
        }
        Quantity::Rank => {
            let rank = solver.on(driven).rank(state)?;
            out.copy_from_slice(&[rank.rank as f64, rank.regular as f64, rank.sine]);
        }
        Quantity::Slope | Quantity::OutputSlope | Quantity::EventSlope => {}
    }
    Ok(())
}

/// Writes a matrix row by row.
fn rows<const A: usize, const B: usize>(matrix: &SMatrix<f64, A, B>, out: &mut [f64]) {
    for (index, place) in out.iter_mut().enumerate().take(A * B) {
        *place = matrix[(index / B, index % B)];
    }
}
