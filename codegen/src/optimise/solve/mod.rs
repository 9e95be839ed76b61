//! Solves with a mechanism's sparsity, as straight-line code.
//!
//! In:  a program whose outputs are entries of `mass`, `jacobian` and right-hand
//!      sides.
//! Out: a program that solves instead: [`with_acceleration`], [`with_correction`].
//!
//! `M = L D Lᵀ`, `W = L⁻¹Aᵀ`, `S = Wᵀ D⁻¹ W = A M⁻¹ Aᵀ = Λ E Λᵀ`, each in a
//! fill-reducing order that is fixed here. No pivoting and no branch: the pivots
//! (`mass_pivots`, `row_pivots`) are outputs too, beside the diagonals that they
//! are to be compared with (`mass_diagonal`, `row_squares`), and where one is too
//! small the result is not to be used. Left out are masses that elimination leaves
//! as they are. A pivot that is zero by structure means that there is no such
//! program.

mod algebra;
mod factors;

use super::dead::ordered;
use super::program::{Operation, Program, Slot, Value};
use algebra::{Algebra, Entry, Sparse};
use factors::Factors;
use std::collections::BTreeMap;

/// The accelerations: `M q̈ + Aᵀλ = p₁`, `A q̈ = p₂`, from `mass`, `force`,
/// `jacobian`, `bias`. Output `acceleration`.
pub(super) fn with_acceleration(program: &Program, n: usize, r: usize) -> Option<Program> {
    let mut system = System::of(program, n, r)?;
    let (force, bias) = (system.take("force", n), system.take("bias", r));
    let force = system.algebra.forward(&system.mass, force);
    let gaps: Vec<Entry> = (0..r)
        .map(|i| system.algebra.dot(&system.scaled_rows[i], &force, bias[i]))
        .collect();
    let multipliers = system.multipliers(gaps);
    let acceleration = system.lifted(force, &multipliers);
    Some(system.finish(&[("acceleration", acceleration)], program, &[]))
}

/// The least corrections in the kinetic metric: `A Δq = −g`, and `A Δq̇ = −(A q̇ + b)`
/// with the right-hand side that it has `Δq` farther on, to first order: from `mass`,
/// `jacobian`, `residual`, `speed` and `turn`, `∂(A q̇ + b)/∂q`. Outputs `position` and
/// `velocity`; `residual` stays one.
pub(super) fn with_correction(program: &Program, n: usize, r: usize) -> Option<Program> {
    let mut system = System::of(program, n, r)?;
    let residual = system.take("residual", r);
    let position = system.least(residual);
    let turn = system.entries.remove("turn").unwrap_or_default();
    let mut speed = system.take("speed", r);
    for (i, speed) in speed.iter_mut().enumerate() {
        let row: Vec<Entry> = (0..n).map(|j| turn.get(&(i, j)).copied()).collect();
        let less = speed.map(|(minus, value)| (!minus, value));
        *speed = system.algebra.dot(&row, &position, less);
    }
    let velocity = system.least(speed);
    let corrections = [("position", position), ("velocity", velocity)];
    Some(system.finish(&corrections, program, &["residual"]))
}

/// A factorised `M` and `S`.
struct System {
    algebra: Algebra,
    entries: BTreeMap<&'static str, Sparse>,
    mass: Factors,
    schur: Factors,
    /// `W`, a row for each constraint.
    rows: Vec<Vec<Entry>>,
    /// `D⁻¹ W`, likewise.
    scaled_rows: Vec<Vec<Entry>>,
}

