//! The regular accelerations as straight-line code with a mechanism's sparsity.
//!
//! In:  a program whose outputs are the entries of `M`, `p₁`, `A`, `p₂`.
//! Out: the program that solves `M q̈ + Aᵀλ = p₁`, `A q̈ = p₂` instead: outputs
//!      `acceleration`, the smallest pivot ratio of `M` (`mass_pivot`) and of the
//!      Schur complement (`pivot`, the squared sine of the angle between a
//!      constraint row and the rows before it in the kinetic metric).
//!
//! `M = L D Lᵀ`, `W = L⁻¹Aᵀ`, `S = Wᵀ D⁻¹ W = Λ E Λᵀ`, each in a fill-reducing
//! order that is fixed here. No pivoting and no branch: where a ratio is too small
//! the result is not to be used.

use super::dead::ordered;
use super::program::{Operation, Program, Slot, Value};
use crate::expr::{Function2, Number};
use std::collections::{BTreeMap, BTreeSet};

/// A signed value; absent where an entry is zero by structure.
type Entry = Option<(bool, Value)>;

/// A sparse matrix by row and column.
type Sparse = BTreeMap<(usize, usize), (bool, Value)>;

/// `L D Lᵀ` in an order of elimination.
struct Factors {
    order: Vec<usize>,
    /// Below the unit diagonal of `L`: by pivot, the rows and their entries.
    columns: Vec<Vec<(usize, (bool, Value))>>,
    /// `1 / d`, by pivot.
    inverse: Vec<(bool, Value)>,
    /// The smallest `d_i / m_ii`; absent if there is no row.
    ratio: Option<Value>,
}

/// Appends the solve to a program of `n` coordinates and `r` constraint rows.
pub(super) fn with_solve(program: &Program, n: usize, r: usize) -> Program {
    let mut solver = Solver {
        program: program.clone(),
    };
    let mut entries: BTreeMap<&str, Sparse> = BTreeMap::new();
    for (slot, value) in &program.outputs {
        let entry = solver.signed(*value);
        entries
            .entry(slot.array)
            .or_default()
            .insert((slot.row, slot.column), entry);
    }
    let mut take = |array: &str| entries.remove(array).unwrap_or_default();
    let (mass, force) = (take("mass"), column(&take("force"), n));
    let (jacobian, bias) = (take("jacobian"), column(&take("bias"), r));

    let factors = solver.factorise(&mass, n);
    let force = solver.forward(&factors, force);
    let rows: Vec<Vec<Entry>> = (0..r)
        .map(|i| solver.forward(&factors, row(&jacobian, i, n)))
        .collect();
    let scaled: Vec<Vec<Entry>> = rows.iter().map(|w| solver.scaled(&factors, w)).collect();
    let (multipliers, pivot) = solver.multipliers(&rows, &scaled, &force, &bias);

    let mut driving = force;
    for (w, multiplier) in rows.iter().zip(&multipliers) {
        for (entry, w) in driving.iter_mut().zip(w) {
            *entry = solver.minus_product(*entry, *w, *multiplier);
        }
    }
    let driven = solver.scaled(&factors, &driving);
    let acceleration = solver.backward(&factors, driven);

    let mut outputs: Vec<(Slot, Value)> = Vec::new();
    for (row, entry) in acceleration.into_iter().enumerate() {
        if let Some(value) = solver.unsigned(entry) {
            outputs.push((
                Slot {
                    array: "acceleration",
                    row,
                    column: 0,
                },
                value,
            ));
        }
    }
    let ratios = [("mass_pivot", factors.ratio), ("pivot", pivot)];
    for (array, ratio) in ratios {
        outputs.extend(ratio.map(|value| {
            (
                Slot {
                    array,
                    row: 0,
                    column: 0,
                },
                value,
            )
        }));
    }
    let operations: Vec<Operation> = solver
        .program
        .operations()
        .map(|(_, o)| o.clone())
        .collect();
    ordered(&operations, &outputs)
}

fn column(entries: &Sparse, n: usize) -> Vec<Entry> {
    (0..n).map(|i| entries.get(&(i, 0)).copied()).collect()
}

fn row(entries: &Sparse, i: usize, n: usize) -> Vec<Entry> {
    (0..n).map(|j| entries.get(&(i, j)).copied()).collect()
}

