//! Derivatives at a state, by coordinates, velocities, states of the first order and inputs.
//!
//! In:  a mechanism that provides them: its linearised equations of motion, and how forces,
//!      outputs and events change.
//! Out: numbers, row by row; columns in the order `q`, `q̇` and states, `u`.
//!
//! Not here: differences. Where there are no derivatives, that is said.

use crate::Embedded;
use crate::engine::{Engine, Outcome};
use crate::evaluate::Quantity;
use crate::status::Status;
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{AccelerationJacobian, Differentiated, Partials, SimulateError, State};

/// Derivatives of accelerations, and by forces.
type Slopes<const N: usize> = (AccelerationJacobian<f64, N>, SMatrix<f64, N, N>);

impl<M, const N: usize, const R: usize> Engine<M, N, R>
where
    M: Embedded<N, R>,
{
    /// How many numbers a quantity is; none if it is a derivative that the mechanism lacks.
    pub fn size(&self, quantity: Quantity) -> usize {
        match quantity.is_slope() && !self.is_differentiated() {
            true => 0,
            false => quantity.size(self.structure(), N, R),
        }
    }

    /// Whether the mechanism provides derivatives.
    fn is_differentiated(&self) -> bool {
        let mut nothing = Partials {
            force_by_input: &mut [],
            outputs: &mut [],
            events: &mut [],
        };
        let (state, acceleration) = (State::default(), SVector::zeros());
        let mechanism = &self.driven.mechanism;
        mechanism.partials(&state, &acceleration, &mut nothing)
    }

    /// Refuses to differentiate a mechanism that can't be.
    pub(crate) fn expect_differentiated(&mut self) -> Outcome {
        match self.is_differentiated() {
            true => Ok(()),
            false => self.refuse(
                Status::Argument,
                &"this mechanism has no derivatives: the code for them would be too long",
            ),
        }
    }

    /// Writes derivatives at a state; the mechanism has them, and there is room.
    ///
    /// # Errors
    ///
    /// [`Status::Run`] if there are none at this state.
    pub(crate) fn slopes(
        &mut self,
        quantity: Quantity,
        state: &State<f64, N>,
        out: &mut [f64],
    ) -> Outcome {
        let mut system = self.inquiry.on(&self.driven);
        let (acceleration, slopes) = match system.acceleration(state) {
            Ok(acceleration) => (
                acceleration,
                system.acceleration_jacobian_and_compliance(state),
            ),
            Err(error) => return Err(self.fault(&SimulateError::Observe(error))),
        };
        self.partials.fill(0.0);
        let structure = self.driven.mechanism.structure();
        let inputs = structure.inputs.len();
        let width = 3 * N + inputs;
        let (force_by_input, rest) = self.partials.split_at_mut(N * inputs);
        let (outputs, events) = rest.split_at_mut(structure.outputs.len() * width);
        let mut parts = Partials {
            force_by_input,
            outputs,
            events,
        };
        self.driven.partials(state, &acceleration, &mut parts);
        let columns = Columns {
            freedoms: structure.freedoms().len(),
            inputs,
            force_by_input: parts.force_by_input,
        };
        let done = match quantity {
            Quantity::OutputSlope => columns.functions(parts.outputs, slopes.as_ref(), out),
            Quantity::EventSlope => columns.functions(parts.events, slopes.as_ref(), out),
            _ => columns.accelerations(slopes.as_ref(), out),
        };
        match done {
            Some(()) => Ok(()),
            None => {
                self.failed_at = Some(state.t);
                let reason = format_args!(
                    "at t = {} s accelerations have no derivatives: the constraints are \
                     singular there, or held by Baumgarte's method",
                    state.t
                );
                self.refuse(Status::Run, &reason)
            }
        }
    }
}

/// The columns of derivatives.
struct Columns<'a> {
    freedoms: usize,
    inputs: usize,
    /// `∂p₁/∂u`, row by row.
    force_by_input: &'a [f64],
}

impl Columns<'_> {
    /// The derivatives of the accelerations, if there are any.
    fn accelerations<const N: usize>(
        &self,
        slopes: Option<&Slopes<N>>,
        out: &mut [f64],
    ) -> Option<()> {
        let slopes = slopes?;
        let rows = out.chunks_exact_mut(self.freedoms + N + self.inputs);
        for (i, row) in rows.enumerate() {
            let one = SVector::from_fn(|j, _| if i == j { 1.0 } else { 0.0 });
            self.add(slopes, &one, row);
        }
        Some(())
    }

    /// The derivatives of functions of state, accelerations and inputs, if there are any.
    fn functions<const N: usize>(
        &self,
        parts: &[f64],
        slopes: Option<&Slopes<N>>,
        out: &mut [f64],
    ) -> Option<()> {
        let parts = parts.chunks_exact(3 * N + self.inputs);
        let rows = out.chunks_exact_mut(self.freedoms + N + self.inputs);
        for (part, row) in parts.zip(rows) {
            let (q, rest) = part.split_at(N);
            let (v, rest) = rest.split_at(N);
            let (a, u) = rest.split_at(N);
            let direct = q[..self.freedoms].iter().chain(v).chain(u);
            row.iter_mut()
                .zip(direct)
                .for_each(|(to, from)| *to = *from);
            if a.iter().any(|a| *a != 0.0) {
                self.add(slopes?, &SVector::from_fn(|i, _| a[i]), row);
            }
        }
        Some(())
    }

    /// Adds to a row what comes by way of the accelerations, each with its weight.
    fn add<const N: usize>(
        &self,
        (jacobian, compliance): &Slopes<N>,
        weights: &SVector<f64, N>,
        row: &mut [f64],
    ) {
        let (q, rest) = row.split_at_mut(self.freedoms);
        let (v, u) = rest.split_at_mut(N);
        for (j, entry) in q.iter_mut().enumerate() {
            *entry += weights.dot(&jacobian.q.column(j));
        }
        for (j, entry) in v.iter_mut().enumerate() {
            *entry += weights.dot(&jacobian.v.column(j));
        }
        let by_force = compliance.tr_mul(weights);
        for (j, entry) in u.iter_mut().enumerate() {
            let forces = (0..N).map(|k| by_force[k] * self.force_by_input[k * self.inputs + j]);
            *entry += forces.sum::<f64>();
        }
    }
}
