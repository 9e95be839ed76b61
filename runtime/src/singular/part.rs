//! The coordinates and rows of one sheet: those of a connected component of the constraints.
//!
//! In:  the [`ConnectedComponent`]s of a mechanism.
//! Out: [`Part`]s; what belongs to one of them, taken out of vectors of all coordinates and
//!      put back, and its [`Equations`].
//!
//! The constraint set is the product of those of its connected components, and so are its
//! sheets: where one of them is nearly singular, the others need not be. Coordinates keep their
//! order within a part; where there is but one, it is everything.

use crate::equations::{At, Constraints, Equations};
use crate::linalg::{Workspace, add_scaled, dot, norm};
use crate::{ConnectedComponent, Real, Structure};
use core::ops::Range;

/// The coordinates and rows of one sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    /// None where the mechanism has but one part.
    component: Option<&'static ConnectedComponent>,
    /// How many coordinates and rows there are.
    pub(super) n: usize,
    pub(super) r: usize,
    /// How many coordinates and rows the whole mechanism has.
    whole_n: usize,
    whole_r: usize,
}

/// A part, and the place of its entries in vectors in the order of the parts.
pub(super) struct Place {
    pub(super) part: Part,
    /// Its place among the parts.
    pub(super) index: usize,
    /// Its coordinates among those of all parts.
    pub(super) coordinates: Range<usize>,
    /// The entries of its tangent vectors among those of all parts.
    pub(super) tangents: Range<usize>,
}

/// The parts of a mechanism of `n` coordinates and `r` rows.
pub(super) fn parts(
    components: &'static [ConnectedComponent],
    (n, r): (usize, usize),
) -> impl Iterator<Item = Part> {
    let whole = Part {
        component: None,
        n,
        r,
        whole_n: n,
        whole_r: r,
    };
    let several = components.iter().map(move |component| Part {
        component: Some(component),
        n: component.coordinates.len(),
        r: component.rows.len(),
        ..whole
    });
    let whole = Some(whole).filter(|_| components.is_empty());
    whole.into_iter().chain(several)
}

impl Part {
    /// Whether it is everything.
    pub(super) fn is_whole(&self) -> bool {
        self.component.is_none()
    }

    /// One of its coordinates, by its place in the part.
    pub(super) fn coordinate(&self, place: usize) -> usize {
        match self.component {
            None => place,
            Some(component) => component.coordinates[place],
        }
    }

    /// One of its rows, by its place in the part.
    pub(super) fn row(&self, place: usize) -> usize {
        match self.component {
            None => place,
            Some(component) => component.rows[place],
        }
    }

    /// The place of a row, if it is one of its rows.
    pub(super) fn place_of_row(&self, row: usize) -> Option<usize> {
        match self.component {
            None => Some(row),
            Some(component) => component.rows.binary_search(&row).ok(),
        }
    }

    /// Takes what belongs to it out of a vector of all coordinates.
    pub(super) fn take<T: Copy>(&self, all: &[T], own: &mut [T]) {
        for (place, entry) in own.iter_mut().enumerate() {
            *entry = all[self.coordinate(place)];
        }
    }

    /// Puts what belongs to it into a vector of all coordinates.
    pub(super) fn put<T: Copy>(&self, own: &[T], all: &mut [T]) {
        for (place, entry) in own.iter().enumerate() {
            all[self.coordinate(place)] = *entry;
        }
    }

    /// Takes its block out of a matrix of all coordinates, both column by column.
    pub(super) fn take_block<T: Copy>(&self, all: &[T], own: &mut [T]) {
        for (place, column) in own.chunks_exact_mut(self.n).enumerate() {
            self.take(&all[self.coordinate(place) * self.whole_n..], column);
        }
    }

    /// Takes what belongs to it out of a vector of all rows.
    pub(super) fn take_rows<T: Copy>(&self, all: &[T], own: &mut [T]) {
        for (place, entry) in own.iter_mut().enumerate() {
            *entry = all[self.row(place)];
        }
    }

    /// The state of the part in a state of the whole mechanism.
    pub(super) fn state<'b, T: Real>(
        &self,
        all: At<'_, T>,
        workspace: &Workspace<'b, T>,
    ) -> At<'b, T> {
        let (q, v) = workspace.any(2 * self.n).split_at_mut(self.n);
        self.take(all.q, q);
        self.take(all.v, v);
        At { t: all.t, q, v }
    }

    /// The Jacobian of its rows by its coordinates, taken out of the Jacobian of all rows, both
    /// column by column.
    pub(super) fn take_jacobian<T: Copy>(&self, all: &[T], own: &mut [T]) {
        for (place, column) in own.chunks_exact_mut(self.r.max(1)).enumerate() {
            let entries = &all[self.coordinate(place) * self.whole_r..];
            for (place, entry) in column.iter_mut().enumerate() {
                *entry = entries[self.row(place)];
            }
        }
    }

    /// Whether its constraints restrict positions only, to the same ones at all times.
    pub(super) fn is_scleronomic(&self, structure: &Structure) -> bool {
        let of_all = structure.scleronomic;
        self.component.map_or(of_all, |own| own.scleronomic)
    }
}

