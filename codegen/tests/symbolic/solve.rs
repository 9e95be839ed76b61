//! Emitted solves against dense ones, and what their pivots promise.
//!
//! The systems have a mass matrix of a long chain and rows that join neighbours, so that
//! one elimination of coordinates and multipliers is the shorter way.

use bricard_codegen::internals::expr::Symbol;
use bricard_codegen::internals::optimise::{
    Layout, Operation, Program, Slot, Solved, Way, acceleration_solve, correction_solve, interpret,
};
use bricard_testkit::Random;

const N: usize = 14;
const R: usize = 9;
/// Between these are the eigenvalues of the mass matrices, by Gershgorin's circles.
const EIGENVALUES: [f64; 2] = [2.0, 6.0];

type Matrix = Vec<Vec<f64>>;

/// What appends a solve to a program.
type Solving = fn(&Program, Layout) -> Option<Solved>;

/// `M`, `A`, `p₁`, `p₂`.
struct Equations {
    mass: Matrix,
    jacobian: Matrix,
    force: Matrix,
    bias: Matrix,
}

impl Equations {
    fn random(seed: u64) -> Self {
        let mut random = Random::seeded(seed);
        let mut mass = vec![vec![0.0; N]; N];
        for i in 0..N {
            mass[i][i] = 4.0;
            if i + 1 < N {
                mass[i][i + 1] = random.within(1.0);
                mass[i + 1][i] = mass[i][i + 1];
            }
        }
        let mut jacobian = vec![vec![0.0; N]; R];
        for (i, row) in jacobian.iter_mut().enumerate() {
            (i..i + 3).for_each(|j| row[j] = random.within(1.0));
        }
        let mut column = |size| (0..size).map(|_| vec![random.within(1.0)]).collect();
        let (force, bias) = (column(N), column(R));
        Self {
            mass,
            jacobian,
            force,
            bias,
        }
    }

    /// The entries that may differ from zero, with their arrays.
    fn entries(&self) -> Vec<(Slot, f64)> {
        let arrays = [
            ("mass", &self.mass),
            ("jacobian", &self.jacobian),
            ("force", &self.force),
            ("bias", &self.bias),
        ];
        let mut entries = Vec::new();
        for (array, matrix) in arrays {
            for (row, line) in matrix.iter().enumerate() {
                for (column, &value) in line.iter().enumerate() {
                    entries.push((Slot { array, row, column }, value));
                }
            }
        }
        entries.retain(|(_, value)| *value != 0.0);
        entries
    }

    /// The program that solves for accelerations, with entries at these places, and its
    /// outputs.
    fn solved(&self) -> (Solved, impl Fn(&str, usize) -> f64 + use<>) {
        self.solved_by(acceleration_solve, &[])
    }

    /// The outputs of the program that corrects, which tells the sizes of rows, too.
    fn corrected(&self) -> impl Fn(&str, usize) -> f64 + use<> {
        self.solved_by(correction_solve, &[]).1
    }

    fn solved_by(
        &self,
        way: Solving,
        redundant: &[usize],
    ) -> (Solved, impl Fn(&str, usize) -> f64 + use<>) {
        let entries = self.entries();
        let mut program = Program::default();
        for (k, (slot, _)) in entries.iter().enumerate() {
            // Equal entries of a symmetric matrix are one symbol.
            let same = |(other, _): &(Slot, f64)| {
                slot.array == "mass"
                    && other.array == "mass"
                    && (other.row, other.column) == (slot.column, slot.row)
            };
            let k = entries[..k].iter().position(same).unwrap_or(k);
            let symbol = Symbol::Parameter(u32::try_from(k).unwrap());
            let value = program.push(Operation::Symbol(symbol));
            program.outputs.push((*slot, value));
        }
        let layout = Layout {
            n: N,
            r: R,
            weighed: &[],
            redundant,
        };
        let solved = way(&program, layout).unwrap();
        let value = |symbol| match symbol {
            Symbol::Parameter(k) => Some(entries[k as usize].1),
            _ => None,
        };
        let outputs = interpret(&solved.program, &value);
        let output = move |array: &str, row: usize| {
            let written = |(slot, _): &&(Slot, f64)| slot.array == array && slot.row == row;
            outputs
                .iter()
                .find(written)
                .map_or(0.0, |(_, value)| *value)
        };
        (solved, output)
    }

    /// `A M⁻¹ Aᵀ`.
    fn gram(&self) -> Matrix {
        let lines = self.jacobian.iter();
        let turned: Matrix = lines.map(|row| dense(&self.mass, row).0).collect();
        let product = |a: &Vec<f64>| turned.iter().map(|b| dot(a, b)).collect();
        self.jacobian.iter().map(product).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The solution of a dense system by Gaussian elimination, and the size of the determinant.
pub(super) fn dense(matrix: &Matrix, right: &[f64]) -> (Vec<f64>, f64) {
    let (mut rows, n) = (matrix.clone(), right.len());
    rows.iter_mut().zip(right).for_each(|(row, x)| row.push(*x));
    let mut determinant = 1.0;
    for k in 0..n {
        let best = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()));
        rows.swap(k, best.unwrap());
        let pivot = rows[k].clone();
        determinant *= pivot[k].abs();
        for row in (0..n).filter(|row| *row != k) {
            let factor = rows[row][k] / pivot[k];
            rows[row]
                .iter_mut()
                .zip(&pivot)
                .for_each(|(x, p)| *x -= factor * p);
        }
    }
    (
        (0..n).map(|k| rows[k][n] / rows[k][k]).collect(),
        determinant,
    )
}

