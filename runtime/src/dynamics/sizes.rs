//! How large the rows of `A` are away from singular positions.
//!
//! In:  the first state of a motion.
//! Out: reference sizes, also if the motion begins exactly in a singular position,
//!      where rows of `A` vanish; whether the mass matrix is definite anywhere, and
//!      whether the masses that a row connects are of similar size.
//!
//! The rows are evaluated with all angles turned to other values. Angles are
//! known by their unit. A coordinate whose unit is not given may be an angle; then
//! its turning is evidence only for rows that vanish at the first state.

use super::Core;
use super::solver::Source;
use crate::linalg::{column, dot, independent_rows, is_definite, norm, scaled};
use crate::tolerance::{hull, regular, spacing};
use crate::{Mechanism, Position, Quantity, Real, State};
use nalgebra::SMatrix;

/// How many times the angles are turned.
const SAMPLES: usize = 8;
/// Fractional parts of the square and cube root of 2 and such numbers spread
/// evenly when multiplied by integers.
const STRIDES: [f64; 2] = [0.618_033_988_749_894_9, 0.414_213_562_373_095];

/// How much more than usual the masses that a row connects may be coupled for its size to
/// count: the mass matrix may be nearly singular at some positions, where rows are as
/// large as one likes. One that is constant is not.
const UNUSUAL: f64 = 4.0;

/// The squared size of a row.
#[derive(Clone, Copy, Default)]
struct RowSize<T> {
    /// In the metric of the kinetic energy.
    whole: T,
    /// In that of each coordinate alone.
    alone: T,
}

