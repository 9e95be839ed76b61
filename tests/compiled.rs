//! What the compiled code of a mechanism computes at a state, as plain numbers.

use crate::library::{Derived, Inspect, Point, inspect};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Acceleration, Canvas, Correction, Linearised, Pivots, Position, Real, State, Terms, Whole,
};
use bricard_testkit::Random;
use std::collections::BTreeMap;

/// An entry of an array: its name, row and column.
pub type Place = (&'static str, usize, usize);

/// Everything the functions of a mechanism write at one state.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    pub entries: BTreeMap<Place, f64>,
    /// The smallest ratio of a pivot to its diagonal entry, on the regular path.
    pub regular: f64,
}

/// Asks the compiled code at random points; an input is held where the point says
/// so, or left to its law.
pub struct Ask<'a> {
    pub point: &'a Point,
    pub held: bool,
}

impl Answers {
    pub fn get(&self, place: Place) -> f64 {
        self.entries.get(&place).copied().unwrap_or(0.0)
    }

    pub fn vector(&self, array: &'static str, n: usize) -> Vec<f64> {
        (0..n).map(|row| self.get((array, row, 0))).collect()
    }

    pub fn matrix(&self, array: &'static str, rows: usize, columns: usize) -> Vec<Vec<f64>> {
        let row = |row| {
            (0..columns)
                .map(|column| self.get((array, row, column)))
                .collect()
        };
        (0..rows).map(row).collect()
    }

    fn fill<'b, T: Real>(
        &mut self,
        array: &'static str,
        rows: usize,
        entries: impl IntoIterator<Item = &'b T>,
    ) {
        for (i, entry) in entries.into_iter().enumerate() {
            self.entries
                .insert((array, i % rows, i / rows), entry.to_f64());
        }
    }
}

/// What the compiled code of a mechanism of the library says.
pub fn answers<T: Real>(derived: &Derived, point: &Point, held: bool) -> Answers {
    inspect::<T, _>(&derived.name, Ask { point, held })
}

/// A random point, and the answers there.
pub fn asked(derived: &Derived, seed: u64, held: bool) -> (Point, Answers) {
    let point = derived.point(&mut Random::seeded(seed));
    let answers = answers::<f64>(derived, &point, held);
    (point, answers)
}

impl<T: Real> Inspect<T> for Ask<'_> {
    type Output = Answers;

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<T, N, R>,
    ) -> Answers {
        let Point {
            t,
            q,
            v,
            parameters,
            inputs,
            accelerations,
            multipliers,
            ..
        } = self.point;
        for (i, &value) in parameters.iter().enumerate() {
            assert!(mechanism.set_parameter(i, T::from_f64(value)));
        }
        for (i, &value) in inputs.iter().enumerate() {
            assert!(mechanism.set_input(i, self.held.then(|| T::from_f64(value))));
        }
        let vector = |x: &[f64]| SVector::from_fn(|i, _| T::from_f64(x[i]));
        let row = |x: &[f64]| SVector::from_fn(|i, _| T::from_f64(x[i]));
        let state = State::new(T::from_f64(*t), vector(q), vector(v));
        let mut answers = Answers::default();
        equations(mechanism, &state, &mut answers);
        let given = (vector(accelerations), row(multipliers));
        linearised(mechanism, &state, given, &mut answers);
        interface(mechanism, &state, &mut answers);
        answers
    }
}

fn equations<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Whole<T, N, R>,
    state: &State<T, N>,
    answers: &mut Answers,
) {
    let mut terms = Terms::default();
    mechanism.terms(state, &mut terms);
    answers.fill("mass", N, &terms.mass);
    answers.fill("force", N, &terms.force);
    answers.fill("jacobian", R, &terms.jacobian);
    answers.fill("bias", R, &terms.bias);
    let mut position = Position::default();
    mechanism.position(state, &mut position);
    answers.fill("residual", R, &position.residual);
    answers.fill("drift", R, &position.drift);
    let energy = mechanism.energy(state);
    let energies = [
        energy.kinetic,
        energy.potential,
        energy.balance,
        energy.power,
    ];
    answers.fill("energy", 4, &energies);
    let mut regular = Acceleration::default();
    if mechanism.acceleration(state, &mut regular) {
        answers.fill("acceleration", N, &regular.acceleration);
        answers.regular = smallest(&regular.pivots);
    }
    let mut correction = Correction::default();
    if mechanism.correction(state, &mut correction) {
        answers.fill("correction of q", N, &correction.position);
        answers.fill("correction of v", N, &correction.velocity);
        answers.fill("corrected residual", R, &correction.residual);
        answers.regular = smallest(&correction.pivots).min(answers.regular);
    }
}

fn linearised<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Whole<T, N, R>,
    state: &State<T, N>,
    (acceleration, multiplier): (SVector<T, N>, SVector<T, R>),
    answers: &mut Answers,
) {
    let mut out = Linearised::default();
    assert!(mechanism.linearised(state, &acceleration, &multiplier, &mut out));
    answers.fill("force by q", N, &out.force_by_position);
    answers.fill("force by v", N, &out.force_by_velocity);
    answers.fill("row by q", R, &out.row_by_position);
    answers.fill("row by v", R, &out.row_by_velocity);
}

/// The smallest ratio of a pivot to its diagonal entry; a pivot that is not written
/// is its diagonal entry.
fn smallest<T: Real, const N: usize, const R: usize>(pivots: &Pivots<T, N, R>) -> f64 {
    let masses = pivots.mass_pivots.iter().zip(&pivots.mass_diagonal);
    let rows = pivots.row_pivots.iter().zip(&pivots.row_squares);
    let ratio = |(pivot, whole): (&T, &T)| match whole.to_f64() {
        0.0 => 1.0,
        whole => pivot.to_f64() / whole,
    };
    masses.chain(rows).map(ratio).fold(1.0, f64::min)
}

fn interface<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Whole<T, N, R>,
    state: &State<T, N>,
    answers: &mut Answers,
) {
    let unwritten = [T::from_f64(f64::NAN); 64];
    let mut fill = |array, values: [T; 64]| {
        let written = values.iter().take_while(|x| x.is_finite()).count();
        answers.fill(array, written.max(1), &values[..written]);
    };
    let (mut outputs, mut events) = (unwritten, unwritten);
    mechanism.outputs(state, &mut outputs);
    mechanism.events(state, &mut events);
    fill("outputs", outputs);
    fill("events", events);
    let mut picture = Picture::default();
    mechanism.draw(state, &mut picture);
    answers.fill("draw", picture.0.len().max(1), &picture.0);
    let start = mechanism.start();
    let value = |initial: &bricard_runtime::Initial<T>| initial.value;
    let values: Vec<T> = start.q.iter().chain(&start.v).map(value).collect();
    answers.fill("start", 2 * N, &values);
}

/// The numbers of a picture in the order in which they are drawn.
#[derive(Default)]
struct Picture(Vec<f64>);

impl Picture {
    fn points<T: Real>(&mut self, points: &[[T; 3]]) {
        self.0.extend(points.iter().flatten().map(|x| x.to_f64()));
    }
}

impl<T: Real> Canvas<T> for Picture {
    fn line(&mut self, points: &[[T; 3]]) {
        self.points(points);
    }

    fn circle(&mut self, centre: [T; 3], radius: T) {
        self.points(&[centre]);
        self.0.push(radius.to_f64());
    }

    fn polygon(&mut self, points: &[[T; 3]]) {
        self.points(points);
    }

    fn trace(&mut self, point: [T; 3]) {
        self.points(&[point]);
    }
}
