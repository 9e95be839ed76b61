//! Sparse `L D Lᵀ` in a fill-reducing order, and solves with it.

use super::algebra::{Algebra, Entry, Signed, Sparse};
use crate::expr::Number;
use crate::optimise::program::Operation;

/// `L D Lᵀ` in an order of elimination.
pub(super) struct Factors {
    pub order: Vec<usize>,
    /// Below the unit diagonal of `L`: by pivot, the rows and their entries.
    pub columns: Vec<Vec<(usize, Signed)>>,
    /// `1 / d`, by pivot.
    pub inverse: Vec<Signed>,
    /// `d_i` and the `m_ii` that elimination made it of, by row.
    pub pivots: Vec<(Signed, Signed)>,
    /// Whether a pivot is zero whatever the state, or the program became too long: then
    /// the rest is not to be used.
    pub given_up: bool,
}

impl Algebra {
    /// `M = L D Lᵀ` of a symmetric matrix, in an order of its rows.
    pub fn factorise(&mut self, matrix: &Sparse, order: Vec<usize>) -> Factors {
        let n = order.len();
        let mut rest = matrix.clone();
        let mut place = vec![0; n];
        for (step, &k) in order.iter().enumerate() {
            place[k] = step;
        }
        let one = self.program.push(Operation::Number(Number::ONE));
        let mut inverse = vec![(false, one); n];
        let mut columns = vec![Vec::new(); n];
        let zero = (false, self.number(Number::ZERO));
        let mut pivots = vec![(zero, zero); n];
        let mut given_up = false;
        for (step, &k) in order.iter().enumerate() {
            let pivot = rest.get(&(k, k)).copied().unwrap_or(zero);
            given_up |= self.as_number(pivot.1).is_some_and(Number::is_zero);
            given_up |= self.is_too_long();
            if given_up {
                break;
            }
            inverse[k] = self.inverse(pivot);
            let whole = matrix.get(&(k, k)).copied().unwrap_or(zero);
            pivots[k] = (pivot, whole);
            let row = rest.range((k, 0)..(k + 1, 0));
            let mut below: Vec<(usize, Signed)> = row
                .map(|((_, i), entry)| (*i, *entry))
                .filter(|(i, _)| place[*i] > step)
                .collect();
            below.sort_by_key(|(i, _)| place[*i]);
            for &(i, entry) in &below {
                let factor = self.product(Some(entry), Some(inverse[k]));
                columns[k].extend(factor.map(|factor| (i, factor)));
            }
            self.eliminate(&mut rest, &columns[k], &below);
        }
        Factors {
            order,
            columns,
            inverse,
            pivots,
            given_up,
        }
    }

    /// `m_ij −= l_ik m_jk` for all pairs of rows below a pivot `k`.
    fn eliminate(
        &mut self,
        rest: &mut Sparse,
        factors: &[(usize, Signed)],
        below: &[(usize, Signed)],
    ) {
        for (a, &(i, factor)) in factors.iter().enumerate() {
            for &(j, entry) in &below[..=a] {
                let whole = rest.get(&(i, j)).copied();
                let reduced = self.minus_product(whole, Some(factor), Some(entry));
                for place in [(i, j), (j, i)] {
                    match reduced {
                        Some(value) => rest.insert(place, value),
                        None => rest.remove(&place),
                    };
                }
            }
        }
    }

    /// `L⁻¹ x`.
    pub fn forward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for &k in &factors.order {
            for &(i, factor) in &factors.columns[k] {
                x[i] = self.minus_product(x[i], Some(factor), x[k]);
            }
        }
        x
    }

    /// `L⁻ᵀ x`.
    pub fn backward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for &k in factors.order.iter().rev() {
            for &(i, factor) in &factors.columns[k] {
                x[k] = self.minus_product(x[k], Some(factor), x[i]);
            }
        }
        x
    }

    /// `D⁻¹ x`.
    pub fn scaled(&mut self, factors: &Factors, x: &[Entry]) -> Vec<Entry> {
        let inverse = factors.inverse.iter();
        x.iter()
            .zip(inverse)
            .map(|(x, inverse)| self.product(*x, Some(*inverse)))
            .collect()
    }
}