impl<T: Real> RowSize<T> {
    /// How much the coupling of the masses adds; infinite where the row restricts a
    /// coordinate without inertia.
    fn coupling(self) -> T {
        match self.alone.is_finite() {
            true => self.whole / self.alone,
            false => self.alone,
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Takes note of the mean sizes of the rows over some turned positions.
    #[inline(never)]
    pub(super) fn sample_sizes(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) {
        let coordinates = mechanism.structure().coordinates;
        let sure = coordinates.iter().all(|c| !c.unit.is_empty());
        self.sample_mass(mechanism, state);
        let here = self.sizes(mechanism, state);
        if self.rows.are_independent_by_form() {
            // No row vanishes anywhere, so that this state is as good as others.
            for (row, size) in here.iter().enumerate() {
                self.rows.observe(row, size.whole, || size.alone);
            }
            return;
        }
        let mut samples = [[RowSize::default(); R]; SAMPLES];
        for (sample, sizes) in samples.iter_mut().enumerate() {
            *sizes = self.sizes(mechanism, &turned(state, coordinates, sample + 1));
        }
        let constant = mechanism.structure().constant_mass && self.metric.is_mass_matrix();
        for row in 0..R {
            let of_row: [RowSize<T>; SAMPLES] = column(|sample| samples[sample][row]);
            if !constant {
                let coupling = median(column(|sample| of_row[sample].coupling()));
                self.rows
                    .expect_coupling(row, coupling * T::from_f64(UNUSUAL));
            }
            let mean = |part: fn(&RowSize<T>) -> T| {
                let sum = of_row.iter().fold(T::zero(), |sum, size| sum + part(size));
                sum / T::from_f64(SAMPLES as f64)
            };
            let (whole, alone) = (mean(|size| size.whole), mean(|size| size.alone));
            let vanishes = here[row].whole <= regular::<T>() * regular::<T>() * whole;
            self.rows.observe(row, here[row].whole, || here[row].alone);
            if sure || vanishes {
                self.rows.observe(row, whole, || alone);
            }
        }
    }

    /// Finds out whether the mass matrix is a metric at any turned position, and one in
    /// which the rows can be told apart.
    #[inline(never)]
    fn sample_mass(&mut self, mechanism: &dyn Mechanism<T, N, R>, state: &State<T, N>) {
        let coordinates = mechanism.structure().coordinates;
        let named = mechanism.structure().weighed;
        self.metric.begin(named);
        let mut definite = !named.is_empty();
        let mut levers = SMatrix::<T, R, N>::zeros();
        for sample in 1..=SAMPLES {
            let turned = turned(state, coordinates, sample);
            mechanism.position(&turned, &mut self.position);
            self.metric.observe(&self.position.mass);
            definite = definite || is_definite(&self.position.mass);
            for (most, entry) in levers.iter_mut().zip(&self.position.jacobian) {
                let square = *entry * *entry;
                if square > *most && square.is_finite() {
                    *most = square;
                }
            }
        }
        let mut uneven = self.rows.weigh_unevenly(&levers, self.metric.inertia());
        let mut apart = |sample| {
            mechanism.position(&turned(state, coordinates, sample), &mut self.position);
            self.rows_are_apart()
        };
        if uneven && (1..=SAMPLES).all(&mut apart) {
            self.rows.weigh_evenly();
            uneven = false;
        }
        if !definite || uneven {
            self.metric.augment();
        }
    }

    /// Whether the masses let all rows at the position in the buffer be told apart: by sines
    /// as they are beyond the reach of any singular configuration.
    #[inline(never)]
    fn rows_are_apart(&mut self) -> bool {
        let Position { mass, jacobian, .. } = &self.position;
        if self.metric.factor.factorise(mass).is_err() {
            return false;
        }
        let mut vectors: SMatrix<T, N, R> = SMatrix::zeros();
        for (row, vector) in vectors.data.0.iter_mut().enumerate() {
            let lifted = self.metric.lift(jacobian, row);
            *vector = scaled(T::one() / norm(&lifted), &lifted);
        }
        independent_rows(
            &mut vectors,
            R,
            &|_| true,
            spacing::<T>() * hull(5),
            &mut [0; R],
        ) == R
    }

    /// The sizes of all rows at a position; zero where they are not finite or have no
    /// metric.
    #[inline(never)]
    fn sizes(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> [RowSize<T>; R] {
        let mut sizes = [RowSize::default(); R];
        mechanism.position(state, &mut self.position);
        let t = state.t;
        if self
            .factorise_metric(mechanism, Source::Position, t)
            .is_ok()
        {
            let alone = self.position.rows_alone();
            for (row, size) in sizes.iter_mut().enumerate() {
                let vector = self.metric.lift(&self.position.jacobian, row);
                let square = dot(&vector, &vector);
                if square.is_finite() {
                    *size = RowSize {
                        whole: square,
                        alone: alone[row],
                    };
                }
            }
        }
        sizes
    }
}

impl<T: Real, const N: usize, const R: usize> Position<T, N, R> {
    /// The squared sizes of the rows in the metric of each coordinate alone, `Σ aⱼ²/mⱼⱼ`;
    /// infinite for one that restricts a coordinate without inertia.
    pub(super) fn rows_alone(&self) -> [T; R] {
        let mut alone = [T::zero(); R];
        for (j, levers) in self.jacobian.data.0.iter().enumerate() {
            let mass = self.mass[(j, j)].max(T::zero());
            for (sum, lever) in alone.iter_mut().zip(levers) {
                if *lever != T::zero() {
                    *sum += *lever * *lever / mass;
                }
            }
        }
        alone
    }
}

/// The state with every angle turned by a different amount.
fn turned<T: Real, const N: usize>(
    state: &State<T, N>,
    coordinates: &[Quantity],
    sample: usize,
) -> State<T, N> {
    let mut turned = *state;
    for (j, coordinate) in coordinates.iter().enumerate().take(N) {
        if coordinate.may_be_angle() {
            let share = STRIDES[0] * sample as f64 + STRIDES[1] * (j * sample) as f64;
            turned.q[j] += T::from_f64(core::f64::consts::TAU * (share % 1.0));
        }
    }
    turned
}

/// The median of the numbers that are finite; infinite if there is none.
#[inline(never)]
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
