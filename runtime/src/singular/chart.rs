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
//!
//! Where the constraints have several connected components, the sheet is a product, and its
//! chart is made of those of its factors, each in its own block of `M`.

use super::part::{Part, parts};
use super::product::{Factor, Offsets, Product, STOPPED, length};
use crate::dynamics::{CoordinateScale, Rows};
use crate::linalg::{
    Cholesky, Workspace, add_scaled, dot, multiply_upper, multiply_upper_transposed, norm,
    order_by_first_row, pair, set_units, solve_upper_transposed,
};
use crate::tolerance::{excusable, resolved};
use crate::{ConnectedComponent, Real, State};
use nalgebra::{SMatrix, SVector};

/// A chart of the sheet on which the motion lives. Coordinates and rows are in the order of the
/// factors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chart<T, const N: usize, const R: usize> {
    components: &'static [ConnectedComponent],
    /// `D`: the columns of each factor one after the other, orthonormal in the metric.
    tangent: SMatrix<T, N, N>,
    /// `M D`: its columns in the same order.
    dual: SMatrix<T, N, N>,
    /// The triangular factors of the blocks of the metric.
    metric: SMatrix<T, N, N>,
    /// The accepted state.
    t: T,
    q: [T; N],
    /// The velocity of the sheet where the coordinates of the chart rest.
    drift: [T; N],
    /// The direction of that velocity, of length one in each factor, or the last direction that it
    /// had before it nearly vanished.
    heading: [T; N],
    /// How large the coordinates are.
    sizes: [T; N],
    /// What columns and rows are multiplied by to have size one.
    column_scale: [T; N],
    row_scale: [T; R],
    /// The places of the columns in eliminations.
    column_places: [usize; N],
    /// Constraint rows that are independent at regular states.
    rows: [usize; R],
    /// The place of each row among the independent ones; their number for a row that is none.
    places: [usize; R],
    factors: [Factor<T>; N],
    /// The lengths that round-off and differences of positions are measured by.
    coordinate_scale: CoordinateScale<T>,
    /// Error of an interpolation, relative, that is accepted.
    accepted: T,
}

impl<T: Real, const N: usize, const R: usize> Chart<T, N, R> {
    /// A chart at a state from vectors that span the tangent space there, those of each factor
    /// one after the other; `None` if they are dependent. Of constraint rows that are redundant,
    /// it takes those that are the most independent where the Jacobian was evaluated.
    #[inline(never)]
    pub(crate) fn new(
        base: &State<T, N>,
        tangent: SMatrix<T, N, N>,
        metric: &Cholesky<T, N>,
        (rows, jacobian): (&Rows<T, R>, &SMatrix<T, R, N>),
        (coordinate_scale, sizes, accepted): (CoordinateScale<T>, &[T; N], T),
        components: &'static [ConnectedComponent],
        workspace: &Workspace<'_, T>,
    ) -> Option<Self> {
        let (factor, jacobian) = (metric.as_slice(), jacobian.as_slice());
        let (list, count) = rows.most_independent(factor, jacobian, workspace)?;
        let list = &list[..count];
        let zero = T::zero();
        let excused = (accepted * coordinate_scale.turns()).min(excusable());
        let mut chart = Self {
            components,
            tangent,
            dual: SMatrix::zeros(),
            metric: SMatrix::zeros(),
            t: base.t,
            q: [zero; N],
            drift: [zero; N],
            heading: [zero; N],
            sizes: [zero; N],
            column_scale: [zero; N],
            row_scale: [zero; R],
            column_places: [0; N],
            rows: [0; R],
            places: [0; R],
            factors: [Factor::new(); N],
            coordinate_scale,
            accepted: accepted.max(excused),
        };
        let mut at = Offsets::default();
        for (index, part) in parts(components, (N, R)).enumerate() {
            let freedoms = chart.choose_rows(part, at, list)?;
            chart.factors[index].freedoms = freedoms;
            let coordinates = at.coordinates..at.coordinates + part.n;
            part.take(base.q.as_slice(), &mut chart.q[coordinates.clone()]);
            part.take(sizes, &mut chart.sizes[coordinates.clone()]);
            part.take_rows(&rows.scale, &mut chart.row_scale[at.rows..][..part.r]);
            let chosen = &chart.rows[at.chosen..][..part.n - freedoms];
            let column_places = &mut chart.column_places[coordinates.clone()];
            order_columns(part, jacobian, chosen, column_places, workspace);
            let squares = at.squares..at.squares + part.n * part.n;
            let block = &mut chart.metric.as_mut_slice()[squares];
            // The metric has no entries between parts, and neither has its triangular factor.
            part.take_block(factor, block);
            set_units(block, &mut chart.column_scale[coordinates]);
            let columns = at.tangents..at.tangents + part.n * freedoms;
            let tangent = &mut chart.tangent.as_mut_slice()[columns.clone()];
            let dual = &mut chart.dual.as_mut_slice()[columns];
            if !orthonormalise(block, tangent, dual, part.n) {
                return None;
            }
            at = at.after(part, freedoms);
        }
        Some(chart)
    }

