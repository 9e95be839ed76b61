//! A mechanism whose type and sizes are forgotten.
//!
//! In:  a generated mechanism.
//! Out: [`AnyMechanism`], on which commands work.
//!
//! The type of a mechanism is forgotten before anything is done with it, so that
//! the simulation is compiled once for each pair of sizes, not for each mechanism.

use crate::scene::{Scene, scene};
use crate::segment::{Reached, Segment, Watch};
use crate::writer::segment;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Initial, Interface, Mechanism, Options, Settings, Solver, Start, State, Structure, Visitor,
    Whole, assemble, simulate,
};
use std::time::{Duration, Instant};

/// What commands do with a mechanism. What fails says why in words.
pub trait AnyMechanism {
    /// What was known when its code was generated.
    fn structure(&self) -> &'static Structure;
    /// Sets a parameter, by its place.
    fn set_parameter(&mut self, index: usize, value: f64);
    /// Holds an input at a value, by its place.
    fn hold_input(&mut self, index: usize, value: f64);
    /// Gives a coordinate or a velocity at the start.
    fn begin(&mut self, given: Given);
    /// Simulates a part of a run.
    fn segment(&self, segment: &Segment, watch: &mut dyn Watch) -> Result<Reached, String>;
    /// Measures the time of a simulation in which nothing is recorded or audited, from a state
    /// (time, coordinates, velocities) as it is, or from the assembled start.
    fn timed_run(&self, from: Option<&[f64]>, options: &Options<f64>) -> Result<TimedRun, String>;
    /// What can be seen in some rows (time, coordinates, velocities).
    fn scene(&self, rows: &[Vec<f64>]) -> Result<Scene, String>;
    /// The number of independent constraint equations at the assembled start.
    fn rank_at_start(&self) -> Result<usize, String>;
}

/// A run against the clock.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedRun {
    /// The coordinates at its end.
    pub end: Vec<f64>,
    /// Accepted steps.
    pub steps: u64,
    /// Accelerations.
    pub evaluations: u64,
    /// Time it took, without the assembly.
    pub wall: Duration,
}

/// A value given at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// The coordinate, by its place.
    pub coordinate: usize,
    /// Whether it is its velocity that is given.
    pub velocity: bool,
    /// Whether it is held, or a guess.
    pub held: bool,
    /// The value (SI).
    pub value: f64,
}

/// Forgets the types of the mechanisms of a catalogue.
#[derive(Clone, Copy, Debug)]
pub struct EraseType;

impl Visitor<f64> for EraseType {
    type Output = Box<dyn AnyMechanism>;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        erase_type::<N, R>(Box::new(mechanism))
    }
}

/// Forgets the sizes of a mechanism.
pub fn erase_type<const N: usize, const R: usize>(
    mechanism: Box<dyn Whole<f64, N, R>>,
) -> Box<dyn AnyMechanism> {
    Box::new(SizedMechanism {
        mechanism,
        given: Vec::new(),
    })
}

/// A mechanism of `N` coordinates and `R` constraint equations, and what is given
/// for its start.
struct SizedMechanism<const N: usize, const R: usize> {
    mechanism: Box<dyn Whole<f64, N, R>>,
    given: Vec<Given>,
}

impl<const N: usize, const R: usize> SizedMechanism<N, R> {
    /// The `start` block of the description, with what is given instead.
    #[inline(never)]
    fn start(&self) -> Start<f64, N> {
        let mut start = self.mechanism.start();
        for given in &self.given {
            let entries = if given.velocity {
                &mut start.v
            } else {
                &mut start.q
            };
            if let Some(entry) = entries.get_mut(given.coordinate) {
                *entry = Initial {
                    value: given.value,
                    held: given.held,
                };
            }
        }
        start
    }

    /// A state in a row, or the assembled start.
    #[inline(never)]
    fn state(&self, from: Option<&[f64]>) -> Result<State<f64, N>, String> {
        match from {
            Some(row) => Ok(state_of(row)),
            None => assemble(&*self.mechanism, &self.start(), 0.0).map_err(|e| e.to_string()),
        }
    }
}

impl<const N: usize, const R: usize> AnyMechanism for SizedMechanism<N, R> {
    fn structure(&self) -> &'static Structure {
        self.mechanism.structure()
    }

    fn set_parameter(&mut self, index: usize, value: f64) {
        self.mechanism.set_parameter(index, value);
    }

    fn hold_input(&mut self, index: usize, value: f64) {
        self.mechanism.set_input(index, Some(value));
    }

    fn begin(&mut self, given: Given) {
        self.given.push(given);
    }

    fn segment(&self, plan: &Segment, watch: &mut dyn Watch) -> Result<Reached, String> {
        let state = self.state(plan.from.as_deref())?;
        segment(&*self.mechanism, state, plan, watch)
    }

    fn timed_run(&self, from: Option<&[f64]>, options: &Options<f64>) -> Result<TimedRun, String> {
        let start = self.state(from)?;
        let begun = Instant::now();
        let result = simulate(&*self.mechanism, &start, options, &mut []);
        let wall = begun.elapsed();
        let summary = result.map_err(|failure| failure.error.to_string())?;
        Ok(TimedRun {
            end: summary.end.q.as_slice().to_vec(),
            steps: summary.steps,
            evaluations: summary.evaluations,
            wall,
        })
    }

    fn scene(&self, rows: &[Vec<f64>]) -> Result<Scene, String> {
        Ok(scene(&*self.mechanism, rows))
    }

    fn rank_at_start(&self) -> Result<usize, String> {
        if R == 0 {
            return Ok(0);
        }
        let start = assemble(&*self.mechanism, &self.start(), 0.0);
        let start = start.map_err(|error| format!("the start can't be assembled: {error}"))?;
        let mut solver = Solver::new(Settings::default());
        let rank = solver.on(&*self.mechanism).rank(&start);
        rank.map(|decided| decided.rank)
            .map_err(|error| format!("the rank at the start can't be decided: {error}"))
    }
}

/// The state in a row: time, coordinates, velocities.
pub fn state_of<const N: usize>(row: &[f64]) -> State<f64, N> {
    let at = |i: usize| row.get(i).copied().unwrap_or(0.0);
    State {
        t: at(0),
        q: SVector::from_fn(|i, _| at(1 + i)),
        v: SVector::from_fn(|i, _| at(1 + N + i)),
    }
}
