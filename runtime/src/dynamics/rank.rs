//! How many constraint equations are independent.
//!
//! In:  the constraint Jacobian at positions on the constraints.
//! Out: its rank at regular configurations, an independent subset of its rows, its
//!      singular values; the null-space form by a rank decision alone.

use super::{Core, Source, Which};
use crate::linalg::{
    Breakdown, Products, add_scaled, count_above, dot, eigen, norm, orthogonalise, orthonormal,
    remove, scaled,
};
use crate::tolerance::{difference, negligible, regular};
use crate::{DynamicsError, Mechanism, Real, Singularity, State};
use nalgebra::{SMatrix, SVector};

/// Part of a displacement that the singular value of a row is, at least, whose gradient
/// is lost only where the displacement begins.
const RETURNS: f64 = 1e-2;
/// Newton's corrections that bring a neighbour onto the constraints. Where their gradient
/// vanishes wherever they hold, each halves the distance, and the gradient with it.
const CORRECTIONS: usize = 16;

/// Second derivatives below this part of the largest count as zero.
const FLAT: f64 = 1e-3;
/// How far, relative to the coordinates, the neighbours lie that tell whether constraints
/// that touch zero go through it.
const ASIDE: f64 = 1e-2;

/// Rows in the metric, combined until they are orthogonal.
pub(crate) struct Combined<T, const N: usize, const R: usize> {
    /// The directions that the combinations decide, of length one, largest first.
    pub(crate) directions: SMatrix<T, N, R>,
    /// The combinations, as columns.
    pub(crate) left: SMatrix<T, R, R>,
    /// Singular values.
    pub(crate) values: [T; R],
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The rows of a Jacobian in the metric at hand, scaled to size one.
    #[inline(never)]
    fn lift_rows(&self, source: Source, which: Which) -> SMatrix<T, N, R> {
        let jacobian = match source {
            Source::Terms => &self.terms.jacobian,
            Source::Position => &self.position.jacobian,
        };
        let mut rows: SMatrix<T, N, R> = SMatrix::zeros();
        for (row, column) in rows.data.0.iter_mut().enumerate() {
            if self.rows.takes_part(row, which) {
                let vector = self.metric.lift(jacobian, row);
                *column = scaled(self.rows.scale(row), &vector);
            }
        }
        rows
    }

    /// Combines the rows of a Jacobian in the metric at hand.
    #[inline(never)]
    pub(crate) fn combine(
        &mut self,
        source: Source,
        which: Which,
        t: T,
    ) -> Result<Combined<T, N, R>, DynamicsError<T>> {
        self.counters.rank_decisions += 1;
        let mut directions = self.lift_rows(source, which);
        let mut left: SMatrix<T, R, R> = SMatrix::identity();
        orthogonalise(&mut directions.data.0, &mut left.data.0)
            .map_err(|Breakdown| DynamicsError::NotFinite { t })?;
        let mut values = [T::zero(); R];
        for (value, column) in values.iter_mut().zip(&mut directions.data.0) {
            *value = norm(column);
            if *value > T::zero() {
                *column = scaled(T::one() / *value, column);
            }
        }
        Ok(Combined {
            directions,
            left,
            values,
        })
    }

    /// Learns the rank at regular configurations from a state on the constraints whose
    /// position terms are in the buffer and factorised, and chooses independent rows.
    ///
    /// Where the state itself may be singular, its neighbours tell: along the velocity, or
    /// in the directions that its constraints leave free.
    #[inline(never)]
    pub(crate) fn learn_rank(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.rows.are_independent_by_form() || self.is_safely_regular() {
            for which in [Which::Holonomic, Which::All] {
                self.rows.observe_rank(self.rows.count(which), which);
            }
            return Ok(());
        }
        let mut regular_at = state.q;
        for which in [Which::Holonomic, Which::All] {
            let (rank, q) = self.rank_nearby(mechanism, state, which)?;
            self.rows.observe_rank(rank, which);
            regular_at = q;
        }
        let moved = State {
            q: regular_at,
            ..*state
        };
        mechanism.position(&moved, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        self.choose_rows();
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)
    }

