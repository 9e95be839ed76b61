//! Runs of the library's mechanisms from their own start, and exact ends of runs.

use crate::library::{Inspect, inspect};
use bricard_runtime::{
    ConstraintError, Counters, DynamicsError, Observer, Options, Passage, Probe, SimulateError,
    Step, Whole, assemble, simulate,
};
use std::ops::ControlFlow;

/// Ends of the paper's runs.
const ENDS: &str = include_str!("reference/end_values.csv");

/// What came out of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub passages: Vec<Passage<f64>>,
    pub constraint_error: ConstraintError<f64>,
    pub energy_error: f64,
    pub counters: Counters,
    pub error: Option<SimulateError<f64>>,
    /// The largest `|q_i − q_j|` of coordinates that should stay equal.
    pub apart: f64,
}

/// An exact state of the first coordinate.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub q1: f64,
    pub dq1: f64,
}

/// The exact end of a run.
pub fn end(mechanism: &str, t: f64) -> End {
    let rows = ENDS.lines().filter(|line| !line.starts_with('#')).skip(1);
    for row in rows {
        let mut fields = row.split(',');
        if fields.next() != Some(mechanism) {
            continue;
        }
        let numbers: Vec<f64> = fields.map(|x| x.parse().expect("a number")).collect();
        if numbers[0] == t {
            return End {
                q1: numbers[1],
                dq1: numbers[2],
            };
        }
    }
    panic!("no reference for {mechanism} at {t} s");
}

/// Runs a mechanism of the library with its default parameters.
pub fn run(name: &str, options: &Options<f64>) -> Outcome {
    run_comparing(name, options, &[])
}

/// Runs a mechanism, and watches coordinates that should stay equal.
pub fn run_comparing(name: &str, options: &Options<f64>, equal: &[usize]) -> Outcome {
    inspect(name, Run { options, equal })
}

struct Run<'a> {
    options: &'a Options<f64>,
    equal: &'a [usize],
}

impl Inspect<f64> for Run<'_> {
    type Output = Outcome;

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> Outcome {
        let mechanism = &*mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        let mut watch = Watch {
            equal: self.equal,
            passages: Vec::new(),
            apart: 0.0,
        };
        let result = simulate(mechanism, &start, self.options, &mut [&mut watch]);
        let (summary, error) = match result {
            Ok(summary) => (summary, None),
            Err(failure) => (failure.summary, Some(failure.error)),
        };
        Outcome {
            t: summary.end.t,
            q: summary.end.q.as_slice().to_vec(),
            v: summary.end.v.as_slice().to_vec(),
            passages: watch.passages,
            constraint_error: summary.constraint_error.unwrap_or_default(),
            energy_error: summary.energy_error.unwrap_or(f64::NAN),
            counters: summary.counters,
            error,
            apart: watch.apart,
        }
    }
}

struct Watch<'a> {
    equal: &'a [usize],
    passages: Vec<Passage<f64>>,
    apart: f64,
}

impl<const N: usize> Observer<f64, N> for Watch<'_> {
    fn step(
        &mut self,
        step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        for pair in self.equal.windows(2) {
            let difference = step.end().q[pair[0]] - step.end().q[pair[1]];
            self.apart = self.apart.max(difference.abs());
        }
        Ok(ControlFlow::Continue(()))
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.passages.push(*passage);
        ControlFlow::Continue(())
    }
}
