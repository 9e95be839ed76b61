//! How large the rows of `A` are away from singular positions.
//!
//! In:  the first state of a motion.
//! Out: reference sizes, also if the motion begins exactly in a singular position,
//!      where rows of `A` vanish; whether the mass matrix is definite anywhere, and
//!      whether the masses that a row connects are of similar size.
//!
//! The rows are evaluated with all angles turned to other values. A coordinate of which
//! nothing tells what it measures is moved, too; then that is evidence only for rows that
//! vanish at the first state.

use super::Core;
use super::erased::Constrained;
use super::singular_values::lift;
use crate::equations::At;
use crate::linalg::{Workspace, dot, independent_columns, is_definite, norm, scale};
use crate::natural_size::{Kind, NaturalSizes};
use crate::once::compiled_once;
use crate::tolerance::{hull, regular, spacing};
use crate::{Mechanism, Position, Real, State};

/// How many times the angles are turned.
const SAMPLES: usize = 8;
/// Fractional parts of the square and cube root of 2 and such numbers spread
/// evenly when multiplied by integers.
const STRIDES: [f64; 2] = [0.618_033_988_749_894_9, 0.414_213_562_373_095];

/// How much more than usual the masses that a row connects may be coupled for its size to
/// count: the mass matrix may be nearly singular at some positions, where rows are as
/// large as one likes. One that is constant is not.
const UNUSUAL: f64 = 4.0;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the mean sizes of the rows over some turned positions.
    #[inline(never)]
    pub(super) fn sample_sizes(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) {
        let by_form = self.rows.are_independent_by_form();
        let (mut solver, workspace, _) = self.lend(mechanism);
        sampling()(&mut solver, state.at(), by_form, &workspace);
    }
}

/// The squared sizes of rows, one position after the other.
struct Sizes<'a, T> {
    /// In the metric of the kinetic energy.
    whole: &'a mut [T],
    /// In that of each coordinate alone.
    alone: &'a mut [T],
}

impl<'a, T: Real> Sizes<'a, T> {
    /// Room for so many.
    fn new(count: usize, workspace: &Workspace<'a, T>) -> Self {
        Self {
            whole: workspace.numbers(count),
            alone: workspace.numbers(count),
        }
    }

    /// How much the coupling of the masses adds; infinite where the row restricts a
    /// coordinate without inertia.
    fn coupling(&self, index: usize) -> T {
        match self.alone[index].is_finite() {
            true => self.whole[index] / self.alone[index],
            false => self.alone[index],
        }
    }

    /// The sizes of all rows at a position, from a place on; zero where they are not finite or
    /// have no metric.
    fn measure(
        &mut self,
        solver: &mut dyn Constrained<T>,
        (t, q): (T, &[T]),
        first: usize,
        workspace: &Workspace<'_, T>,
    ) {
        if solver.visit(t, q).is_err() {
            return;
        }
        solver.learn().metric.observe_pivots();
        workspace.scope(|workspace| {
            let (at, known) = (solver.constraints(), solver.known());
            let (alone, lifted) = (workspace.numbers(known.r()), workspace.numbers(q.len()));
            rows_alone(at.mass, at.jacobian, alone);
            for (row, alone) in alone.iter().enumerate() {
                lift(at.jacobian, known, row, lifted);
                let square = dot(lifted, lifted);
                if square.is_finite() {
                    self.whole[first + row] = square;
                    self.alone[first + row] = *alone;
                }
            }
        });
    }
}

/// Takes note of the mean sizes of the rows over some turned positions.
pub(super) fn sample_sizes<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    by_form: bool,
    workspace: &Workspace<'_, T>,
) {
    let r = solver.known().r();
    let turned = workspace.numbers(state.q.len());
    workspace.scope(|workspace| sample_mass(solver, state, turned, workspace));
    let mut here = Sizes::new(r, workspace);
    here.measure(solver, (state.t, state.q), 0, workspace);
    let mut samples = Sizes::new(r * SAMPLES, workspace);
    // If no row vanishes anywhere, this state is as good as others.
    if !by_form {
        for sample in 0..SAMPLES {
            turn(solver, state.q, sample + 1, turned);
            samples.measure(solver, (state.t, turned), sample * r, workspace);
        }
    }
    for row in 0..r {
        if by_form {
            let mut rows = solver.learn().rows;
            rows.observe(row, here.whole[row], here.alone[row]);
        } else {
            observe(solver, row, &here, &samples);
        }
    }
}