    /// Whether all rows are safely independent at the position in the buffer. It takes one
    /// factorisation of the products of the rows, which have few entries in large
    /// mechanisms, where singular values take many sweeps over all columns.
    #[inline(never)]
    fn is_safely_regular(&self) -> bool {
        let rows = self.lift_rows(Source::Position, Which::All);
        let mut products = Products::<T, R>::default();
        let judged = products.compute(N, |j, entries| {
            for (row, entry) in entries.iter_mut().enumerate() {
                *entry = rows[(j, row)];
            }
        });
        judged.is_ok() && (0..R).all(|row| products.is_safe(row))
    }

    /// The rank at a state, or next to it if it is higher there, and where.
    #[inline(never)]
    fn rank_nearby(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        which: Which,
    ) -> Result<(usize, SVector<T, N>), DynamicsError<T>> {
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let (rank_here, combined) = self.rank_here(which, regular(), state.t)?;
        if rank_here == self.rows.count(which) {
            return Ok((rank_here, state.q));
        }
        let vanishing = self.vanishing_row(which);
        let mut lost = None;
        let ahead = self.ahead(state);
        let around = self.neighbours(state, &combined);
        for q in core::iter::once(ahead).chain(around).flatten() {
            let moved = State { q, ..*state };
            mechanism.position(&moved, &mut self.position);
            self.factorise_metric(mechanism, Source::Position, state.t)?;
            let least = difference::<T>() * T::from_f64(RETURNS);
            let (rank, _) = self.rank_here(which, least, state.t)?;
            if rank <= rank_here {
                continue;
            }
            if vanishing.is_none() || self.stays(mechanism, moved, which, (rank, least))? {
                return Ok((rank, q));
            }
            lost = lost.or(vanishing.map(|row| (row, (rank, q))));
        }
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        match lost {
            Some((row, _)) if self.is_square(mechanism, state, &combined, rank_here) => {
                Err(DynamicsError::SingularConfiguration {
                    t: state.t,
                    kind: Singularity::Vanishing,
                    row,
                    structure: mechanism.structure(),
                })
            }
            Some((_, elsewhere)) => Ok(elsewhere),
            None => Ok((rank_here, state.q)),
        }
    }

    /// Whether the combination of rows that loses its gradient at a state is like a square
    /// that vanishes along a line, or a sum of squares that vanishes at a point: its second
    /// derivatives have one sign but for directions along which it is flat, and there it
    /// does not become negative.
    #[inline(never)]
    fn is_square(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        combined: &Combined<T, N, R>,
        rank: usize,
    ) -> bool {
        let count = N - rank;
        let strong = &combined.directions.data.0[..rank];
        let kernel = orthonormal(count, |axis| remove(axis, strong));
        let second = self.second_derivatives(mechanism, state, combined, &kernel, count);
        let (values, vectors) = eigen(second, count);
        let most = (0..count).fold(T::zero(), |most: T, k| most.max(values[k].abs()));
        let flat = |k: &usize| values[*k].abs() <= most * T::from_f64(FLAT);
        let mut steep = (0..count).filter(|k| !flat(k)).map(|k| values[k].sign());
        let Some(sign) = steep
            .next()
            .filter(|first| steep.all(|other| other == *first))
        else {
            return false;
        };
        let value_at = |solver: &mut Self, q: SVector<T, N>| {
            mechanism.position(&State { q, ..*state }, &mut solver.position);
            let right = solver.scaled(&solver.position.residual);
            dot(&combined.left.data.0[rank], &right) * sign
        };
        for k in (0..count).filter(flat) {
            let mut along = [T::zero(); N];
            for (share, axis) in vectors[k].iter().zip(&kernel.data.0[..count]) {
                add_scaled(&mut along, *share, axis);
            }
            let moved = self.lower(along) * (self.reach * T::from_f64(ASIDE));
            for q in [state.q + moved, state.q - moved] {
                if value_at(self, q) < -T::EPSILON * self.reach {
                    return false;
                }
            }
        }
        true
    }

