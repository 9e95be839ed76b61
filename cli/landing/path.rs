//! The exact motion around a singular position, in numbers of 106 bits.
//!
//! In:  a name, about when a singular position is passed.
//! Out: when exactly, how fast, and states at any times around it.

use crate::number::largest;
use bricard_reference::{DoubleDouble, states_at};
use bricard_runtime::{
    Interface, Mechanism, Real, Settings, Solver, State, Visitor, Whole, assemble,
};

/// How long before the passage the search for it begins (s).
const BEFORE: f64 = 1e-3;
/// Distances in time from the guess at which the constraints are looked at (s): each
/// time the guess is good to about the square of the last one.
const BRACKETS: [f64; 3] = [1e-4, 1e-8, 1e-12];

/// States as rows: time, coordinates, velocities.
pub type Row = Vec<f64>;

/// A passage, and the rows that were asked for around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// When the singular position is passed (s).
    pub passage: f64,
    /// Rows at the times asked for, in their order.
    pub rows: Vec<Row>,
}

/// Follows the motion of a mechanism of the library from its start. `times` says at
/// which times relative to the passage states are wanted (s), in rising order, if the
/// fastest coordinate passes it with a given speed (m/s, rad/s).
///
/// # Errors
///
/// In words: why it could not be followed.
pub fn path(name: &str, about: f64, times: &dyn Fn(f64) -> Vec<f64>) -> Result<Path, String> {
    bricard::visit(name, Follow { about, times })
        .unwrap_or_else(|| Err("there is no such mechanism".to_string()))
}

struct Follow<'a> {
    about: f64,
    times: &'a dyn Fn(f64) -> Vec<f64>,
}

impl Visitor<DoubleDouble> for Follow<'_> {
    type Output = Result<Path, String>;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> Self::Output
    where
        M: Mechanism<DoubleDouble, N, R> + Interface<DoubleDouble, N> + Clone + 'static,
    {
        for index in 0..mechanism.structure().parameters.len() {
            if let Some(value) = mechanism.parameter(index) {
                mechanism.set_parameter(index, DoubleDouble::from_f64(value.to_f64()));
            }
        }
        let mechanism: Box<dyn Whole<DoubleDouble, N, R>> = Box::new(mechanism);
        follow(&*mechanism, &self)
    }
}

fn follow<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    wanted: &Follow,
) -> Result<Path, String> {
    let number = DoubleDouble::from_f64;
    let start =
        assemble(mechanism, &mechanism.start(), number(0.0)).map_err(|error| error.to_string())?;
    let passage = passage(mechanism, &start, wanted.about)?;
    let there = one(mechanism, &start, passage)?;
    let speed = largest(there.v.iter().map(|v| v.to_f64()));
    let times: Vec<DoubleDouble> = (wanted.times)(speed)
        .into_iter()
        .map(|time| passage + number(time))
        .collect();
    let states = states_at(mechanism, &start, &times).map_err(|error| error.to_string())?;
    Ok(Path {
        passage: passage.to_f64(),
        rows: states.iter().map(row).collect(),
    })
}

/// When exactly the constraints lose rank: their sine grows linearly on both sides.
fn passage<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    start: &State<DoubleDouble, N>,
    about: f64,
) -> Result<DoubleDouble, String> {
    let number = DoubleDouble::from_f64;
    let near = one(mechanism, start, number(about - BEFORE))?;
    let mut solver: Solver<DoubleDouble, N, R> = Solver::new(Settings::default());
    let mut guess = number(about);
    for bracket in BRACKETS {
        let mut sines = [number(0.0); 2];
        for (sine, sign) in sines.iter_mut().zip([-1.0, 1.0]) {
            let state = one(mechanism, &near, guess + number(sign * bracket))?;
            let mut system = solver.on(mechanism);
            let rank = system.rank(&near).and_then(|_| system.rank(&state));
            *sine = rank.map_err(|error| error.to_string())?.sine;
        }
        let [before, after] = sines;
        guess += number(bracket) * (before - after) / (before + after);
    }
    Ok(guess)
}

/// The state at one time.
fn one<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    start: &State<DoubleDouble, N>,
    time: DoubleDouble,
) -> Result<State<DoubleDouble, N>, String> {
    states_at(mechanism, start, &[time])
        .map_err(|error| error.to_string())?
        .pop()
        .ok_or_else(|| "no state".to_string())
}

fn row<const N: usize>(state: &State<DoubleDouble, N>) -> Row {
    let values = state.q.iter().chain(state.v.iter()).map(|x| x.to_f64());
    core::iter::once(state.t.to_f64()).chain(values).collect()
}
