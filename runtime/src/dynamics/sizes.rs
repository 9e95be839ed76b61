//! How large the rows of `A` are away from singular positions.
//!
//! In:  the first state of a motion.
//! Out: reference sizes, also if the motion begins exactly in a singular position,
//!      where rows of `A` vanish; whether the mass matrix is definite anywhere, and
//!      whether the masses that a row connects are of similar size.
//!
//! The rows are evaluated with all angles turned to other values. Lengths, and coordinates of
//! which nothing tells what they measure, are moved, too; what rows are there is evidence only
//! for those that nearly vanish at the first state, and wherever else they are looked at do not.

use super::erased::Constrained;
use super::rows::RowsView;
use super::singular_values::lift;
use super::{Core, Source};
use crate::equations::At;
use crate::extremum::{VANISHING, is_near_extremum};
use crate::linalg::{Workspace, dot, independent_columns, is_definite, norm, scale};
use crate::natural_size::{Kind, NaturalSizes};
use crate::once::compiled_once;
use crate::projection::violated;
use crate::tolerance::{excusable, hull, regular, spacing};
use crate::{DynamicsError, Mechanism, Position, Real, State};
use core::f64::consts::TAU;

/// How many times the angles are turned.
const SAMPLES: usize = 8;
/// Fractional parts of the square and cube root of 2 and such numbers spread
/// evenly when multiplied by integers.
const STRIDES: [f64; 2] = [0.618_033_988_749_894_9, 0.414_213_562_373_095];

/// How much more than usual the masses that a row connects may be coupled for its size to
/// count: the mass matrix may be nearly singular at some positions, where rows are as
/// large as one likes. A constant mass matrix is not.
const UNUSUAL: f64 = 4.0;

/// Kinds of coordinates.
type Kinds = &'static [Kind];
/// Kinds whose moves leave all sizes as they are by nature.
const ANGLES: Kinds = &[Kind::Angle];
/// Kinds that may be angles.
const MAYBE_ANGLES: Kinds = &[Kind::Angle, Kind::Unknown];
/// Kinds that may be angles, and ratios, of which a few belong together.
const MAYBE_ANGLES_AND_RATIOS: Kinds = &[Kind::Angle, Kind::Unknown, Kind::Ratio];
/// All kinds but ratios.
const ANY: Kinds = &[Kind::Angle, Kind::Unknown, Kind::Length];

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the mean sizes of the rows over some turned positions.
    #[inline(never)]
    pub(super) fn sample_sizes(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) {
        let by_form = self.rows.by_form;
        let (mut solver, workspace, _) = self.lend(mechanism);
        sampling()(&mut solver, state.at(), by_form, &workspace);
    }

    /// Takes note of the sizes of all rows at an accepted state, at which the metric is factorised.
    /// Where they depend on time, one that is zero at the start need not be zero later.
    #[inline(never)]
    pub(super) fn observe_sizes(&mut self, mechanism: &dyn Mechanism<T, N, R>) {
        let (mut solver, workspace, _) = self.lend(mechanism);
        observing()(&mut solver, &workspace);
    }

    /// Takes note of the sizes of rows that were never anything but zero, and refuses an accepted
    /// state that violates one that still is: nothing else would notice it.
    #[inline(never)]
    pub(crate) fn verify_rows_without_size(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        mechanism.position(state, &mut self.position);
        let factorised = self.factorise_metric(mechanism, Source::Position, state.t);
        if factorised.is_ok() {
            self.observe_sizes(mechanism);
        }
        let mut without = (0..R).filter(|row| self.rows.scale[*row] == T::zero());
        let residual = |row: usize| self.position.residual[row].abs();
        let holds = |row: &usize| residual(*row) <= excusable();
        match without.find(|row| !holds(row)) {
            Some(row) => Err(violated(mechanism, state, (row, residual(row)))),
            None => Ok(()),
        }
    }
}

/// The squared sizes of rows, one position after the other.
struct Sizes<'a, T> {
    /// In the metric of the kinetic energy.
    whole: &'a mut [T],
    /// In the metric of each coordinate alone.
    alone: &'a mut [T],
}

impl<'a, T: Real> Sizes<'a, T> {
    /// Room for so many sizes.
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

    /// Measures all rows at positions to which coordinates of some kinds are moved.
    fn sample(
        &mut self,
        solver: &mut dyn Constrained<T>,
        state: At<'_, T>,
        kinds: Kinds,
        workspace: &Workspace<'_, T>,
    ) {
        let r = solver.known().r();
        self.whole.fill(T::zero());
        self.alone.fill(T::zero());
        workspace.scope(|workspace| {
            let moved = workspace.numbers(state.q.len());
            for sample in 0..SAMPLES {
                turn(solver, state.q, (kinds, sample + 1), moved);
                self.measure(solver, (state.t, moved), sample * r, workspace);
            }
        });
    }