/// An order of elimination by minimum degree; of equals the first.
fn elimination_order(matrix: &Sparse, n: usize) -> Vec<usize> {
    let mut neighbours: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
    for &(i, j) in matrix.keys().filter(|(i, j)| i != j) {
        neighbours[i].insert(j);
        neighbours[j].insert(i);
    }
    let mut left: BTreeSet<usize> = (0..n).collect();
    let mut order = Vec::with_capacity(n);
    while let Some(&next) = left.iter().min_by_key(|&&i| (neighbours[i].len(), i)) {
        left.remove(&next);
        order.push(next);
        let around = std::mem::take(&mut neighbours[next]);
        for &i in &around {
            neighbours[i].remove(&next);
            neighbours[i].extend(around.iter().copied().filter(|&j| j != i));
        }
    }
    order
}

struct Solver {
    program: Program,
}

impl Solver {
    /// `M = L D Lᵀ` of a symmetric matrix.
    fn factorise(&mut self, matrix: &Sparse, n: usize) -> Factors {
        let order = elimination_order(matrix, n);
        let mut rest = matrix.clone();
        let one = self.program.push(Operation::Number(Number::ONE));
        let mut inverse = vec![(false, one); n];
        let mut columns = vec![Vec::new(); n];
        let mut ratio: Option<Value> = None;
        for (step, &k) in order.iter().enumerate() {
            // A pivot that is zero by structure makes the ratio zero.
            let zero = (false, self.number(Number::ZERO));
            let pivot = rest.get(&(k, k)).copied().unwrap_or(zero);
            inverse[k] = self.inverse(pivot);
            ratio = Some(self.smaller(ratio, pivot, matrix.get(&(k, k)).copied()));
            let below: Vec<(usize, (bool, Value))> = order[step + 1..]
                .iter()
                .filter_map(|&i| rest.get(&(i, k)).map(|entry| (i, *entry)))
                .collect();
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
            ratio,
        }
    }

    /// `m_ij −= l_ik m_jk` for all pairs of rows below a pivot `k`.
    fn eliminate(
        &mut self,
        rest: &mut Sparse,
        factors: &[(usize, (bool, Value))],
        below: &[(usize, (bool, Value))],
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
    fn forward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for &k in &factors.order {
            for &(i, factor) in &factors.columns[k] {
                x[i] = self.minus_product(x[i], Some(factor), x[k]);
            }
        }
        x
    }

