//! Coordinates of a sheet of the constraint set near an accepted state.
//!
//! In:  the tangent space there, and the metric of the kinetic energy.
//! Out: [`Chart`]: how far a vector goes along the tangent space, and in which complement
//!      of it a state may be moved onto the sheet.
//!
//! The sheet is the graph of a function from the tangent space `D` to its complement
//! `N`, `[D N]` orthonormal in the mass matrix `M` of the accepted state. `D* = DᵀM`
//! measures how far a vector goes along `D`, and vanishes on `N`. A chart belongs to one
//! step: it changes at accepted states only.

use crate::dynamics::{Metric, Rows, Which};
use crate::linalg::{Cholesky, add_scaled, column, dot, norm, scaled};
use crate::{Real, State};
use nalgebra::{SMatrix, SVector};

/// A chart of the sheet on which the motion lives.
#[derive(Clone, Debug)]
pub(crate) struct Chart<T, const N: usize, const R: usize> {
    /// `D`: orthonormal in the metric, in the first `freedoms` columns.
    pub(crate) tangent: SMatrix<T, N, N>,
    /// `M D`, in the same columns.
    pub(crate) dual: SMatrix<T, N, N>,
    pub(crate) freedoms: usize,
    /// The accepted state.
    pub(crate) base: State<T, N>,
    /// The velocity of the sheet where the coordinates of the chart rest.
    pub(crate) drift: SVector<T, N>,
    /// The largest length of that so far.
    pub(crate) speed: T,
    /// Constraint rows that are independent at regular states, `N − freedoms` of them.
    pub(crate) rows: [usize; R],
    /// That of the metric.
    pub(crate) factor: Cholesky<T, N>,
    /// What rows and columns are multiplied by to have size one.
    pub(crate) row_scale: [T; R],
    pub(crate) column_scale: [T; N],
    /// The length of the coordinates in the metric.
    pub(crate) reach: T,
    /// How large each of them is.
    pub(crate) sizes: [T; N],
    /// The spacing of the nodes that served last, as a change of the sine.
    pub(crate) spacing: T,
    /// Error of an interpolation, relative, that is accepted.
    pub(crate) accepted: T,
    /// No sheets cross at the critical configuration nearby: a gap keeps them apart.
    pub(crate) gap: bool,
}

impl<T: Real, const N: usize, const R: usize> Chart<T, N, R> {
    /// A chart at a state from vectors that span the tangent space there; `None` if they
    /// are dependent. Vectors are made orthonormal one after the other, so that the
    /// orientation of charts is carried along.
    #[inline(never)]
    pub(crate) fn new(
        base: &State<T, N>,
        mut tangent: SMatrix<T, N, N>,
        freedoms: usize,
        metric: &Metric<T, N>,
        rows: &Rows<T, R>,
        (reach, sizes, accepted): (T, &[T; N], T),
    ) -> Option<Self> {
        let mut dual = SMatrix::zeros();
        for i in 0..freedoms {
            let mut lifted = metric.factor.transposed_product(&tangent.data.0[i]);
            // The second time takes the round-off of the first.
            for _ in 0..2 {
                let (done, _) = tangent.data.0.split_at(i);
                for other in done {
                    let other = metric.factor.transposed_product(other);
                    let share = dot(&other, &lifted);
                    add_scaled(&mut lifted, -share, &other);
                }
            }
            let size = norm(&lifted);
            // False for NaN, too.
            let enough = size > T::EPSILON;
            if !enough {
                return None;
            }
            let mut column = scaled(T::one() / size, &lifted);
            dual.data.0[i] = metric.factor.product(&column);
            metric.factor.backward(&mut column);
            tangent.data.0[i] = column;
        }
        let (list, count) = rows.active(Which::All)?;
        if count + freedoms != N {
            return None;
        }
        Some(Self {
            tangent,
            dual,
            freedoms,
            base: *base,
            drift: SVector::zeros(),
            speed: T::zero(),
            rows: list,
            factor: metric.factor.clone(),
            row_scale: column(|row| rows.scale(row)),
            column_scale: column(|j| T::one() / metric.factor.diagonal(j).sqrt()),
            reach,
            sizes: *sizes,
            spacing: T::zero(),
            accepted,
            gap: false,
        })
    }

    /// Takes note of how fast the sheet moves.
    pub(crate) fn set_drift(&mut self, drift: SVector<T, N>, speed: T) {
        self.drift = drift;
        self.speed = speed.max(self.length(&drift));
    }
}
