//! A chart of a product of sheets, over slices.
//!
//! In:  a [`Chart`](super::Chart).
//! Out: [`Product`], and of each of its factors a [`ChartView`].

use super::part::{Part, Place, parts};
use crate::dynamics::CoordinateScale;
use crate::linalg::{Workspace, dot, solve_in_subspace};
use crate::once::compiled_once;
use crate::{ConnectedComponent, Real};

/// Speed of a sheet, relative to the largest so far, below which its direction has too few
/// digits.
pub(super) const STOPPED: f64 = 1e-3;

/// What a chart knows of one factor of the product.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor<T> {
    pub(super) freedoms: usize,
    /// The largest velocity of the sheet where the coordinates of the chart rest, so far.
    pub(crate) speed: T,
    /// The spacing of the nodes that served last, as a change of the sine.
    pub(crate) spacing: T,
    /// No sheets cross at the critical configuration nearby: a gap keeps them apart.
    pub(crate) gap: bool,
}

/// Where the entries of a factor begin in lists of all factors.
#[derive(Clone, Copy, Default)]
pub(super) struct Offsets {
    pub(super) coordinates: usize,
    pub(super) rows: usize,
    /// The place of its first row among the independent rows.
    pub(super) chosen: usize,
    pub(super) tangents: usize,
    pub(super) squares: usize,
}

impl Offsets {
    /// Where the entries of the next factor begin.
    pub(super) fn after(&self, part: Part, freedoms: usize) -> Self {
        Self {
            coordinates: self.coordinates + part.n,
            rows: self.rows + part.r,
            chosen: self.chosen + part.n - freedoms,
            tangents: self.tangents + part.n * freedoms,
            squares: self.squares + part.n * part.n,
        }
    }
}

impl<T: Real> Factor<T> {
    pub(super) fn new() -> Self {
        Self {
            freedoms: 0,
            speed: T::zero(),
            spacing: T::zero(),
            gap: false,
        }
    }
}

/// A chart over slices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Product<'a, T> {
    pub(super) components: &'static [ConnectedComponent],
    pub(super) tangent: &'a [T],
    pub(crate) dual: &'a [T],
    pub(super) metric: &'a [T],
    pub(super) t: T,
    pub(super) q: &'a [T],
    pub(super) drift: &'a [T],
    pub(super) heading: &'a [T],
    pub(super) sizes: &'a [T],
    pub(super) column_scale: &'a [T],
    pub(super) row_scale: &'a [T],
    pub(super) column_places: &'a [usize],
    pub(super) rows: &'a [usize],
    pub(super) places: &'a [usize],
    pub(super) factors: &'a [Factor<T>],
    pub(super) coordinate_scale: CoordinateScale<T>,
    pub(super) accepted: T,
}

impl<'a, T: Real> Product<'a, T> {
    /// How many coordinates and rows there are.
    fn sizes(&self) -> (usize, usize) {
        (self.q.len(), self.row_scale.len())
    }

    /// Whether there are several factors.
    pub(super) fn has_several(&self) -> bool {
        !self.components.is_empty()
    }

    /// How many constraint rows are independent at regular states.
    pub(crate) fn rank(&self) -> usize {
        let freedoms: usize = self.factors.iter().map(|factor| factor.freedoms).sum();
        self.q.len() - freedoms
    }

