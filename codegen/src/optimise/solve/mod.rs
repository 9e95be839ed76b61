//! Solves with a mechanism's sparsity, as straight-line code.
//!
//! In:  a program whose outputs are entries of `mass`, `jacobian` and right-hand
//!      sides.
//! Out: a program that solves instead: [`with_acceleration`], [`with_correction`]; and
//!      [`with_shared`], for chains of bodies.
//!
//! There are two ways, and the one that costs less is taken: [`Schur`] and [`Saddle`],
//! each in a fill-reducing order that is fixed here. No pivoting and no branch: the
//! pivots (`mass_pivots`, `row_pivots`) are outputs too, beside what they are to be
//! compared with (`mass_diagonal`, `row_squares`), and where one is too small the result
//! is not to be used. Diagonal entries of `M` that elimination does not change are left out. A
//! pivot that is zero by structure means that there is no such program.
//!
//! Where `M` alone is singular, some rows are said to take part in the metric, and `M` is
//! `M + AᵀWA` with the weights that are given at run time. The solution is the same: since
//! `A x` is known, only `λ` changes.
//!
//! Rows that follow from others wherever the constraints hold are left out: they have no
//! multipliers, and pivots that are never the smallest.

mod algebra;
mod factors;
mod order;
mod saddle;
mod schur;
mod shared;

use super::dead::ordered;
use super::program::{Operation, Program, Slot, Value, cost};
use crate::expr::Number;
use crate::model::Symbol;
use algebra::{Algebra, Entry, Signed, Sparse};
use factors::Factors;
use saddle::Saddle;
use schur::Schur;
pub(super) use shared::with_shared;
use std::collections::BTreeMap;

/// The longest program that a solve is written into: a bound on the work of the
/// generator. Beyond it the runtime's solves stay.
const OPERATIONS_MAX: usize = 100_000;

/// The sizes of rows.
const ROW_SQUARES: &str = "row_squares";

/// How many equations there are, and which of them are not like the others.
#[derive(Clone, Copy, Debug)]
pub struct Layout<'a> {
    /// `N`.
    pub n: usize,
    /// `R`.
    pub r: usize,
    /// The rows of `A` that take part in the metric.
    pub weighed: &'a [usize],
    /// The rows of `A` that follow from others.
    pub redundant: &'a [usize],
}

impl Layout<'_> {
    /// The rows that the others follow from, in ascending order.
    fn independent(&self) -> Vec<usize> {
        let is_independent = |row: &usize| !self.redundant.contains(row);
        (0..self.r).filter(is_independent).collect()
    }
}

/// What stands for the pivot of a row that is left out, which is compared with one.
const NO_PIVOT: i64 = 1;

/// What equations there are.
struct Given<'a> {
    /// Computes the entries.
    program: &'a Program,
    layout: Layout<'a>,
}

