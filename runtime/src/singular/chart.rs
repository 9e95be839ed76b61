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

use crate::dynamics::{CoordinateScale, Metric, Rows, Which};
use crate::equations::At;
use crate::linalg::{
    Cholesky, add_scaled, diagonal, dot, multiply_upper, multiply_upper_transposed, norm,
    order_by_first_row, pair, solve_upper_transposed,
};
use crate::tolerance::excusable;
use crate::{Real, State};
use nalgebra::{SMatrix, SVector};

/// A chart of the sheet on which the motion lives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chart<T, const N: usize, const R: usize> {
    /// `D`: orthonormal in the metric, in the first `freedoms` columns.
    tangent: SMatrix<T, N, N>,
    /// `M D`, in the same columns.
    pub(crate) dual: SMatrix<T, N, N>,
    pub(crate) freedoms: usize,
    /// The accepted state.
    base: State<T, N>,
    /// The velocity of the sheet where the coordinates of the chart rest.
    drift: SVector<T, N>,
    /// The largest length of that so far.
    pub(crate) speed: T,
    /// Constraint rows that are independent at regular states, `N − freedoms` of them.
    rows: [usize; R],
    /// The place of each row among these; their number for one that is not.
    places: [usize; R],
    /// The places of the columns in eliminations.
    column_places: [usize; N],
    /// That of the metric.
    factor: Cholesky<T, N>,
    /// What rows and columns are multiplied by to have size one.
    row_scale: [T; R],
    column_scale: [T; N],
    /// The lengths that round-off and differences of positions are measured by.
    coordinate_scale: CoordinateScale<T>,
    /// How large each of them is.
    sizes: [T; N],
    /// The spacing of the nodes that served last, as a change of the sine.
    pub(crate) spacing: T,
    /// Error of an interpolation, relative, that is accepted.
    accepted: T,
    /// No sheets cross at the critical configuration nearby: a gap keeps them apart.
    pub(crate) gap: bool,
}

impl<T: Real, const N: usize, const R: usize> Chart<T, N, R> {
    /// A chart at a state from vectors that span the tangent space there; `None` if they
    /// are dependent. The Jacobian may be that of any state.
    #[inline(never)]
    pub(crate) fn new(
        base: &State<T, N>,
        mut tangent: SMatrix<T, N, N>,
        freedoms: usize,
        metric: &Metric<T, N>,
        (rows, jacobian): (&Rows<T, R>, &SMatrix<T, R, N>),
        (coordinate_scale, sizes, accepted): (CoordinateScale<T>, &[T; N], T),
    ) -> Option<Self> {
        let (list, count) = rows.active(Which::All)?;
        if count + freedoms != N {
            return None;
        }
        let mut dual: SMatrix<T, N, N> = SMatrix::zeros();
        let factor = metric.factor.as_slice();
        let (columns, duals) = (tangent.as_mut_slice(), dual.as_mut_slice());
        if !orthonormalise(factor, &mut columns[..N * freedoms], duals, N) {
            return None;
        }
        let mut places = [count; R];
        for (place, row) in list[..count].iter().enumerate() {
            places[*row] = place;
        }
        let mut column_places = [0; N];
        order_by_first_row(
            jacobian.as_slice(),
            &list[..count],
            &mut column_places,
            &mut [0; N],
        );
        let mut column_scale = [T::zero(); N];
        for (scale, square) in column_scale.iter_mut().zip(diagonal(factor, N)) {
            *scale = T::one() / square.sqrt();
        }
        Some(Self {
            tangent,
            dual,
            freedoms,
            base: *base,
            drift: SVector::zeros(),
            speed: T::zero(),
            rows: list,
            places,
            column_places,
            factor: metric.factor,
            row_scale: *rows.scales().0,
            column_scale,
            coordinate_scale,
            sizes: *sizes,
            spacing: T::zero(),
            accepted: accepted.max((accepted * coordinate_scale.turns()).min(excusable())),
            gap: false,
        })
    }

    /// Takes note of how fast the sheet moves.
    pub(crate) fn set_drift(&mut self, drift: SVector<T, N>, speed: T) {
        self.drift = drift;
        self.speed = speed.max(self.view().length(drift.as_slice()));
    }

    /// The factor of its metric.
    pub(crate) fn factor(&self) -> &Cholesky<T, N> {
        &self.factor
    }