    /// `L⁻ᵀ x`.
    fn backward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for &k in factors.order.iter().rev() {
            for &(i, factor) in &factors.columns[k] {
                x[k] = self.minus_product(x[k], Some(factor), x[i]);
            }
        }
        x
    }

    /// `D⁻¹ x`.
    fn scaled(&mut self, factors: &Factors, x: &[Entry]) -> Vec<Entry> {
        let inverse = factors.inverse.iter();
        x.iter()
            .zip(inverse)
            .map(|(x, inverse)| self.product(*x, Some(*inverse)))
            .collect()
    }

    /// `λ` from `S λ = Wᵀ D⁻¹ L⁻¹ p₁ − p₂`, and the smallest pivot ratio of `S`.
    fn multipliers(
        &mut self,
        rows: &[Vec<Entry>],
        scaled: &[Vec<Entry>],
        force: &[Entry],
        bias: &[Entry],
    ) -> (Vec<Entry>, Option<Value>) {
        let r = rows.len();
        let mut schur = Sparse::new();
        for i in 0..r {
            for j in 0..=i {
                if let Some(entry) = self.dot(&rows[i], &scaled[j], None) {
                    schur.insert((i, j), entry);
                    schur.insert((j, i), entry);
                }
            }
        }
        let gaps: Vec<Entry> = (0..r)
            .map(|i| self.dot(&scaled[i], force, bias[i]))
            .collect();
        let factors = self.factorise(&schur, r);
        let gaps = self.forward(&factors, gaps);
        let gaps = self.scaled(&factors, &gaps);
        (self.backward(&factors, gaps), factors.ratio)
    }

    /// `Σ x_k y_k − less`.
    fn dot(&mut self, x: &[Entry], y: &[Entry], less: Entry) -> Entry {
        let mut terms: Vec<(bool, Value)> = x
            .iter()
            .zip(y)
            .filter_map(|(x, y)| self.product(*x, *y))
            .collect();
        terms.extend(less.map(|(minus, value)| (!minus, value)));
        self.sum(terms)
    }

    /// `x − a·b`.
    fn minus_product(&mut self, x: Entry, a: Entry, b: Entry) -> Entry {
        let Some((minus, product)) = self.product(a, b) else {
            return x;
        };
        let terms = x.into_iter().chain([(!minus, product)]).collect();
        self.sum(terms)
    }

    fn product(&mut self, a: Entry, b: Entry) -> Entry {
        let ((minus_a, a), (minus_b, b)) = (a?, b?);
        let minus = minus_a != minus_b;
        let value = match (self.as_number(a), self.as_number(b)) {
            (Some(x), Some(y)) => self.number(x.mul(y)),
            (Some(x), _) if x.is_one() => b,
            (_, Some(y)) if y.is_one() => a,
            _ => self.program.push(Operation::Product(vec![a, b])),
        };
        Some((minus, value))
    }

    fn sum(&mut self, terms: Vec<(bool, Value)>) -> Entry {
        let mut number = Number::ZERO;
        let mut kept: Vec<(bool, Value)> = Vec::new();
        for (minus, value) in terms {
            match self.as_number(value) {
                Some(x) => number = number.add(if minus { x.neg() } else { x }),
                // Equal terms of opposite sign cancel exactly.
                None => match kept.iter().position(|term| *term == (!minus, value)) {
                    Some(opposite) => drop(kept.remove(opposite)),
                    None => kept.push((minus, value)),
                },
            }
        }
        if !number.is_zero() {
            let size = if number.is_negative() {
                number.neg()
            } else {
                number
            };
            kept.push((number.is_negative(), self.number(size)));
        }
        match kept[..] {
            [] => None,
            [only] => Some(only),
            _ if kept.iter().all(|(minus, _)| *minus) => {
                let positive = kept.iter().map(|(_, value)| (false, *value)).collect();
                Some((true, self.program.push(Operation::Sum(positive))))
            }
            _ => Some((false, self.program.push(Operation::Sum(kept)))),
        }
    }

    fn inverse(&mut self, (minus, value): (bool, Value)) -> (bool, Value) {
        let exact = self.as_number(value).and_then(|x| x.powi(-1));
        let inverse = match exact {
            Some(x) => self.number(x),
            None => {
                let one = self.number(Number::ONE);
                self.program.push(Operation::Quotient(one, value))
            }
        };
        (minus, inverse)
    }

    /// The smaller of a ratio so far and `pivot / whole`; 1 where nothing was
    /// subtracted from the pivot.
    fn smaller(&mut self, so_far: Option<Value>, pivot: (bool, Value), whole: Entry) -> Value {
        let ratio = match whole {
            Some(whole) if whole == pivot => self.number(Number::ONE),
            Some((minus, whole)) => {
                let ratio = self.program.push(Operation::Quotient(pivot.1, whole));
                match minus == pivot.0 {
                    true => ratio,
                    false => self.program.push(Operation::Sum(vec![(true, ratio)])),
                }
            }
            None => self.number(Number::ZERO),
        };
        match so_far {
            None => ratio,
            Some(known) if self.as_number(ratio).is_some_and(Number::is_one) => known,
            Some(known) if self.as_number(known).is_some_and(Number::is_one) => ratio,
            Some(known) => self
                .program
                .push(Operation::Function2(Function2::Min, known, ratio)),
        }
    }

    fn number(&mut self, value: Number) -> Value {
        self.program.push(Operation::Number(value))
    }

    fn as_number(&self, value: Value) -> Option<Number> {
        match self.program.operation(value) {
            Operation::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// A value without a change of sign in front.
    fn signed(&self, value: Value) -> (bool, Value) {
        match self.program.operation(value) {
            Operation::Sum(terms) if terms.len() == 1 && terms[0].0 => (true, terms[0].1),
            _ => (false, value),
        }
    }

    fn unsigned(&mut self, entry: Entry) -> Option<Value> {
        let (minus, value) = entry?;
        Some(if minus {
            self.program.push(Operation::Sum(vec![(true, value)]))
        } else {
            value
        })
    }
}