    /// The means of a row over all samples.
    fn mean(&self, row: usize, r: usize) -> (T, T) {
        let mean = |sizes: &[T]| {
            let of_row = sizes.iter().skip(row).step_by(r);
            of_row.fold(T::zero(), |sum, size| sum + *size) / T::from_f64(SAMPLES as f64)
        };
        (mean(self.whole), mean(self.alone))
    }

    /// Takes note of the means of a row.
    fn observe(&self, solver: &mut dyn Constrained<T>, row: usize) {
        let (whole, alone) = self.mean(row, solver.known().r());
        solver.learn().rows.observe(row, whole, alone);
    }

    /// Takes note of the sizes of all rows at the first position.
    fn observe_all(&self, rows: &mut RowsView<'_, T>) {
        let sizes = self.whole.iter().zip(&*self.alone);
        for (row, (whole, alone)) in sizes.enumerate() {
            rows.observe(row, *whole, *alone);
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
        if solver.visit(t, q).is_ok() {
            self.measure_here(solver, first, workspace);
        }
    }

    /// The same where the constraints were evaluated last, and the metric is factorised.
    fn measure_here(
        &mut self,
        solver: &mut dyn Constrained<T>,
        first: usize,
        workspace: &Workspace<'_, T>,
    ) {
        solver.learn().metric.observe_pivots();
        workspace.scope(|workspace| {
            let (at, known) = (solver.constraints(), solver.known());
            let r = known.r();
            let (alone, lifted) = (
                workspace.numbers(r),
                workspace.numbers(at.jacobian.len() / r),
            );
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

/// Takes note of the sizes of the rows at a state, and of their mean sizes elsewhere.
pub(super) fn sample_sizes<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    by_form: bool,
    workspace: &Workspace<'_, T>,
) {
    let r = solver.known().r();
    let moved = workspace.numbers(state.q.len());
    workspace.scope(|workspace| sample_mass(solver, state, moved, workspace));
    let mut here = Sizes::new(r, workspace);
    here.measure(solver, (state.t, state.q), 0, workspace);
    let mut rows = solver.learn().rows;
    // If no row vanishes anywhere, this state is as good as others.
    if by_form {
        return here.observe_all(&mut rows);
    }
    let structure = solver.structure();
    let has = |kind| (0..structure.coordinates.len()).any(|j| structure.kind(j) == Some(kind));
    let (unknown, lengths) = (has(Kind::Unknown), has(Kind::Length));
    let mut samples = Sizes::new(r * SAMPLES, workspace);
    samples.sample(solver, state, MAYBE_ANGLES, workspace);
    for row in 0..r {
        expect_coupling(solver, row, &samples);
        let mut rows = solver.learn().rows;
        rows.observe(row, here.whole[row], here.alone[row]);
        let (whole, alone) = samples.mean(row, r);
        if !unknown || here.whole[row] <= regular::<T>() * regular::<T>() * whole {
            rows.observe(row, whole, alone);
        }
    }
    if unknown {
        samples.sample(solver, state, ANGLES, workspace);
        (0..r).for_each(|row| samples.observe(solver, row));
    }
    if unknown || lengths {
        let least = workspace.numbers(r);
        least_sizes(solver, state, least, workspace);
        let bound = T::from_f64(VANISHING * VANISHING);
        let vanishes = |row: &usize| here.alone[*row] < least[*row] * bound;
        if (0..r).any(|row| vanishes(&row)) {
            samples.sample(solver, state, ANY, workspace);
            for row in (0..r).filter(vanishes) {
                if !workspace
                    .scope(|inner| is_near_extremum(solver, (state.t, state.q), row, inner))
                {
                    samples.observe(solver, row);
                }
            }
        }
    }
}

/// The least squared sizes of the rows wherever lengths are moved, in the metric of each
/// coordinate alone.
fn least_sizes<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    least: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    least.fill(T::from_f64(f64::INFINITY));
    workspace.scope(|workspace| {
        let moved = workspace.numbers(state.q.len());
        let alone = workspace.numbers(least.len());
        for sample in 1..=SAMPLES {
            turn(solver, state.q, (ANY, sample), moved);
            solver.locate(state.t, moved);
            let at = solver.constraints();
            alone.fill(T::zero());
            rows_alone(at.mass, at.jacobian, alone);
            for (least, alone) in least.iter_mut().zip(&*alone) {
                *least = least.min(*alone);
            }
        }
    });
}

/// Takes note of how much the masses that a row connects are coupled in samples.
fn expect_coupling<T: Real>(solver: &mut dyn Constrained<T>, row: usize, samples: &Sizes<'_, T>) {
    let r = solver.known().r();
    let constant_mass = solver.structure().constant_mass;
    let mut learning = solver.learn();
    if constant_mass && learning.metric.parts.is_mass_matrix() {
        return;
    }
    let mut couplings = [T::zero(); SAMPLES];
    for (sample, coupling) in couplings.iter_mut().enumerate() {
        *coupling = samples.coupling(sample * r + row);
    }
    let coupling = median(couplings) * T::from_f64(UNUSUAL);
    learning.rows.expect_coupling(row, coupling);
}

/// Finds out whether the mass matrix is a metric at any turned position, and one in
/// which the rows can be told apart.
fn sample_mass<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    turned: &mut [T],
    workspace: &Workspace<'_, T>,
) {
    let structure = solver.structure();
    let named = structure.weighed;
    solver.learn().metric.begin(structure);
    let mut definite = !named.is_empty();
    let levers = workspace.numbers(solver.constraints().jacobian.len());
    for sample in 1..=SAMPLES {
        turn(solver, state.q, (MAYBE_ANGLES, sample), turned);
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
    // Wherever rows take part in the metric they weigh as much as what they connect.
    if !named.is_empty() || !definite {
        observe_ratios(solver, state, turned);
    }
    let mut learning = solver.learn();
    let inertia = &*learning.metric.inertia;
    let mut uneven = learning.rows.weigh_unevenly(levers, inertia, workspace);
    let mut apart = |sample| {
        turn(solver, state.q, (MAYBE_ANGLES, sample), turned);
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
    let natural = NaturalSizes::measure(solver.structure(), state.q);
    if natural.of(Kind::Ratio).is_none() {
        return;
    }
    for sample in 1..=SAMPLES {
        turn(solver, state.q, (MAYBE_ANGLES_AND_RATIOS, sample), moved);
        solver.locate(state.t, moved);
        let mut learning = solver.learn();
        let mass = learning.at.mass;
        learning.metric.observe(mass);
    }
}

/// Whether the metric of the masses tells all rows apart where the constraints were evaluated last:
/// by sines as large as they are far from all singular configurations.
fn rows_are_apart<T: Real>(solver: &mut dyn Constrained<T>, workspace: &Workspace<'_, T>) -> bool {
    if !solver.factorise_mass() {
        return false;
    }
    let (known, jacobian) = (solver.known(), solver.constraints().jacobian);
    let r = known.r();
    let n = jacobian.len() / r;
    // More rows than coordinates can never be told apart.
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
            // A lever may be too small for its square.
            let square = *lever * *lever;
            if square != T::zero() {
                *sum += square / mass.max(T::zero());
            }
        }
    }
}

/// A position with every coordinate of some kinds moved by a different amount: what may be an
/// angle is turned, lengths and ratios are moved by up to the size of their kind.
fn turn<T: Real>(
    solver: &dyn Constrained<T>,
    q: &[T],
    (kinds, sample): (Kinds, usize),
    turned: &mut [T],
) {
    turned.copy_from_slice(q);
    let structure = solver.structure();
    let natural = NaturalSizes::measure(structure, q);
    for (j, moved) in turned.iter_mut().enumerate() {
        let Some(kind) = structure.kind(j).filter(|kind| kinds.contains(kind)) else {
            continue;
        };
        let part = stride(sample, j);
        let maybe_angle = !kinds.contains(&Kind::Length);
        let (by, unless_known) = match kind {
            Kind::Angle => (TAU * part, T::one()),
            Kind::Unknown if maybe_angle => (TAU * part, T::one()),
            // Where nothing tells how long lengths are, they stay.
            _ => (2.0 * part - 1.0, T::zero()),
        };
        *moved += natural.of(kind).unwrap_or(unless_known) * T::from_f64(by);
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

/// Takes note of the sizes of all rows where the constraints were evaluated last.
fn observe_sizes<T: Real>(solver: &mut dyn Constrained<T>, workspace: &Workspace<'_, T>) {
    let r = solver.known().r();
    let mut here = Sizes::new(r, workspace);
    here.measure_here(solver, 0, workspace);
    here.observe_all(&mut solver.learn().rows);
}

compiled_once! {
    fn observing<T>: fn(&mut dyn Constrained<T>, &Workspace<'_, T>) = observe_sizes;

    fn sampling<T>: fn(&mut dyn Constrained<T>, At<'_, T>, bool, &Workspace<'_, T>) =
        sample_sizes;
}