    /// The chart over slices.
    pub(crate) fn view(&self) -> ChartView<'_, T> {
        ChartView {
            tangent: &self.tangent.as_slice()[..N * self.freedoms],
            dual: &self.dual.as_slice()[..N * self.freedoms],
            freedoms: self.freedoms,
            base: self.base.at(),
            drift: self.drift.as_slice(),
            speed: self.speed,
            rows: &self.rows[..N - self.freedoms],
            places: &self.places,
            column_places: &self.column_places,
            factor: self.factor.as_slice(),
            row_scale: &self.row_scale,
            column_scale: &self.column_scale,
            coordinate_scale: self.coordinate_scale,
            sizes: &self.sizes,
            spacing: self.spacing,
            accepted: self.accepted,
            gap: self.gap,
        }
    }
}

/// Makes vectors of length `n` orthonormal in a metric `U Uᵀ`, one after the other, so that
/// the orientation of charts is carried along, and finds what they are times the metric;
/// `false` if they are dependent.
fn orthonormalise<T: Real>(factor: &[T], vectors: &mut [T], duals: &mut [T], n: usize) -> bool {
    let count = vectors.len() / n;
    for i in 0..count {
        let lifted = &mut duals[i * n..(i + 1) * n];
        multiply_upper_transposed(factor, &vectors[i * n..(i + 1) * n], lifted);
        // The second time takes the round-off of the first.
        for other in (0..i).chain(0..i) {
            let [lifted, other] = pair(duals, n, i, other);
            add_scaled(lifted, -dot(other, lifted), other);
        }
        let lifted = &mut duals[i * n..(i + 1) * n];
        let size = norm(lifted);
        // False for NaN, too.
        let enough = size > T::EPSILON;
        if !enough {
            return false;
        }
        for entry in lifted {
            *entry /= size;
        }
    }
    for (vector, lifted) in vectors.chunks_exact_mut(n).zip(duals.chunks_exact_mut(n)) {
        vector.copy_from_slice(lifted);
        solve_upper_transposed(factor, vector);
        multiply_upper(factor, lifted);
    }
    true
}

/// A chart over slices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChartView<'a, T> {
    pub(super) tangent: &'a [T],
    pub(super) dual: &'a [T],
    pub(super) freedoms: usize,
    pub(super) base: At<'a, T>,
    pub(super) drift: &'a [T],
    pub(super) speed: T,
    pub(super) rows: &'a [usize],
    pub(super) places: &'a [usize],
    pub(super) column_places: &'a [usize],
    pub(super) factor: &'a [T],
    pub(super) row_scale: &'a [T],
    pub(super) column_scale: &'a [T],
    pub(super) coordinate_scale: CoordinateScale<T>,
    pub(super) sizes: &'a [T],
    pub(super) spacing: T,
    pub(super) accepted: T,
    pub(super) gap: bool,
}

impl<T: Real> ChartView<'_, T> {
    /// How many coordinates there are.
    pub(super) fn n(&self) -> usize {
        self.column_scale.len()
    }

    /// The length of a vector in the diagonal of the metric.
    pub(crate) fn length(&self, x: &[T]) -> T {
        let (n, mut sum) = (x.len(), T::zero());
        let scales = &self.column_scale[..n];
        for i in 0..n {
            let x = x[i] / scales[i];
            sum += x * x;
        }
        sum.sqrt()
    }

    /// The length of what two vectors differ by.
    pub(super) fn apart(&self, a: &[T], b: &[T]) -> T {
        let (n, mut sum) = (a.len(), T::zero());
        let (b, scales) = (&b[..n], &self.column_scale[..n]);
        for i in 0..n {
            let x = (a[i] - b[i]) / scales[i];
            sum += x * x;
        }
        sum.sqrt()
    }

    /// `D* x`.
    pub(super) fn coordinates(&self, x: &[T], along: &mut [T]) {
        let duals = self.dual.chunks_exact(self.n());
        for (along, dual) in along.iter_mut().zip(duals) {
            *along = dot(dual, x);
        }
    }

    /// The columns of the tangent space.
    pub(super) fn tangents(&self) -> impl Iterator<Item = &[T]> {
        self.tangent.chunks_exact(self.n())
    }
}