/// Restricts a basis of the whole tangent space to the coordinates of each part, one part after
/// the other, and picks as many vectors as the part has degrees of freedom, by Gram–Schmidt with
/// the largest first.
pub(super) fn split_tangent<T: Real>(
    components: &'static [ConnectedComponent],
    sizes: (usize, usize),
    (all, independent): (&[T], &[usize]),
    own: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    let n = sizes.0;
    let mut at = 0;
    for part in parts(components, sizes) {
        let is_own = |row: &&usize| part.place_of_row(**row).is_some();
        let rows = independent.iter().filter(is_own).count();
        let freedoms = part.n.saturating_sub(rows);
        workspace.scope(|workspace| {
            let columns = workspace.any(all.len() / n * part.n);
            let pairs = columns.chunks_exact_mut(part.n).zip(all.chunks_exact(n));
            for (column, all) in pairs {
                part.take(all, column);
            }
            for target in own[at..].chunks_exact_mut(part.n).take(freedoms) {
                take_largest(columns, target);
            }
        });
        at += part.n * freedoms;
    }
}

/// Takes the longest of some columns, with length one, and leaves of the others what is
/// orthogonal to it.
fn take_largest<T: Real>(columns: &mut [T], target: &mut [T]) {
    let n = target.len();
    let (mut most, mut longest) = (T::zero(), 0);
    for (index, column) in columns.chunks_exact(n).enumerate() {
        let length = norm(column);
        if length > most {
            (most, longest) = (length, index);
        }
    }
    target.copy_from_slice(&columns[longest * n..][..n]);
    for entry in &mut *target {
        *entry /= most;
    }
    for column in columns.chunks_exact_mut(n) {
        let share = dot(column, target);
        add_scaled(column, -share, target);
    }
}

/// Coordinates and velocities of the whole mechanism, of which parts change their own.
pub(super) struct Frozen<'b, T> {
    q: &'b mut [T],
    v: &'b mut [T],
    /// The time at which the constraints were evaluated at these coordinates.
    located: Option<T>,
}

impl<'b, T: Real> Frozen<'b, T> {
    /// The coordinates and velocities of a state.
    pub(super) fn new(state: At<'_, T>, workspace: &Workspace<'b, T>) -> Self {
        let n = state.q.len();
        let (q, v) = workspace.any(2 * n).split_at_mut(n);
        q.copy_from_slice(state.q);
        v.copy_from_slice(state.v);
        Self {
            q,
            v,
            located: None,
        }
    }

    /// Gives the coordinates of a part these values.
    fn set(&mut self, part: Part, q: &[T]) {
        for (place, entry) in q.iter().enumerate() {
            let known = &mut self.q[part.coordinate(place)];
            if *known != *entry {
                *known = *entry;
                self.located = None;
            }
        }
    }
}

/// The equations of a part of a mechanism, while its other coordinates stay where they are.
pub(super) struct PartOf<'a, 'b, 'c, T> {
    part: Part,
    whole: &'a mut dyn Equations<T>,
    frozen: &'a mut Frozen<'b, T>,
    jacobian: &'c mut [T],
    residual: &'c mut [T],
    drift: &'c mut [T],
    bias: &'c mut [T],
}

impl<'a, 'b, 'c, T: Real> PartOf<'a, 'b, 'c, T> {
    pub(super) fn new(
        part: Part,
        whole: &'a mut dyn Equations<T>,
        frozen: &'a mut Frozen<'b, T>,
        workspace: &Workspace<'c, T>,
    ) -> Self {
        Self {
            part,
            whole,
            frozen,
            jacobian: workspace.any(part.n * part.r),
            residual: workspace.numbers(part.r),
            drift: workspace.numbers(part.r),
            bias: workspace.numbers(part.r),
        }
    }
}

impl<T: Real> Equations<T> for PartOf<'_, '_, '_, T> {
    fn structure(&self) -> &'static Structure {
        self.whole.structure()
    }

    fn locate(&mut self, t: T, q: &[T]) {
        self.frozen.set(self.part, q);
        if self.frozen.located != Some(t) {
            self.whole.locate(t, self.frozen.q);
            self.frozen.located = Some(t);
        }
        let known = self.whole.constraints();
        self.part.take_jacobian(known.jacobian, self.jacobian);
        self.part.take_rows(known.residual, self.residual);
        self.part.take_rows(known.drift, self.drift);
    }

    fn constraints(&self) -> Constraints<'_, T> {
        Constraints {
            mass: &[],
            residual: self.residual,
            jacobian: self.jacobian,
            drift: self.drift,
            bias: self.bias,
        }
    }

    fn evaluate(&mut self, state: At<'_, T>) {
        self.frozen.set(self.part, state.q);
        self.part.put(state.v, self.frozen.v);
        self.whole.evaluate(At {
            t: state.t,
            q: self.frozen.q,
            v: self.frozen.v,
        });
        let bias = self.whole.constraints().bias;
        self.part.take_rows(bias, self.bias);
    }
}