impl System {
    /// `None` where `M` or `S` has a pivot that is zero by structure: a coordinate
    /// without inertia, or a constraint row that follows from the others. Likewise
    /// where the program becomes too long.
    fn of(program: &Program, n: usize, r: usize) -> Option<Self> {
        let mut algebra = Algebra {
            program: program.clone(),
        };
        let mut entries: BTreeMap<&'static str, Sparse> = BTreeMap::new();
        for (slot, value) in &program.outputs {
            let entry = algebra.signed(*value);
            let array = entries.entry(slot.array).or_default();
            array.insert((slot.row, slot.column), entry);
        }
        let mass = entries.remove("mass").unwrap_or_default();
        let jacobian = entries.remove("jacobian").unwrap_or_default();

        let mass = algebra.factorise(&mass, n);
        if mass.given_up {
            return None;
        }
        let row = |i| (0..n).map(|j| jacobian.get(&(i, j)).copied()).collect();
        let rows: Vec<Vec<Entry>> = (0..r).map(|i| algebra.forward(&mass, row(i))).collect();
        let scaled_rows: Vec<Vec<Entry>> =
            rows.iter().map(|row| algebra.scaled(&mass, row)).collect();
        let mut schur = Sparse::new();
        for (i, row) in rows.iter().enumerate() {
            for (j, scaled) in scaled_rows[..=i].iter().enumerate() {
                if let Some(entry) = algebra.dot(row, scaled, None) {
                    schur.insert((i, j), entry);
                    schur.insert((j, i), entry);
                }
            }
        }
        let schur = algebra.factorise(&schur, r);
        (!schur.given_up).then_some(System {
            algebra,
            entries,
            mass,
            schur,
            rows,
            scaled_rows,
        })
    }

    /// A vector that the program computes.
    fn take(&mut self, array: &str, size: usize) -> Vec<Entry> {
        let entries = self.entries.remove(array).unwrap_or_default();
        (0..size).map(|i| entries.get(&(i, 0)).copied()).collect()
    }

    /// `λ = S⁻¹ gaps`.
    fn multipliers(&mut self, gaps: Vec<Entry>) -> Vec<Entry> {
        let gaps = self.algebra.forward(&self.schur, gaps);
        let gaps = self.algebra.scaled(&self.schur, &gaps);
        self.algebra.backward(&self.schur, gaps)
    }

    /// The least `x` with `A x = −gaps`.
    fn least(&mut self, gaps: Vec<Entry>) -> Vec<Entry> {
        let multipliers = self.multipliers(gaps);
        let still = vec![None; self.rows.first().map_or(0, Vec::len)];
        self.lifted(still, &multipliers)
    }

    /// `L⁻ᵀ D⁻¹ (driving − W λ)`.
    fn lifted(&mut self, mut driving: Vec<Entry>, multipliers: &[Entry]) -> Vec<Entry> {
        for (row, multiplier) in self.rows.iter().zip(multipliers) {
            for (entry, w) in driving.iter_mut().zip(row) {
                *entry = self.algebra.minus_product(*entry, *w, *multiplier);
            }
        }
        let driven = self.algebra.scaled(&self.mass, &driving);
        self.algebra.backward(&self.mass, driven)
    }

    /// The program with some vectors and the pivot ratios as its outputs, beside
    /// the arrays that are kept.
    fn finish(
        mut self,
        vectors: &[(&'static str, Vec<Entry>)],
        program: &Program,
        kept: &[&str],
    ) -> Program {
        let mut outputs: Vec<(Slot, Value)> = Vec::new();
        outputs.extend(
            program
                .outputs
                .iter()
                .filter(|(slot, _)| kept.contains(&slot.array)),
        );
        for (array, vector) in vectors {
            for (row, entry) in vector.iter().enumerate() {
                let value = self.algebra.unsigned(*entry);
                outputs.extend(value.map(|value| {
                    (
                        Slot {
                            array,
                            row,
                            column: 0,
                        },
                        value,
                    )
                }));
            }
        }
        let pairs = [
            ("mass_pivots", "mass_diagonal", &self.mass.pivots),
            ("row_pivots", "row_squares", &self.schur.pivots),
        ];
        for (pivots, wholes, entries) in pairs {
            for (row, &(pivot, whole)) in entries.iter().enumerate() {
                // A row that shrinks is compared with its own past, a mass is not.
                if pivots == "mass_pivots" && pivot == whole {
                    continue;
                }
                for (array, value) in [(pivots, pivot), (wholes, whole)] {
                    let slot = Slot {
                        array,
                        row,
                        column: 0,
                    };
                    let value = self.algebra.unsigned(Some(value));
                    outputs.extend(value.map(|value| (slot, value)));
                }
            }
        }
        let program = self.algebra.program;
        let operations: Vec<Operation> = program.operations().map(|(_, o)| o.clone()).collect();
        ordered(&operations, &outputs)
    }
}