/// Takes note of the size of a row at a state and of its mean over samples.
fn observe<T: Real>(
    solver: &mut dyn Constrained<T>,
    row: usize,
    here: &Sizes<'_, T>,
    samples: &Sizes<'_, T>,
) {
    let r = here.whole.len();
    let structure = solver.structure();
    let unknown = |j| structure.kind(j) == Some(Kind::Unknown);
    let sure = !(0..structure.coordinates.len()).any(unknown);
    let mut learning = solver.learn();
    if !structure.constant_mass || !learning.metric.parts.is_mass_matrix() {
        let mut couplings = [T::zero(); SAMPLES];
        for (sample, coupling) in couplings.iter_mut().enumerate() {
            *coupling = samples.coupling(sample * r + row);
        }
        let coupling = median(couplings) * T::from_f64(UNUSUAL);
        learning.rows.expect_coupling(row, coupling);
    }
    let mean = |sizes: &[T]| {
        let of_row = sizes.iter().skip(row).step_by(r);
        of_row.fold(T::zero(), |sum, size| sum + *size) / T::from_f64(SAMPLES as f64)
    };
    let (whole, alone) = (mean(samples.whole), mean(samples.alone));
    let vanishes = here.whole[row] <= regular::<T>() * regular::<T>() * whole;
    learning.rows.observe(row, here.whole[row], here.alone[row]);
    if sure || vanishes {
        learning.rows.observe(row, whole, alone);
    }
}

/// Finds out whether the mass matrix is a metric at any turned position, and one in
/// which the rows can be told apart.
fn sample_mass<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    turned: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    let named = solver.structure().weighed;
    solver.learn().metric.begin(named);
    let mut definite = !named.is_empty();
    let levers = workspace.numbers(solver.constraints().jacobian.len());
    for sample in 1..=SAMPLES {
        turn(solver, state.q, sample, turned);
        solver.locate(state.t, turned);
        let mut learning = solver.learn();
        let mass = learning.at.mass;
        learning.metric.observe(mass);
        definite = definite || is_definite(mass, turned.len(), workspace);
        for (most, entry) in levers.iter_mut().zip(learning.at.jacobian) {
            let square = *entry * *entry;
            if square > *most && square.is_finite() {
                *most = square;
            }
        }
    }
    if !named.is_empty() {
        observe_ratios(solver, state, turned);
    }
    let mut learning = solver.learn();
    let inertia = learning.metric.inertia();
    let mut uneven = learning.rows.weigh_unevenly(levers, inertia, workspace);
    let mut apart = |sample| {
        turn(solver, state.q, sample, turned);
        solver.locate(state.t, turned);
        rows_are_apart(solver, workspace)
    };
    if uneven && (1..=SAMPLES).all(&mut apart) {
        solver.learn().rows.weigh_evenly();
        uneven = false;
    }
    if !definite || uneven {
        solver.learn().metric.parts.augment();
    }
}

/// Takes note of the inertia of ratios where they have other values. Of Euler parameters one
/// is nearly one and the others nearly zero at some positions, where it has next to no inertia,
/// and so would the direction along which they do not move.
fn observe_ratios<T: Real>(solver: &mut dyn Constrained<T>, state: At<'_, T>, moved: &mut [T]) {
    let structure = solver.structure();
    let Some(size) = NaturalSizes::measure(structure, state.q).of(Kind::Ratio) else {
        return;
    };
    for sample in 1..=SAMPLES {
        turn(solver, state.q, sample, moved);
        for (j, q) in moved.iter_mut().enumerate() {
            if structure.kind(j) == Some(Kind::Ratio) {
                *q += size * T::from_f64(2.0 * stride(sample, j) - 1.0);
            }
        }
        solver.locate(state.t, moved);
        let mut learning = solver.learn();
        let mass = learning.at.mass;
        learning.metric.observe(mass);
    }
}