/// Vectors that a program computes.
type Vectors = Vec<(&'static str, Vec<Entry>)>;

/// The accelerations: `M q̈ + Aᵀλ = p₁`, `A q̈ = p₂`, from `mass`, `force`,
/// `jacobian`, `bias`. Output `acceleration`.
pub(super) fn with_acceleration(program: &Program, layout: Layout) -> Option<Solved> {
    let acceleration = |system: &mut System| {
        let (force, bias) = (
            system.take("force", layout.n),
            system.take("bias", layout.r),
        );
        vec![("acceleration", system.solve(force, &bias))]
    };
    cheaper(&Given { program, layout }, &acceleration, &[])
}

/// The least corrections in the kinetic metric: `A Δq = −g`, and `A Δq̇ = −(A q̇ + b)`
/// with the right-hand side that it has `Δq` farther on, to first order: from `mass`,
/// `jacobian`, `residual`, `speed` and `turn`, `∂(A q̇ + b)/∂q`. Outputs `position` and
/// `velocity`, and the sizes of the rows; `residual` stays one.
pub(super) fn with_correction(program: &Program, layout: Layout) -> Option<Solved> {
    let (n, r) = (layout.n, layout.r);
    let corrections = |system: &mut System| {
        let gaps = system.take("residual", r);
        let position = system.solve(vec![None; n], &opposite(gaps));
        let turn = system.entries.remove("turn").unwrap_or_default();
        let mut speed = opposite(system.take("speed", r));
        for (i, speed) in speed.iter_mut().enumerate() {
            let row: Vec<Entry> = (0..n).map(|j| turn.get(&(i, j)).copied()).collect();
            *speed = system.algebra.dot(&row, &position, *speed);
        }
        let velocity = system.solve(vec![None; n], &opposite(speed));
        vec![("position", position), ("velocity", velocity)]
    };
    let kept = ["residual", ROW_SQUARES];
    cheaper(&Given { program, layout }, &corrections, &kept)
}

/// The cheaper one of the programs that compute vectors by the two ways.
fn cheaper(
    given: &Given,
    vectors: &dyn Fn(&mut System) -> Vectors,
    kept: &[&str],
) -> Option<Solved> {
    let by = |way: Way, longest: usize| {
        let mut system = System::of(given, way, longest)?;
        let vectors = vectors(&mut system);
        let program = system.finish(&vectors, given.program, kept);
        Some(Solved { program, way })
    };
    // Without constraints there is only `M`.
    let saddle = match given.layout.r {
        0 => None,
        _ => by(Way::Saddle, OPERATIONS_MAX),
    };
    let weight = |solved: &Solved| cost(&solved.program).weight();
    let longest = saddle.as_ref().map_or(OPERATIONS_MAX, weight);
    let schur = by(Way::Schur, longest.min(OPERATIONS_MAX));
    match (schur, saddle) {
        (Some(schur), Some(saddle)) if weight(&saddle) < weight(&schur) => Some(saddle),
        (schur, saddle) => schur.or(saddle),
    }
}

fn opposite(entries: Vec<Entry>) -> Vec<Entry> {
    let opposite = |(minus, value): Signed| (!minus, value);
    entries
        .into_iter()
        .map(|entry| entry.map(opposite))
        .collect()
}

/// How equations are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// `M = L D Lᵀ`, then the Schur complement `A M⁻¹ Aᵀ`.
    Schur,
    /// `[M Aᵀ; A 0] = L D Lᵀ`, each multiplier after the coordinates of its row.
    Saddle,
    /// Velocities that bodies have in common as unknowns beside those of the coordinates,
    /// replaced by what they are made of one after the other, from the last body back.
    Shared,
}

/// A program that solves equations.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The program.
    pub program: Program,
    /// How it solves them.
    pub way: Way,
}

/// Factors of the equations.
enum Factorised {
    Schur(Schur),
    Saddle(Saddle),
}

impl Factorised {
    /// The factors of `M`.
    fn mass(&self) -> &Factors {
        match self {
            Self::Schur(factors) => &factors.mass,
            Self::Saddle(factors) => &factors.mass,
        }
    }
}

/// Some rows of a matrix, one after the other.
fn chosen(matrix: &Sparse, rows: &[usize]) -> Sparse {
    let entries = rows.iter().enumerate().flat_map(|(place, &row)| {
        let entries = matrix.range((row, 0)..(row + 1, 0));
        entries.map(move |((_, j), entry)| ((place, *j), *entry))
    });
    entries.collect()
}

impl Algebra {
    /// `M + AᵀWA` of the rows that take part.
    fn weigh(&mut self, mass: &mut Sparse, jacobian: &Sparse, weighed: &[usize]) {
        for &row in weighed {
            let entries = jacobian.range((row, 0)..(row + 1, 0));
            let entries: Vec<(usize, Entry)> =
                entries.map(|((_, j), entry)| (*j, Some(*entry))).collect();
            let symbol = Symbol::Weight(u32::try_from(row).unwrap_or(u32::MAX));
            let weight = Some((false, self.program.push(Operation::Symbol(symbol))));
            for (a, &(i, entry)) in entries.iter().enumerate() {
                let share = self.product(weight, entry).map(|(minus, x)| (!minus, x));
                for &(j, other) in &entries[..=a] {
                    let whole = mass.get(&(i, j)).copied();
                    if let Some(sum) = self.minus_product(whole, share, other) {
                        mass.insert((i, j), sum);
                        mass.insert((j, i), sum);
                    }
                }
            }
        }
    }
}