    /// The tangent vectors of all factors.
    pub(super) fn tangents(&self) -> &'a [T] {
        let parts = parts(self.components, self.sizes());
        let entries = parts
            .zip(self.factors)
            .map(|(part, factor)| part.n * factor.freedoms);
        &self.tangent[..entries.sum()]
    }

    /// The length of a vector of all coordinates in the diagonal of the metric.
    pub(crate) fn length(&self, x: &[T]) -> T {
        let mut sum = T::zero();
        let mut scales = self.column_scale.iter();
        for part in parts(self.components, self.sizes()) {
            for (place, scale) in (0..part.n).zip(&mut scales) {
                let entry = x[part.coordinate(place)] / *scale;
                sum += entry * entry;
            }
        }
        sum.sqrt()
    }

    /// Fills columns of all coordinates with the columns of each factor, and with zeros.
    pub(crate) fn spread(&self, own: &[T], columns: &mut [T]) {
        let mut all = columns.chunks_exact_mut(self.q.len());
        for (place, _) in self.factors() {
            let own = own[place.tangents].chunks_exact(place.part.n);
            for (own, column) in own.zip(&mut all) {
                column.fill(T::zero());
                place.part.put(own, column);
            }
        }
    }

    /// The direction in which the sheet of each factor moves, or moved before it nearly stopped.
    pub(crate) fn put_heading(&self, all: &mut [T]) {
        for (place, _) in self.factors() {
            place.part.put(&self.heading[place.coordinates], all);
        }
    }

    /// How fast the sheet moves with a drift, unless all factors have nearly stopped.
    pub(crate) fn moving(&self, drift: &[T]) -> Option<T> {
        let speed = self.length(drift);
        let known = self.factors.iter().map(|factor| factor.speed);
        let known = known.fold(T::zero(), T::max);
        Some(speed).filter(|speed| *speed > known * T::from_f64(STOPPED))
    }

    /// Replaces a force by `D z` with `DᵀMD z = Dᵀf`, for these tangent vectors of each
    /// factor; `false` where `DᵀMD` is not definite.
    fn solve_along(
        &self,
        mass: &[T],
        tangent: &[T],
        force: &mut [T],
        workspace: &Workspace<'_, T>,
    ) -> bool {
        let n = self.q.len();
        if !self.has_several() {
            let columns = &tangent[..n * (n - self.rank())];
            return solve_in_subspace(mass, columns, force, workspace).is_ok();
        }
        let mut factors = self.factors();
        factors.all(|(place, _)| {
            let (part, tangent) = (place.part, &tangent[place.tangents]);
            workspace.scope(|workspace| {
                let own = workspace.any(part.n);
                let block = workspace.any(part.n * part.n);
                part.take(force, own);
                part.take_block(mass, block);
                let solved = solve_in_subspace(block, tangent, own, workspace);
                part.put(own, force);
                solved.is_ok()
            })
        })
    }

    /// Its factors: the coordinates and rows of each, and its chart.
    pub(super) fn factors(self) -> impl Iterator<Item = (Place, ChartView<'a, T>)> {
        let all = parts(self.components, self.sizes());
        let factors = all.zip(self.factors).enumerate();
        factors.scan(Offsets::default(), move |at, (index, (part, factor))| {
            let (begin, freedoms) = (*at, factor.freedoms);
            *at = begin.after(part, freedoms);
            let place = Place {
                part,
                index,
                coordinates: begin.coordinates..at.coordinates,
                tangents: begin.tangents..at.tangents,
            };
            Some((place, self.factor(part, factor, begin)))
        })
    }

    fn factor(&self, part: Part, factor: &Factor<T>, at: Offsets) -> ChartView<'a, T> {
        let (coordinates, n) = (at.coordinates, part.n);
        let columns = at.tangents..at.tangents + n * factor.freedoms;
        ChartView {
            tangent: &self.tangent[columns.clone()],
            dual: &self.dual[columns],
            metric: &self.metric[at.squares..][..n * n],
            freedoms: factor.freedoms,
            t: self.t,
            q: &self.q[coordinates..][..n],
            drift: &self.drift[coordinates..][..n],
            heading: &self.heading[coordinates..][..n],
            sizes: &self.sizes[coordinates..][..n],
            column_scale: &self.column_scale[coordinates..][..n],
            row_scale: &self.row_scale[at.rows..][..part.r],
            column_places: &self.column_places[coordinates..][..n],
            rows: &self.rows[at.chosen..][..n - factor.freedoms],
            places: &self.places[at.rows..][..part.r],
            coordinate_scale: self.coordinate_scale,
            accepted: self.accepted,
            speed: factor.speed,
            spacing: factor.spacing,
            gap: factor.gap,
        }
    }
}

/// The chart of one factor, over slices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChartView<'a, T> {
    pub(super) tangent: &'a [T],
    pub(super) dual: &'a [T],
    pub(super) metric: &'a [T],
    pub(super) freedoms: usize,
    pub(super) t: T,
    pub(super) q: &'a [T],
    pub(super) drift: &'a [T],
    pub(super) heading: &'a [T],
    pub(super) sizes: &'a [T],
    pub(super) column_scale: &'a [T],
    pub(super) row_scale: &'a [T],
    pub(super) column_places: &'a [usize],
    pub(super) rows: &'a [usize],
    pub(super) places: &'a [usize],
    pub(super) coordinate_scale: CoordinateScale<T>,
    pub(super) accepted: T,
    pub(super) speed: T,
    pub(super) spacing: T,
    pub(super) gap: bool,
}

impl<T: Real> ChartView<'_, T> {
    /// How many coordinates there are.
    pub(super) fn n(&self) -> usize {
        self.column_scale.len()
    }

    /// Whether anything moves: the coordinates along the sheet, or the sheet with time. Else the
    /// sheet is a point, which no other crosses.
    pub(super) fn moves(&self) -> bool {
        self.freedoms > 0 || self.speed > T::zero()
    }

    /// The length of a vector in the diagonal of the metric.
    pub(super) fn length(&self, x: &[T]) -> T {
        length(x, self.column_scale)
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

/// The length of a vector in a diagonal metric, of which the scales are given.
pub(super) fn length<T: Real>(x: &[T], scales: &[T]) -> T {
    let (n, mut sum) = (x.len(), T::zero());
    let scales = &scales[..n];
    for i in 0..n {
        let x = x[i] / scales[i];
        sum += x * x;
    }
    sum.sqrt()
}

compiled_once! {
    /// [`Product::solve_along`].
    pub(crate) fn solving_along<T>:
        fn(&Product<'_, T>, &[T], &[T], &mut [T], &Workspace<'_, T>) -> bool =
        |chart, mass, tangent, force, workspace| chart.solve_along(mass, tangent, force, workspace);
}