/// Whether the masses let all rows where the constraints were evaluated last be told apart: by
/// sines as they are beyond the reach of any singular configuration.
fn rows_are_apart<T: Real>(solver: &mut dyn Constrained<T>, workspace: &Workspace<'_, T>) -> bool {
    if !solver.factorise_mass() {
        return false;
    }
    let (known, jacobian) = (solver.known(), solver.constraints().jacobian);
    let r = known.r();
    let n = jacobian.len() / r;
    // More rows than coordinates never are.
    r <= n
        && workspace.scope(|workspace| {
            let vectors = workspace.numbers(jacobian.len());
            for (row, vector) in vectors.chunks_exact_mut(n).enumerate() {
                lift(jacobian, known, row, vector);
                scale(vector, T::one() / norm(vector));
            }
            let least = spacing::<T>() * hull(5);
            independent_columns(vectors, n, &|_| true, least, workspace.indices(r)) == r
        })
}

impl<T: Real, const N: usize, const R: usize> Position<T, N, R> {
    /// The squared sizes of the rows in the metric of each coordinate alone, `Σ aⱼ²/mⱼⱼ`;
    /// infinite for one that restricts a coordinate without inertia.
    pub(super) fn rows_alone(&self) -> [T; R] {
        let mut alone = [T::zero(); R];
        rows_alone(self.mass.as_slice(), self.jacobian.as_slice(), &mut alone);
        alone
    }
}

fn rows_alone<T: Real>(mass: &[T], jacobian: &[T], alone: &mut [T]) {
    let (r, diagonal) = (alone.len(), mass.iter());
    let n = jacobian.len() / r;
    for (levers, mass) in jacobian.chunks_exact(r).zip(diagonal.step_by(n + 1)) {
        for (sum, lever) in alone.iter_mut().zip(levers) {
            if *lever != T::zero() {
                *sum += *lever * *lever / mass.max(T::zero());
            }
        }
    }
}

/// A position with every angle turned by a different amount, and coordinates of which nothing
/// tells what they measure moved as many times their size.
fn turn<T: Real>(solver: &dyn Constrained<T>, q: &[T], sample: usize, turned: &mut [T]) {
    turned.copy_from_slice(q);
    let structure = solver.structure();
    let natural = NaturalSizes::measure(structure, q);
    for (j, moved) in turned.iter_mut().enumerate() {
        let size = match structure.kind(j) {
            Some(kind @ (Kind::Angle | Kind::Unknown)) => natural.of(kind).unwrap_or(T::one()),
            Some(Kind::Ratio | Kind::Length) | None => continue,
        };
        *moved += size * T::from_f64(core::f64::consts::TAU * stride(sample, j));
    }
}

/// A number between zero and one, another for each coordinate of each sample.
fn stride(sample: usize, coordinate: usize) -> f64 {
    (STRIDES[0] * sample as f64 + STRIDES[1] * (coordinate * sample) as f64) % 1.0
}

/// The median of the numbers that are finite; infinite if there is none.
fn median<T: Real>(numbers: [T; SAMPLES]) -> T {
    let mut sorted = [T::from_f64(f64::INFINITY); SAMPLES];
    let mut count = 0;
    for number in numbers {
        if number.is_finite() {
            let mut place = count;
            while place > 0 && sorted[place - 1] > number {
                sorted[place] = sorted[place - 1];
                place -= 1;
            }
            sorted[place] = number;
            count += 1;
        }
    }
    sorted[count / 2]
}

compiled_once! {
    fn sampling<T>: fn(&mut dyn Constrained<T>, At<'_, T>, bool, &Workspace<'_, T>) =
        |solver, state, by_form, workspace| sample_sizes(solver, state, by_form, workspace);
}