    /// Whether a rank next to a state is still there where the constraints hold.
    #[inline(never)]
    fn stays(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        mut state: State<T, N>,
        which: Which,
        (wanted, least): (usize, T),
    ) -> Result<bool, DynamicsError<T>> {
        for _ in 0..CORRECTIONS {
            mechanism.position(&state, &mut self.position);
            self.factorise_metric(mechanism, Source::Position, state.t)?;
            let (rank, combined) = self.rank_here(which, least, state.t)?;
            if rank < wanted {
                return Ok(false);
            }
            let right = self.scaled(&-self.position.residual);
            let mut w = [T::zero(); N];
            for (k, value) in combined.values.iter().enumerate().take(rank) {
                let share = dot(&combined.left.data.0[k], &right) / *value;
                add_scaled(&mut w, share, &combined.directions.data.0[k]);
            }
            state.q += self.lower(w);
        }
        Ok(true)
    }

    /// A row whose gradient vanishes at the position in the buffer, if there is one.
    #[inline(never)]
    fn vanishing_row(&self, which: Which) -> Option<usize> {
        let rows = self.lift_rows(Source::Position, which);
        let vanishes = |row: &usize| norm(&rows.data.0[*row]) <= regular();
        (0..R).find(|row| self.rows.takes_part(*row, which) && vanishes(row))
    }

    /// How many singular values are above a bound at the position in the buffer.
    fn rank_here(
        &mut self,
        which: Which,
        least: T,
        t: T,
    ) -> Result<(usize, Combined<T, N, R>), DynamicsError<T>> {
        let combined = self.combine(Source::Position, which, t)?;
        Ok((count_above(&combined.values, least), combined))
    }

    /// The position next to a state along its velocity, if it moves.
    fn ahead(&self, state: &State<T, N>) -> Option<SVector<T, N>> {
        let speed = self.metric.factor.length(&state.v.data.0[0]);
        let distance = difference::<T>() * self.reach;
        (speed > T::zero()).then(|| state.q + state.v * (distance / speed))
    }

    /// Positions next to a state, wherever the constraints let it go.
    #[inline(never)]
    fn neighbours(
        &self,
        state: &State<T, N>,
        combined: &Combined<T, N, R>,
    ) -> [Option<SVector<T, N>>; N] {
        let distance = difference::<T>() * self.reach;
        let mut neighbours = [None; N];
        for (j, neighbour) in neighbours.iter_mut().enumerate() {
            let mut axis = [T::zero(); N];
            axis[j] = T::one();
            for (direction, value) in combined.directions.data.0.iter().zip(&combined.values) {
                if *value > regular() {
                    let share = dot(direction, &axis);
                    add_scaled(&mut axis, -share, direction);
                }
            }
            let size = norm(&axis);
            if size > regular() {
                let moved = self.lower(scaled(distance / size, &axis));
                *neighbour = Some(state.q + moved);
            }
        }
        neighbours
    }

    /// Chooses an independent subset of the rows at the position in the buffer.
    #[inline(never)]
    pub(crate) fn choose_rows(&mut self) {
        if self.rows.regular(Which::All) < R {
            self.counters.row_choices += 1;
            let rows = self.lift_rows(Source::Position, Which::All);
            self.rows.choose(rows);
        }
    }

    /// The acceleration by the null space of the rows that are not zero to round-off: the
    /// form as it was published. Source: Phong & Hoang (2012), section 3.
    #[inline(never)]
    pub(super) fn published(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        self.prepare(mechanism, state)?;
        mechanism.terms(state, &mut self.terms);
        let bias = self.stabilised_bias(mechanism, state);
        self.safe = None;
        self.factorise_metric(mechanism, Source::Terms, state.t)?;
        let combined = self.combine(Source::Terms, Which::All, state.t)?;
        let right = self.scaled(&bias);
        let mut w = self.free_acceleration(&bias);
        let limit = self.rows.regular(Which::All);
        for (k, value) in combined.values.iter().enumerate().take(limit) {
            if *value > negligible() {
                let direction = &combined.directions.data.0[k];
                let wanted = dot(&combined.left.data.0[k], &right) / *value;
                let share = wanted - dot(direction, &w);
                add_scaled(&mut w, share, direction);
            }
        }
        Ok(self.lower(w))
    }
}
