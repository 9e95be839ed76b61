//! A state on the sheet of a mechanism, and the sheet's geometry there.
//!
//! In:  what was found on the sheet of each part.
//! Out: [`Point`], of vectors of all coordinates.

use super::part::Place;
use super::place::Placement;
use super::product::Product;
use super::sheet::PointView;
use crate::equations::At;
use crate::{Real, State};
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// A state on the sheet, and the sheet's geometry there.
#[derive(Clone, Debug)]
pub(crate) struct Point<T, const N: usize> {
    pub(crate) state: State<T, N>,
    /// The tangent space: `D* D̃ = 1`, the vectors of each part one after the other.
    pub(crate) tangent: SMatrix<T, N, N>,
    /// The velocity of the sheet where the coordinates of the chart rest.
    pub(crate) drift: SVector<T, N>,
    /// The acceleration where the coordinates of the chart do not accelerate.
    pub(crate) particular: SVector<T, N>,
    /// How the sheet of each part was met.
    pub(crate) met: [Met<T>; N],
}

/// How the sheet of a part was met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met<T> {
    /// About the sine by which the weakest combination of constraint rows is independent
    /// of the others.
    pub(crate) sine: T,
    /// The spacing of nodes, as a change of the sine; zero without any.
    pub(crate) spacing: T,
    /// Whether a gap keeps sheets apart nearby.
    pub(crate) gap: bool,
}

impl<T: Real> Met<T> {
    /// Far from singular configurations.
    fn far() -> Self {
        Self {
            sine: T::one(),
            spacing: T::zero(),
            gap: false,
        }
    }
}

/// The smallest sine of all parts.
pub(crate) fn smallest_sine<T: Real>(met: &[Met<T>]) -> T {
    met.iter().fold(T::one(), |least, met| least.min(met.sine))
}

impl<T: Real, const N: usize> Point<T, N> {
    pub(crate) fn zeros() -> Self {
        Self {
            state: State::default(),
            // Made in place: it is large, and nalgebra's own would be copied here.
            tangent: SMatrix::from_array_storage(ArrayStorage([[T::zero(); N]; N])),
            drift: SVector::zeros(),
            particular: SVector::zeros(),
            met: [Met::far(); N],
        }
    }

    /// The smallest sine of all parts.
    pub(crate) fn sine(&self) -> T {
        smallest_sine(&self.met)
    }

    /// The point over slices, to be changed.
    pub(super) fn slices(&mut self) -> PointSlices<'_, T> {
        PointSlices {
            t: &mut self.state.t,
            q: self.state.q.as_mut_slice(),
            v: self.state.v.as_mut_slice(),
            tangent: self.tangent.as_mut_slice(),
            drift: self.drift.as_mut_slice(),
            particular: self.particular.as_mut_slice(),
            met: &mut self.met,
        }
    }
}

/// A [`Point`] over slices.
pub(crate) struct PointSlices<'a, T> {
    t: &'a mut T,
    q: &'a mut [T],
    v: &'a mut [T],
    tangent: &'a mut [T],
    drift: &'a mut [T],
    particular: &'a mut [T],
    met: &'a mut [Met<T>],
}

impl<T: Real> PointSlices<'_, T> {
    /// Becomes a state, with the geometry of coordinates that nothing constrains.
    pub(super) fn begin(&mut self, state: At<'_, T>, chart: &Product<'_, T>) {
        *self.t = state.t;
        self.q.copy_from_slice(state.q);
        self.v.copy_from_slice(state.v);
        let tangents = chart.tangents();
        self.tangent[..tangents.len()].copy_from_slice(tangents);
        self.drift.fill(T::zero());
        self.particular.fill(T::zero());
        self.met.fill(Met::far());
    }

    /// The state.
    pub(super) fn at(&self) -> At<'_, T> {
        At {
            t: *self.t,
            q: self.q,
            v: self.v,
        }
    }

    /// Takes over what was found on the sheet of a part.
    pub(super) fn keep(&mut self, place: &Place, found: &PointView<'_, T>, how: Placement) {
        let part = place.part;
        part.put(found.q, self.q);
        part.put(found.v, self.v);
        part.put(found.drift, self.drift);
        part.put(found.particular, self.particular);
        self.tangent[place.tangents.clone()].copy_from_slice(found.tangent);
        self.met[place.index] = Met {
            sine: found.sine,
            spacing: found.spacing,
            gap: how == Placement::Gap,
        };
    }
}
