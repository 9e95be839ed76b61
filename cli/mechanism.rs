//! A mechanism of the library, its type and sizes forgotten.
//!
//! In:  a name.
//! Out: [`AnyMechanism`], on which the commands work.
//!
//! The type of a mechanism is forgotten before anything is done with it, so that
//! the simulation is compiled once for each pair of sizes, not for each mechanism.

use crate::error::CommandError;
use crate::plot::Shape;
use crate::run::{Plan, Report, RowSink, Stopped, run};
use crate::show::freedom;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Canvas, Initial, Interface, Mechanism, Options, Settings, Solver, Start, State, Structure,
    Visitor, Whole, assemble, simulate,
};
use std::time::{Duration, Instant};

/// What the commands do with a mechanism.
pub trait AnyMechanism {
    /// What was known when its code was generated.
    fn structure(&self) -> &'static Structure;
    /// Sets a parameter, by its place.
    fn set_parameter(&mut self, index: usize, value: f64);
    /// Holds an input at a value, by its place.
    fn hold_input(&mut self, index: usize, value: f64);
    /// Gives a coordinate or a velocity at the start.
    fn begin(&mut self, given: Given);
    /// In words: rank of the constraints at the start, and what is left free.
    fn freedom(&self) -> String;
    /// Simulates.
    fn run(&self, plan: &Plan, sink: &mut dyn RowSink) -> Result<Report, Stopped>;
    /// Simulates with nothing recorded or audited, against the clock: from a state
    /// (time, coordinates, velocities) as it is, or from the assembled start.
    fn race(&self, from: Option<&[f64]>, options: &Options<f64>) -> Result<Race, String>;
    /// The picture at a state: time, coordinates, velocities.
    fn shapes(&self, row: &[f64]) -> Vec<Shape>;
}

/// A run against the clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Race {
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

/// Finds a mechanism of the library or of the benchmark problems.
///
/// # Errors
///
/// [`CommandError::UnknownName`].
pub fn find(name: &str) -> Result<Box<dyn AnyMechanism>, CommandError> {
    let found = bricard::visit(name, Forget).or_else(|| bricard_benchmarks::visit(name, Forget));
    found.ok_or_else(|| CommandError::UnknownName {
        kind: "mechanism",
        owner: String::new(),
        name: name.to_string(),
        known: names().map(str::to_string).collect(),
    })
}

/// The names that [`find`] knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    let library = bricard::NAMES.iter();
    library.chain(bricard_benchmarks::NAMES).copied()
}

/// The description of a mechanism by its name.
pub fn source(name: &str) -> Option<&'static str> {
    bricard::source(name).or_else(|| bricard_benchmarks::source(name))
}

struct Forget;

impl Visitor<f64> for Forget {
    type Output = Box<dyn AnyMechanism>;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let mechanism: Box<dyn Whole<f64, N, R>> = Box::new(mechanism);
        Box::new(Sized {
            mechanism,
            given: Vec::new(),
        })
    }
}

/// A mechanism of `N` coordinates and `R` constraint equations, and what is given
/// for its start.
struct Sized<const N: usize, const R: usize> {
    mechanism: Box<dyn Whole<f64, N, R>>,
    given: Vec<Given>,
}

impl<const N: usize, const R: usize> Sized<N, R> {
    /// The `start` block of the description, with what is given instead.
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
}

impl<const N: usize, const R: usize> AnyMechanism for Sized<N, R> {
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

    fn freedom(&self) -> String {
        if R == 0 {
            return freedom(N);
        }
        let mechanism: &dyn Whole<f64, N, R> = &*self.mechanism;
        let state = match assemble(mechanism, &self.start(), 0.0) {
            Ok(state) => state,
            Err(error) => return format!("the start can't be assembled: {error}"),
        };
        match Solver::new(Settings::default()).on(mechanism).rank(&state) {
            Ok(rank) => format!(
                "at the start {} of {R} constraint equations are independent: {}",
                rank.rank,
                freedom(N - rank.rank)
            ),
            Err(error) => format!("the rank at the start can't be decided: {error}"),
        }
    }

    fn run(&self, plan: &Plan, sink: &mut dyn RowSink) -> Result<Report, Stopped> {
        run(&*self.mechanism, &self.start(), plan, sink)
    }

    fn race(&self, from: Option<&[f64]>, options: &Options<f64>) -> Result<Race, String> {
        let mechanism: &dyn Whole<f64, N, R> = &*self.mechanism;
        let start = match from {
            Some(row) => state_of(row),
            None => assemble(mechanism, &self.start(), 0.0).map_err(|error| error.to_string())?,
        };
        let begun = Instant::now();
        let result = simulate(mechanism, &start, options, &mut []);
        let wall = begun.elapsed();
        let summary = result.map_err(|failure| failure.error.to_string())?;
        Ok(Race {
            end: summary.end.q.iter().copied().collect(),
            steps: summary.steps,
            evaluations: summary.evaluations,
            wall,
        })
    }

    fn shapes(&self, row: &[f64]) -> Vec<Shape> {
        let state = state_of(row);
        let mut sheet = Sheet::default();
        self.mechanism.draw(&state, &mut sheet);
        sheet.shapes
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

/// Collects the shapes of a picture. What lies in space is seen from the front,
/// a little from the right and from above.
#[derive(Default)]
struct Sheet {
    shapes: Vec<Shape>,
}

/// How far a metre of depth moves a point to the left and down (m).
const DEPTH: [f64; 2] = [-0.35, -0.25];

fn seen([x, y, z]: [f64; 3]) -> [f64; 2] {
    [x + DEPTH[0] * z, y + DEPTH[1] * z]
}

impl Canvas<f64> for Sheet {
    fn line(&mut self, points: &[[f64; 3]]) {
        self.shapes
            .push(Shape::Line(points.iter().copied().map(seen).collect()));
    }

    fn circle(&mut self, centre: [f64; 3], radius: f64) {
        self.shapes.push(Shape::Circle(seen(centre), radius));
    }

    fn polygon(&mut self, points: &[[f64; 3]]) {
        self.shapes
            .push(Shape::Polygon(points.iter().copied().map(seen).collect()));
    }

    fn trace(&mut self, point: [f64; 3]) {
        self.shapes.push(Shape::Trace(seen(point)));
    }
}
