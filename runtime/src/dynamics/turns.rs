//! Which coordinates are angles that have gone round.
//!
//! In:  a mechanism, an accepted state.
//! Out: the length of its coordinates, taken note of, with and without the turns.
//!
//! A coordinate goes round if the constraint rows are the same one turn before.

use super::Core;
use crate::linalg::diagonal;
use crate::natural_size::Kind;
use crate::tolerance::excusable;
use crate::{DynamicsError, Mechanism, Real, State, Structure};
use core::f64::consts::TAU;
use nalgebra::{SMatrix, SVector};

/// Part of the range of all coordinates, or of a turn, by which one of them moves in a long step.
const FAR: f64 = 0.25;

/// Refuses a state with an angle whose round-off leaves less than half of the digits.
pub(super) fn check_angles<T: Real>(
    structure: &'static Structure,
    t: T,
    q: &[T],
) -> Result<(), DynamicsError<T>> {
    let most = excusable::<T>() / T::EPSILON;
    for (coordinate, value) in q.iter().enumerate() {
        if value.abs() > most && structure.kind(coordinate) == Some(Kind::Angle) {
            return Err(DynamicsError::AngleTooLarge {
                t,
                coordinate,
                value: *value,
                structure,
            });
        }
    }
    Ok(())
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the length of the coordinates in the metric, where one of them is
    /// larger than it was.
    #[inline]
    pub(crate) fn observe_coordinate_scale(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let [q] = &state.q.data.0;
        let sizes = q.iter().zip(&self.sizes);
        match sizes.fold(false, |any, (q, size)| any | (q.abs() > *size)) {
            true => self.extend_coordinate_scale(mechanism, state),
            false => Ok(()),
        }
    }

    /// Measures the length of the coordinates.
    #[inline(never)]
    fn extend_coordinate_scale(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let [mut q] = state.q.data.0;
        check_angles(mechanism.structure(), state.t, &q)?;
        let turns = self.turns(mechanism, state);
        self.coordinate_scale.extend(
            mechanism.structure(),
            self.metric.factor.as_slice(),
            &mut q,
            &mut self.sizes,
            &turns,
        );
        if self.coordinate_scale.is_limited() {
            // Where the motion began, constraints may have turned more sharply than they do now.
            self.observe_curvature(mechanism, state);
        }
        let far = self.coordinate_scale.range * T::from_f64(FAR);
        let inertia = diagonal(self.metric.factor.as_slice(), N);
        let known = self.weights.iter_mut().zip(&mut self.far);
        for (coordinate, ((weight, length), inertia)) in known.zip(inertia).enumerate() {
            *weight = inertia;
            *length = far / inertia.sqrt();
            // A turn changes everything, however little inertia an angle has.
            if mechanism.structure().kind(coordinate) == Some(Kind::Angle) {
                *length = length.min(T::from_f64(TAU * FAR));
            }
        }
        // Integrals of states have no inertia, and change nothing however far they go.
        let lengths = N - mechanism.structure().states;
        self.weights[lengths..].fill(T::zero());
        self.far[lengths..].fill(T::from_f64(f64::INFINITY));
        Ok(())
    }

    /// Over what distance the acceleration changes with each coordinate.
    pub(crate) fn extents(&self, structure: &Structure) -> SVector<T, N> {
        SVector::from_fn(|coordinate, _| {
            let infinite = T::from_f64(f64::INFINITY);
            let extent = match self.far[coordinate] {
                unknown if unknown == T::zero() => infinite,
                far => far / T::from_f64(FAR),
            };
            match structure.kind(coordinate) {
                Some(Kind::Angle) => extent.min(T::from_f64(TAU)),
                _ => extent,
            }
        })
    }

    /// Which coordinates are beyond a turn, and leave the constraint rows as they are when
    /// they go back by one: angles, and coordinates on which the rows do not depend.
    fn turns(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) -> [bool; N] {
        let beyond = state.q.data.0[0].map(|q| q.abs() > T::from_f64(TAU));
        if !beyond.contains(&true) {
            return beyond;
        }
        let here = self.rows_at(mechanism, state);
        let mut turns = beyond;
        // All of them together; if the rows change then, one by one.
        if !self.returns(mechanism, state, &here, |j| beyond[j]) {
            for j in (0..N).filter(|&j| beyond[j]) {
                turns[j] = self.returns(mechanism, state, &here, |other| other == j);
            }
        }
        mechanism.position(state, &mut self.position);
        turns
    }

    /// Whether the rows are the same where some coordinates have gone back by one turn.
    fn returns(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        here: &[Product<T>; R],
        goes_back: impl Fn(usize) -> bool,
    ) -> bool {
        let mut back = *state;
        for (j, q) in back.q.iter_mut().enumerate().filter(|(j, _)| goes_back(*j)) {
            *q -= T::from_f64(TAU) * state.q[j].sign();
        }
        let there = self.rows_at(mechanism, &back);
        here.iter().zip(&there).all(|(here, there)| {
            let most = T::EPSILON.sqrt() * here.size;
            (here.sum - there.sum).abs() <= most
        })
    }

    /// Products of the rows at a position.
    fn rows_at(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> [Product<T>; R] {
        mechanism.position(state, &mut self.position);
        products(&self.position.jacobian)
    }
}

/// The product of a row with a vector, and the sum of the sizes of its terms.
#[derive(Clone, Copy, Default)]
struct Product<T> {
    sum: T,
    size: T,
}

/// The products of all rows with one vector of irrational numbers, which tell matrices apart as
/// well as all entries do, though there is only one for each row.
fn products<T: Real, const N: usize, const R: usize>(
    jacobian: &SMatrix<T, R, N>,
) -> [Product<T>; R] {
    let mut products = [Product::default(); R];
    for (j, column) in jacobian.data.0.iter().enumerate() {
        let factor = T::from_f64(((3 * j + 2) as f64).sqrt() % 1.0 + 0.5);
        for (product, entry) in products.iter_mut().zip(column) {
            let term = *entry * factor;
            product.sum += term;
            product.size += term.abs();
        }
    }
    products
}