#[test]
fn a_long_chain_is_solved_in_one_elimination() {
    for seed in 1..20 {
        let equations = Equations::random(seed);
        let (solved, output) = equations.solved();
        assert_eq!(solved.way, Way::Saddle, "seed {seed}");
        check_accelerations(&equations, &output, seed);
    }
}

#[test]
fn rows_that_follow_from_others_are_left_out_and_their_sizes_told() {
    const LEFT_OUT: [usize; 2] = [3, 6];
    for seed in 1..20 {
        let mut equations = Equations::random(seed);
        for row in LEFT_OUT {
            let neighbours = |matrix: &Matrix| -> Vec<f64> {
                let pairs = matrix[row - 1].iter().zip(&matrix[row + 1]);
                pairs.map(|(a, b)| a - 0.5 * b).collect()
            };
            let (levers, bias) = (neighbours(&equations.jacobian), neighbours(&equations.bias));
            (equations.jacobian[row], equations.bias[row]) = (levers, bias);
        }
        let (_, output) = equations.solved_by(acceleration_solve, &LEFT_OUT);
        let corrected = equations.solved_by(correction_solve, &LEFT_OUT).1;
        for (i, row) in equations.gram().iter().enumerate() {
            let error = (corrected("row_squares", i) - row[i]).abs();
            assert!(error <= 1e-13 * row[i], "seed {seed}, row {i}: {error:e}");
            if LEFT_OUT.contains(&i) {
                assert_eq!(corrected("row_pivots", i), 1.0, "seed {seed}, row {i}");
            }
        }
        for row in LEFT_OUT.into_iter().rev() {
            equations.jacobian.remove(row);
            equations.bias.remove(row);
        }
        check_accelerations(&equations, &output, seed);
    }
}

/// Compares accelerations with those of a dense solve.
fn check_accelerations(equations: &Equations, output: &dyn Fn(&str, usize) -> f64, seed: u64) {
    let size = N + equations.jacobian.len();
    let mut whole = vec![vec![0.0; size]; size];
    for i in 0..N {
        whole[i][..N].copy_from_slice(&equations.mass[i]);
        for (k, row) in equations.jacobian.iter().enumerate() {
            (whole[i][N + k], whole[N + k][i]) = (row[i], row[i]);
        }
    }
    let right = [equations.force.concat(), equations.bias.concat()].concat();
    let (exact, _) = dense(&whole, &right);
    let largest = exact.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    for (i, exact) in exact[..N].iter().enumerate() {
        let error = (output("acceleration", i) - exact).abs();
        assert!(error <= 1e-9 * largest, "seed {seed}, {i}: {error:e}");
    }
}

#[test]
fn rows_are_compared_with_their_whole_size() {
    for seed in 1..20 {
        let equations = Equations::random(seed);
        let output = equations.corrected();
        for (i, row) in equations.gram().iter().enumerate() {
            let error = (output("row_squares", i) - row[i]).abs();
            assert!(error <= 1e-13 * row[i], "seed {seed}, row {i}: {error:e}");
        }
    }
}

#[test]
fn dependent_rows_show_in_a_pivot_however_near_they_are() {
    for seed in 1..20 {
        for exponent in 0..7 {
            let mut equations = Equations::random(seed);
            let near = 10_f64.powi(-exponent);
            let changed = |(a, b): (&f64, &f64)| a + near * b;
            let pairs = equations.jacobian[3].iter().zip(&equations.jacobian[4]);
            equations.jacobian[4] = pairs.map(changed).collect();
            let gram = equations.gram();
            let cosine = gram[3][4] * gram[3][4] / (gram[3][3] * gram[4][4]);
            let output = equations.corrected();
            let sine = |i| output("row_pivots", i) / output("row_squares", i);
            let (least, angle) = (sine(3).min(sine(4)), 1.0 - cosine);
            assert!(
                least <= angle + 1e-14,
                "seed {seed}: {least:e}, sine² {angle:e}"
            );
        }
    }
}

#[test]
fn pivots_are_bounds_from_below_and_near() {
    let [least, most] = EIGENVALUES;
    for seed in 1..50 {
        let equations = Equations::random(seed);
        let output = equations.corrected();
        let (_, exact) = dense(&equations.gram(), &[0.0; R]);
        let product: f64 = (0..R).map(|i| output("row_pivots", i)).product();
        let farthest = (least / most).powi(i32::try_from(R).unwrap());
        let round = 1.0 + 1e-9;
        assert!(
            product <= exact * round,
            "seed {seed}: {product:e} of {exact:e}"
        );
        assert!(
            product >= exact * farthest,
            "seed {seed}: {product:e} of {exact:e}"
        );
    }
}
