//! The equations of a mechanism, without its sizes in the type.
//!
//! In:  a mechanism, buffers of its sizes.
//! Out: [`Equations`], which are evaluated into slices.
//!
//! What is not called in every evaluation works on these, so that it is compiled once,
//! whatever the sizes of mechanisms are.

use crate::linalg::add_product;
use crate::{Mechanism, Position, Real, State, Structure, Terms};
use nalgebra::SVector;

/// A state, over slices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At<'a, T> {
    /// Time (s).
    pub(crate) t: T,
    /// Generalized coordinates.
    pub(crate) q: &'a [T],
    /// Generalized velocities.
    pub(crate) v: &'a [T],
}

impl<T: Real> At<'_, T> {
    /// The time and the position at a part of the way to another state, by the cubic
    /// polynomial through both positions and velocities.
    pub(crate) fn towards(&self, end: At<'_, T>, part: T, q: &mut [T]) -> T {
        let h = end.t - self.t;
        let (rest, two) = (T::one() - part, T::from_f64(2.0));
        let first = rest * rest * (T::one() + two * part);
        let last = part * part * (T::one() + two * rest);
        let (leave, arrive) = (part * rest * rest * h, -(part * part * rest * h));
        let ends = self.q.iter().zip(end.q);
        let speeds = self.v.iter().zip(end.v);
        for (target, ((a, b), (v, w))) in q.iter_mut().zip(ends.zip(speeds)) {
            *target = *a * first + *b * last + *v * leave + *w * arrive;
        }
        self.t + h * part
    }
}

impl<T: Real, const N: usize> State<T, N> {
    /// The state over slices.
    pub(crate) fn at(&self) -> At<'_, T> {
        At {
            t: self.t,
            q: self.q.as_slice(),
            v: self.v.as_slice(),
        }
    }
}

/// What is known of the constraints, over slices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constraints<'a, T> {
    /// `M`, the metric of the projections, column by column.
    pub(crate) mass: &'a [T],
    /// `g`.
    pub(crate) residual: &'a [T],
    /// `A`, column by column.
    pub(crate) jacobian: &'a [T],
    /// `b`.
    pub(crate) drift: &'a [T],
    /// `p₂`, where all terms were evaluated last.
    pub(crate) bias: &'a [T],
}

/// The equations of a mechanism of any size, and what they were evaluated into.
pub(crate) trait Equations<T: Real> {
    /// What was known when the code was generated.
    fn structure(&self) -> &'static Structure;
    /// Evaluates the constraints at a time and a position.
    fn locate(&mut self, t: T, q: &[T]);
    /// The constraints where they were evaluated last.
    fn constraints(&self) -> Constraints<'_, T>;
    /// Evaluates all terms at a state.
    fn evaluate(&mut self, state: At<'_, T>);
}

/// The equations of a mechanism, with the buffers that they are evaluated into.
pub(crate) struct Bound<'a, T, const N: usize, const R: usize> {
    pub(crate) mechanism: &'a dyn Mechanism<T, N, R>,
    pub(crate) position: &'a mut Position<T, N, R>,
    pub(crate) terms: &'a mut Terms<T, N, R>,
}

/// A state of fixed size, with zeros for what is not given.
pub(crate) fn sized<T: Real, const N: usize>(at: At<'_, T>) -> State<T, N> {
    let zeros = [T::zero(); N];
    State {
        t: at.t,
        q: SVector::from(*at.q.first_chunk().unwrap_or(&zeros)),
        v: SVector::from(*at.v.first_chunk().unwrap_or(&zeros)),
    }
}

impl<T: Real, const N: usize, const R: usize> Equations<T> for Bound<'_, T, N, R> {
    fn structure(&self) -> &'static Structure {
        self.mechanism.structure()
    }

    fn locate(&mut self, t: T, q: &[T]) {
        let at = At { t, q, v: &[] };
        self.mechanism.position(&sized(at), self.position);
    }

    fn constraints(&self) -> Constraints<'_, T> {
        Constraints {
            mass: self.position.mass.as_slice(),
            residual: self.position.residual.as_slice(),
            jacobian: self.position.jacobian.as_slice(),
            drift: self.position.drift.as_slice(),
            bias: self.terms.bias.as_slice(),
        }
    }

    fn evaluate(&mut self, state: At<'_, T>) {
        self.mechanism.terms(&sized(state), self.terms);
    }
}

impl<T: Real, const N: usize, const R: usize> Position<T, N, R> {
    /// `A q̇ + b`.
    pub(crate) fn speed(&self, v: &SVector<T, N>) -> SVector<T, R> {
        let mut speed = self.drift;
        let jacobian = self.jacobian.as_slice();
        add_product(speed.as_mut_slice(), T::one(), jacobian, v.as_slice());
        speed
    }
}

impl<T: Real, const N: usize, const R: usize> Terms<T, N, R> {
    /// Subtracts `M q̈` from a force.
    pub(crate) fn take_inertia(&self, force: &mut SVector<T, N>, acceleration: &SVector<T, N>) {
        let (mass, acceleration) = (self.mass.as_slice(), acceleration.as_slice());
        add_product(force.as_mut_slice(), -T::one(), mass, acceleration);
    }
}
