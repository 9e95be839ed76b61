//! What to measure coordinates and constraint equations by.
//!
//! In:  a mechanism, a guess.
//! Out: a scale for every coordinate and every equation.
//!
//! The rows of the Jacobian can't be measured at the position itself, because at
//! a singular one a whole row may vanish. They are measured there and at two
//! positions in the neighbourhood.

use crate::equations::Equations;
use crate::extremum::{VANISHING, is_near_extremum};
use crate::linalg::Workspace;
use crate::natural_size::{LeastInertia, NaturalSizes};
use crate::{ConstraintRow, Real, Structure};

/// How far away, in sizes of the coordinates, the rows are measured.
const NEIGHBOURHOOD: [f64; 3] = [0.0, 0.3, -0.2];

/// Held values that could reduce an error by this part of what the most
/// influential one could are named as conflicting.
const INFLUENCE: f64 = 1e-3;

/// Errors of positions and velocities up to this multiple of the round-off of an equation's
/// terms are no contradiction. The iteration for positions does not stop here: it ends where
/// nothing improves.
pub(super) const CONTRADICTION: f64 = 4096.0;

/// Scales of coordinates and equations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales<'a, T> {
    /// `1/√M_ii`: what one unit of the scaled unknown is in units of the
    /// coordinate; where there is hardly any inertia, as if there were a little.
    pub(super) columns: &'a [T],
    /// What one unit of the equation is in units of the scaled equation: the
    /// norm of its row is about one in the kinetic metric.
    pub(super) rows: &'a [T],
    /// How large each coordinate is, at least: 1 rad, or the largest of its kind.
    pub(super) sizes: &'a [T],
    /// How much each equation changes when the coordinates change by their sizes, or by their
    /// values where these are larger: its round-off is relative to that.
    pub(super) reach: &'a [T],
}

/// Gives a row that is small at a position because the coordinates are large, and not since it is
/// near a singular configuration, the norm and the reach that it has `here`.
fn keep_near_extrema<T: Real>(
    (norms, reach): (&mut [T], &mut [T]),
    here: &[T],
    equations: &mut dyn Equations<T>,
    place: (T, &[T]),
    workspace: &Workspace<'_, T>,
) {
    let n_rows = norms.len();
    for k in 0..n_rows {
        let is_small = here[k] > T::zero() && here[k] < norms[k] * T::from_f64(VANISHING);
        if is_small && workspace.scope(|inner| is_near_extremum(equations, place, k, inner)) {
            (norms[k], reach[k]) = (here[k], here[n_rows + k]);
        }
    }
}

impl<'a, T: Real> Scales<'a, T> {
    /// Measures the mechanism around a position, by the coordinates that are not held, if
    /// there are any: where masses are very different, the held ones may be the lightest, and
    /// would decide the scale.
    pub(super) fn measure(
        equations: &mut dyn Equations<T>,
        (t, q): (T, &[T]),
        held: Option<&[bool]>,
        workspace: &Workspace<'a, T>,
    ) -> Self {
        let n = q.len();
        let (sizes, columns) = (workspace.numbers(n), workspace.numbers(n));
        let structure = equations.structure();
        NaturalSizes::write_all(structure, q, sizes);
        equations.locate(t, q);
        let at = equations.constraints();
        let n_rows = at.residual.len();
        measure_inertia(at.mass, structure, columns);
        for (column, held) in columns.iter_mut().zip(held.unwrap_or_default()) {
            if *held {
                *column = T::zero();
            }
        }
        let (norms, reach) = (workspace.numbers(n_rows), workspace.numbers(n_rows));
        let near = workspace.numbers(n);
        let here = workspace.numbers(2 * n_rows);
        for distance in NEIGHBOURHOOD {
            disturb(q, |i| sizes[i] * T::from_f64(distance), near);
            equations.locate(t, near);
            let jacobian = equations.constraints().jacobian;
            for k in 0..n_rows {
                let (mut square, mut length) = (T::zero(), T::zero());
                for (j, entry) in jacobian.iter().skip(k).step_by(n_rows).enumerate() {
                    let scaled = entry.abs() * columns[j];
                    square += scaled * scaled;
                    length += entry.abs() * sizes[j].max(q[j].abs());
                }
                // A neighbour outside the domain of a root tells nothing.
                if square.is_finite() && length.is_finite() {
                    norms[k] = norms[k].max(square.sqrt());
                    reach[k] = reach[k].max(length);
                }
            }
            if distance == 0.0 {
                here[..n_rows].copy_from_slice(norms);
                here[n_rows..].copy_from_slice(reach);
            }
        }
        keep_near_extrema((norms, reach), here, equations, (t, q), workspace);
        for norm in norms.iter_mut() {
            *norm = inverse(*norm);
        }
        Self {
            columns,
            rows: norms,
            sizes,
            reach,
        }
    }