/// A program that is being written.
struct System {
    algebra: Algebra,
    entries: BTreeMap<&'static str, Sparse>,
    factorised: Factorised,
    /// The rows that are solved with.
    rows: Vec<usize>,
    /// The other rows, with their sizes.
    left_out: Vec<(usize, Signed)>,
}

impl System {
    fn of(given: &Given, way: Way, longest: usize) -> Option<Self> {
        let Layout {
            n,
            weighed,
            redundant,
            ..
        } = given.layout;
        let rows = given.layout.independent();
        let (mut algebra, mut entries) = Algebra::behind(given.program, longest);
        let mut mass = entries.remove("mass").unwrap_or_default();
        let jacobian = entries.remove("jacobian").unwrap_or_default();
        algebra.weigh(&mut mass, &jacobian, weighed);
        let independent = chosen(&jacobian, &rows);
        let size = (n, rows.len());
        let factorised = if way == Way::Schur {
            Factorised::Schur(Schur::of(&mut algebra, &mass, &independent, size)?)
        } else {
            Factorised::Saddle(Saddle::of(&mut algebra, &mass, &independent, size)?)
        };
        let others = chosen(&jacobian, redundant);
        let sizes = algebra.squares(factorised.mass(), &others, redundant.len())?;
        Some(System {
            algebra,
            entries,
            factorised,
            rows,
            left_out: redundant.iter().copied().zip(sizes).collect(),
        })
    }

    /// A vector that the program computes.
    fn take(&mut self, array: &str, size: usize) -> Vec<Entry> {
        let entries = self.entries.remove(array).unwrap_or_default();
        (0..size).map(|i| entries.get(&(i, 0)).copied()).collect()
    }

    /// `x` of `M x + Aᵀλ = driving`, `A x = target`, of which the targets of rows that are left
    /// out are not looked at.
    fn solve(&mut self, driving: Vec<Entry>, target: &[Entry]) -> Vec<Entry> {
        let target: Vec<Entry> = self.rows.iter().map(|&row| target[row]).collect();
        match &self.factorised {
            Factorised::Schur(factors) => factors.solve(&mut self.algebra, driving, &target),
            Factorised::Saddle(factors) => factors.solve(&mut self.algebra, driving, &target),
        }
    }

    /// The program with some vectors and the pivots as its outputs, beside the arrays
    /// that are kept.
    fn finish(self, vectors: &Vectors, program: &Program, kept: &[&str]) -> Program {
        let Self {
            mut algebra,
            factorised,
            rows: independent,
            left_out,
            ..
        } = self;
        let no_pivot = (false, algebra.number(Number::integer(NO_PIVOT)));
        let mut outputs: Vec<(Slot, Value)> = Vec::new();
        let is_kept = |(slot, _): &&(Slot, Value)| kept.contains(&slot.array);
        outputs.extend(program.outputs.iter().filter(is_kept));
        let mut write = |array: &'static str, row: usize, entry: Entry| {
            let slot = Slot {
                array,
                row,
                column: 0,
            };
            outputs.extend(algebra.unsigned(entry).map(|value| (slot, value)));
        };
        for (array, vector) in vectors {
            for (row, entry) in vector.iter().enumerate() {
                write(array, row, *entry);
            }
        }
        let rows = match &factorised {
            Factorised::Schur(factors) => &factors.schur.pivots,
            Factorised::Saddle(factors) => &factors.row_pivots,
        };
        for (row, &(pivot, whole)) in factorised.mass().pivots.iter().enumerate() {
            if pivot != whole {
                write("mass_pivots", row, Some(pivot));
                write("mass_diagonal", row, Some(whole));
            }
        }
        let solved = independent.iter().copied().zip(rows);
        let solved = solved.map(|(row, &(pivot, whole))| (row, pivot, whole));
        let left_out = left_out.into_iter();
        let left_out = left_out.map(|(row, whole)| (row, no_pivot, whole));
        for (row, pivot, whole) in solved.chain(left_out) {
            write("row_pivots", row, Some(pivot));
            // A row is compared with its own past, which a correction tells.
            if kept.contains(&ROW_SQUARES) {
                write(ROW_SQUARES, row, Some(whole));
            }
        }
        ordered(algebra.program.list(), &outputs, &|value| value)
    }
}
