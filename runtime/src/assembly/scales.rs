//! What to measure coordinates and constraint equations by.
//!
//! In:  a mechanism, a guess.
//! Out: a scale for every coordinate and every equation.
//!
//! The rows of the Jacobian can't be measured at the position itself, because at
//! a singular one a whole row may vanish. They are measured there and at two
//! positions in the neighbourhood.

use crate::{ConstraintRow, Mechanism, Position, Quantity, Real, State};
use nalgebra::{SMatrix, SVector};

/// Units of coordinates that are angles, whose natural size is one. The others
/// are as large as the largest of them.
const ANGLES: [&str; 4] = ["", "1", "rad", "deg"];
/// How far away, in sizes of the coordinates, the rows are measured.
const NEIGHBOURHOOD: [f64; 3] = [0.0, 0.3, -0.2];

/// Held values that could reduce an error by this part of what the most
/// influential one could are named as conflicting.
const INFLUENCE: f64 = 1e-3;

/// Scales of coordinates and equations.
#[derive(Clone, Debug)]
pub(super) struct Scales<T, const N: usize, const R: usize> {
    /// `1/√M_ii`: what one unit of the scaled unknown is in units of the
    /// coordinate; one where there is no inertia.
    pub(super) columns: SVector<T, N>,
    /// What one unit of the equation is in units of the scaled equation: the
    /// norm of its row is about one in the kinetic metric.
    pub(super) rows: SVector<T, R>,
    /// How large each coordinate is, at least: 1 rad, or the largest length.
    pub(super) sizes: SVector<T, N>,
    /// How much each equation changes when the coordinates change by their sizes.
    pub(super) reach: SVector<T, R>,
}

impl<T: Real, const N: usize, const R: usize> Scales<T, N, R> {
    /// Measures the mechanism around a state; `at` is a buffer.
    pub(super) fn measure(
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        at: &mut Position<T, N, R>,
    ) -> Self {
        Self::measure_free(mechanism, state, &[false; N], at)
    }

    /// The same for the coordinates that are not held: rows are measured by what these can
    /// do. Of masses that are unlike each other, those that are held may be the lightest.
    #[inline(never)]
    pub(super) fn measure_free(
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        held: &[bool; N],
        at: &mut Position<T, N, R>,
    ) -> Self {
        let sizes = sizes(mechanism.structure().coordinates, &state.q);
        mechanism.position(state, at);
        let columns = SVector::from_fn(|i, _| {
            let inertia: T = at.mass[(i, i)];
            if held[i] {
                T::zero()
            } else if inertia > T::zero() {
                T::one() / inertia.sqrt()
            } else {
                T::one()
            }
        });
        let mut norms = SVector::<T, R>::zeros();
        let mut reach = norms;
        for distance in NEIGHBOURHOOD {
            let mut near = *state;
            near.q = disturbed(&state.q, &(sizes * T::from_f64(distance)));
            mechanism.position(&near, at);
            for k in 0..R {
                let row = |j: usize, scale: &SVector<T, N>| at.jacobian[(k, j)].abs() * scale[j];
                let square = (0..N).fold(T::zero(), |sum, j| {
                    let entry = row(j, &columns);
                    sum + entry * entry
                });
                let length = (0..N).fold(T::zero(), |sum, j| sum + row(j, &sizes));
                // A neighbour outside the domain of a root tells nothing.
                if square.is_finite() && length.is_finite() {
                    norms[k] = norms[k].max(square.sqrt());
                    reach[k] = reach[k].max(length);
                }
            }
        }
        let inverse = |x: T| {
            if x > T::zero() {
                T::one() / x
            } else {
                T::one()
            }
        };
        Self {
            columns,
            rows: norms.map(inverse),
            sizes,
            reach,
        }
    }

    /// Takes what is held out of the unknowns.
    pub(super) fn hold(&mut self, held: &[bool; N]) {
        for (column, held) in self.columns.iter_mut().zip(held) {
            if *held {
                *column = T::zero();
            }
        }
    }

    /// Leaves the velocity constraints out.
    pub(super) fn leave_out_velocities(&mut self, rows: &[ConstraintRow]) {
        for (scale, row) in self.rows.iter_mut().zip(rows) {
            if !row.holonomic {
                *scale = T::zero();
            }
        }
    }

    /// Which of the held values could reduce the error if they were free.
    pub(super) fn influential(
        &self,
        jacobian: &SMatrix<T, R, N>,
        residual: &SVector<T, R>,
        held: &[bool; N],
    ) -> [bool; N] {
        let influence: [T; N] = core::array::from_fn(|j| {
            let slope = (0..R).fold(T::zero(), |sum, k| {
                sum + self.rows[k] * self.rows[k] * jacobian[(k, j)] * residual[k]
            });
            if held[j] {
                (slope * self.columns[j]).abs()
            } else {
                T::zero()
            }
        });
        let most = influence.iter().fold(T::zero(), |most: T, x| most.max(*x));
        influence.map(|x| x > most * T::from_f64(INFLUENCE))
    }
}

/// How large each coordinate is, at least.
fn sizes<T: Real, const N: usize>(coordinates: &[Quantity], q: &SVector<T, N>) -> SVector<T, N> {
    let is_angle = |i: usize| {
        coordinates
            .get(i)
            .is_none_or(|quantity| ANGLES.contains(&quantity.unit))
    };
    let longest = (0..N)
        .filter(|i| !is_angle(*i))
        .fold(T::zero(), |most: T, i| most.max(q[i].abs()));
    SVector::from_fn(|i, _| {
        if is_angle(i) || longest == T::zero() {
            T::one()
        } else {
            longest
        }
    })
}

/// Every coordinate moved by an irregular part of a distance.
pub(super) fn disturbed<T: Real, const N: usize>(
    q: &SVector<T, N>,
    distance: &SVector<T, N>,
) -> SVector<T, N> {
    // Multiples of the golden ratio, modulo one, fill the interval evenly and
    // never repeat.
    let golden = 0.618_033_988_749_894_9;
    SVector::from_fn(|i, _| {
        let part = (golden * (i as f64 + 1.0)) % 1.0 + 0.5;
        q[i] + distance[i] * T::from_f64(part)
    })
}