    /// Takes the rows of a part among those that are independent at regular states; how many
    /// directions they leave free, `None` if they are too many.
    fn choose_rows(&mut self, part: Part, at: Offsets, independent: &[usize]) -> Option<usize> {
        let mut count = 0;
        for row in independent {
            if let Some(place) = part.place_of_row(*row) {
                self.rows[at.chosen + count] = place;
                count += 1;
            }
        }
        let freedoms = part.n.checked_sub(count)?;
        let places = &mut self.places[at.rows..][..part.r];
        places.fill(count);
        for (place, row) in self.rows[at.chosen..][..count].iter().enumerate() {
            places[*row] = place;
        }
        Some(freedoms)
    }

    /// Takes note of how fast the sheet moves, and of how fast and in which direction it moved
    /// before. Rows that are turned or scaled by a law of time move nothing, but for round-off
    /// beside the velocity `v`.
    pub(crate) fn set_drift(
        &mut self,
        drift: &SVector<T, N>,
        v: &SVector<T, N>,
        before: Option<&Self>,
    ) {
        let mut at = 0;
        for (index, part) in parts(self.components, (N, R)).enumerate() {
            let coordinates = at..at + part.n;
            let own = &mut self.drift[coordinates.clone()];
            let scales = &self.column_scale[coordinates.clone()];
            part.take(v.as_slice(), own);
            let round_off = length(own, scales) * resolved();
            part.take(drift.as_slice(), own);
            let mut speed = length(own, scales);
            if speed <= round_off {
                own.fill(T::zero());
                speed = T::zero();
            }
            let known = before.map_or(T::zero(), |before| before.factors[index].speed);
            self.factors[index].speed = known.max(speed);
            let heading = &mut self.heading[coordinates.clone()];
            match before.filter(|_| speed <= known * T::from_f64(STOPPED)) {
                Some(before) => heading.copy_from_slice(&before.heading[coordinates]),
                None if speed > T::zero() => {
                    for (heading, drift) in heading.iter_mut().zip(own) {
                        *heading = *drift / speed;
                    }
                }
                None => {}
            }
            at += part.n;
        }
    }

    /// What is left of a velocity where the coordinates of the chart rest.
    pub(crate) fn across(&self, v: &SVector<T, N>) -> SVector<T, N> {
        let [mut tangents, mut duals] = [SMatrix::<T, N, N>::zeros(); 2];
        let view = self.view();
        view.spread(view.tangents(), tangents.as_mut_slice());
        view.spread(view.dual, duals.as_mut_slice());
        let mut across = *v;
        for (tangent, dual) in tangents.column_iter().zip(duals.column_iter()) {
            across -= tangent * dual.dot(v);
        }
        across
    }

    /// What is known of the factors of the chart.
    pub(crate) fn factors(&self) -> &[Factor<T>; N] {
        &self.factors
    }

    /// What is known of the factors of the chart, to be changed.
    pub(crate) fn factors_mut(&mut self) -> &mut [Factor<T>; N] {
        &mut self.factors
    }

    /// The chart over slices.
    pub(crate) fn view(&self) -> Product<'_, T> {
        Product {
            components: self.components,
            tangent: self.tangent.as_slice(),
            dual: self.dual.as_slice(),
            metric: self.metric.as_slice(),
            t: self.t,
            q: &self.q,
            drift: &self.drift,
            heading: &self.heading,
            sizes: &self.sizes,
            column_scale: &self.column_scale,
            row_scale: &self.row_scale,
            column_places: &self.column_places,
            rows: &self.rows,
            places: &self.places,
            factors: &self.factors,
            coordinate_scale: self.coordinate_scale,
            accepted: self.accepted,
        }
    }
}

/// Places of columns in which rows have their entries close to one another.
fn order_columns<T: Real>(
    part: Part,
    jacobian: &[T],
    rows: &[usize],
    places: &mut [usize],
    workspace: &Workspace<'_, T>,
) {
    workspace.scope(|workspace| {
        let own = workspace.any(part.n * part.r);
        part.take_jacobian(jacobian, own);
        order_by_first_row(own, rows, places, workspace.indices(part.n));
    });
}

/// Makes vectors of length `n` orthonormal in a metric `U Uᵀ`, one after the other, so that
/// the orientation of charts is carried along, and finds what they are times the metric;
/// `false` if they are dependent.
fn orthonormalise<T: Real>(factor: &[T], vectors: &mut [T], duals: &mut [T], n: usize) -> bool {
    let count = vectors.len() / n;
    for i in 0..count {
        let lifted = &mut duals[i * n..(i + 1) * n];
        multiply_upper_transposed(factor, &vectors[i * n..(i + 1) * n], lifted);
        // The second pass removes the round-off of the first.
        for other in (0..i).chain(0..i) {
            let [lifted, other] = pair(duals, n, i, other);
            add_scaled(lifted, -dot(other, lifted), other);
        }
        let lifted = &mut duals[i * n..(i + 1) * n];
        let size = norm(lifted);
        // A comparison with NaN is false, so that a vector that is NaN counts as dependent.
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
