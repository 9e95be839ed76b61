//! Which coordinates are angles that have gone round.
//!
//! In:  a mechanism, an accepted state.
//! Out: the length of its coordinates, taken note of, with and without the turns.
//!
//! A coordinate goes round if the constraint rows are the same one turn before.

use super::Core;
use crate::{Mechanism, Real, State};
use core::f64::consts::TAU;
use nalgebra::SMatrix;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the length of the coordinates in the metric, where one of them is
    /// larger than it was.
    #[inline]
    pub(crate) fn observe_coordinate_scale(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) {
        let [q] = &state.q.data.0;
        let sizes = q.iter().zip(&self.sizes);
        if sizes.fold(false, |any, (q, size)| any | (q.abs() > *size)) {
            self.extend_coordinate_scale(mechanism, state);
        }
    }

    /// Measures that length.
    #[inline(never)]
    fn extend_coordinate_scale(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) {
        let turns = self.turns(mechanism, state);
        let [mut q] = state.q.data.0;
        self.coordinate_scale.extend(
            mechanism.structure(),
            self.metric.factor.as_slice(),
            &mut q,
            (&mut self.sizes, &mut self.weights),
            &turns,
        );
    }

    /// Which coordinates are beyond a turn, and leave the constraint rows as they are when
    /// they go back by one: angles, and coordinates on which the rows do not depend.
    fn turns(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) -> [bool; N] {
        let turn = T::from_f64(TAU);
        let is_beyond = |q: &T| q.abs() > turn;
        let mut turns = [false; N];
        if !state.q.iter().any(is_beyond) {
            return turns;
        }
        mechanism.position(state, &mut self.position);
        let here = products(&self.position.jacobian);
        for j in (0..N).filter(|&j| is_beyond(&state.q[j])) {
            let mut back = *state;
            back.q[j] -= turn * state.q[j].sign();
            mechanism.position(&back, &mut self.position);
            let there = products(&self.position.jacobian);
            turns[j] = here.iter().zip(&there).all(|(here, there)| {
                let most = T::EPSILON.sqrt() * here.size;
                (here.sum - there.sum).abs() <= most
            });
        }
        mechanism.position(state, &mut self.position);
        turns
    }
}

/// The product of a row with a vector, and the sum of the sizes of its terms.
#[derive(Clone, Copy, Default)]
struct Product<T> {
    sum: T,
    size: T,
}

/// The products of all rows with one vector of irrational numbers, which tell matrices apart as
/// well as all entries do, and are as many as there are rows.
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
