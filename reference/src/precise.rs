//! A mechanism whose sizes are forgotten, in numbers of 106 bits.
//!
//! In:  what the driver asks about a motion.
//! Out: states, rounded.

use crate::{DoubleDouble, reference_from, states_at};
use bricard_driver::{Around, Changes, Exact, Given, Path, Precise};
use bricard_runtime::{Initial, Real, Settings, Solver, State, Whole, assemble};

/// How long before the passage the search for it begins (s).
const BEFORE: f64 = 1e-3;
/// Distances in time from the guess at which the constraints are looked at (s): each
/// time the guess is good to about the square of the last one.
const BRACKETS: [f64; 3] = [1e-4, 1e-8, 1e-12];

/// Forgets the sizes of a mechanism.
pub fn precise<const N: usize, const R: usize>(
    mut mechanism: Box<dyn Whole<DoubleDouble, N, R>>,
) -> Box<dyn Precise> {
    // Runs in `f64` have parameters that are rounded.
    for index in 0..mechanism.structure().parameters.len() {
        if let Some(value) = mechanism.parameter(index) {
            mechanism.set_parameter(index, DoubleDouble::from_f64(value.to_f64()));
        }
    }
    Box::new(Wide(mechanism))
}

struct Wide<const N: usize, const R: usize>(Box<dyn Whole<DoubleDouble, N, R>>);

impl<const N: usize, const R: usize> Precise for Wide<N, R> {
    fn exact(&mut self, changes: &Changes, until: f64) -> Result<Exact, String> {
        let wide = DoubleDouble::from_f64;
        for (index, value) in &changes.parameters {
            self.0.set_parameter(*index, wide(*value));
        }
        for (index, value) in &changes.inputs {
            self.0.set_input(*index, Some(wide(*value)));
        }
        exact(&*self.0, &changes.given, until)
    }

    fn path(&mut self, around: &Around) -> Result<Path, String> {
        path(&*self.0, around)
    }
}

fn exact<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    given: &[Given],
    until: f64,
) -> Result<Exact, String> {
    let mut start = mechanism.start();
    for given in given {
        let entries = if given.velocity {
            &mut start.v
        } else {
            &mut start.q
        };
        if let Some(entry) = entries.get_mut(given.coordinate) {
            let (value, held) = (DoubleDouble::from_f64(given.value), given.held);
            *entry = Initial { value, held };
        }
    }
    let until = DoubleDouble::from_f64(until);
    let reference = reference_from(mechanism, &start, until).map_err(|error| error.to_string())?;
    Ok(Exact {
        end: reference.end.q.iter().map(|x| x.to_f64()).collect(),
        error: reference.error,
    })
}

fn path<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    around: &Around,
) -> Result<Path, String> {
    let number = DoubleDouble::from_f64;
    let start =
        assemble(mechanism, &mechanism.start(), number(0.0)).map_err(|error| error.to_string())?;
    let passage = passage(mechanism, &start, around.about)?;
    let there = one(mechanism, &start, passage)?;
    let speed = there.v.iter().map(|v| v.to_f64().abs());
    let times: Vec<DoubleDouble> = around
        .times(speed.fold(0.0, Real::max))
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

fn row<const N: usize>(state: &State<DoubleDouble, N>) -> Vec<f64> {
    let values = state.q.iter().chain(state.v.iter()).map(|x| x.to_f64());
    core::iter::once(state.t.to_f64()).chain(values).collect()
}