    /// These scales with what is held taken out of the unknowns.
    pub(super) fn hold(self, held: &[bool], workspace: &Workspace<'a, T>) -> Self {
        let columns = workspace.numbers(held.len());
        for (j, column) in columns.iter_mut().enumerate().filter(|(j, _)| !held[*j]) {
            *column = self.columns[j];
        }
        Self { columns, ..self }
    }

    /// These scales with the velocity constraints taken out of the rows.
    pub(super) fn leave_out_velocities(
        self,
        constraints: &[ConstraintRow],
        workspace: &Workspace<'a, T>,
    ) -> Self {
        let rows = workspace.numbers(self.rows.len());
        rows.copy_from_slice(self.rows);
        for (scale, row) in rows.iter_mut().zip(constraints) {
            if !row.holonomic {
                *scale = T::zero();
            }
        }
        Self { rows, ..self }
    }

    /// Which of the held values could reduce the error if they were free.
    pub(super) fn influential(
        &self,
        jacobian: &[T],
        residual: &[T],
        held: &[bool],
        conflicting: &mut [bool],
    ) {
        let influence = |j: usize| {
            let entries = jacobian.iter().skip(j * residual.len());
            let rows = self.rows.iter().zip(residual);
            let slope = rows
                .zip(entries)
                .fold(T::zero(), |sum, ((row, error), entry)| {
                    sum + *row * *row * *entry * *error
                });
            match held[j] {
                true => (slope * self.columns[j]).abs(),
                false => T::zero(),
            }
        };
        let most = (0..held.len()).fold(T::zero(), |most: T, j| most.max(influence(j)));
        for (j, conflicting) in conflicting.iter_mut().enumerate() {
            *conflicting = influence(j) > most * T::from_f64(INFLUENCE);
        }
    }
}

/// What coordinates are divided by to have an inertia of one; those that are nearly massless
/// have a part of the largest of their kind.
fn measure_inertia<T: Real>(mass: &[T], structure: &Structure, columns: &mut [T]) {
    let least = LeastInertia::measure(structure, mass, columns.len());
    let inertia = mass.iter().step_by(columns.len() + 1);
    for (i, (column, inertia)) in columns.iter_mut().zip(inertia).enumerate() {
        *column = inverse(inertia.max(least.of(structure, i)).sqrt());
    }
}

/// `1/x`; one where there is nothing to divide by.
fn inverse<T: Real>(x: T) -> T {
    match x > T::zero() {
        true => T::one() / x,
        false => T::one(),
    }
}

/// Every coordinate moved by an irregular part of a distance.
pub(super) fn disturb<T: Real>(q: &[T], distance: impl Fn(usize) -> T, disturbed: &mut [T]) {
    // Multiples of the golden ratio, modulo one, fill the interval evenly and
    // never repeat.
    let golden = 0.618_033_988_749_894_9;
    for (i, (target, q)) in disturbed.iter_mut().zip(q).enumerate() {
        let part = (golden * (i as f64 + 1.0)) % 1.0 + 0.5;
        *target = *q + distance(i) * T::from_f64(part);
    }
}
