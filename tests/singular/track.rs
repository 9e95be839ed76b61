//! A run, recorded.
//!
//! In:  a mechanism, its start, options.
//! Out: [`Track`]: the rows that were kept, and what its invariants are off by.
//!
//! Functions here take a mechanism as an object, so that they are compiled once for each
//! pair of sizes.

use crate::trial::Trial;
use bricard_runtime::{
    Audit, DynamicsError, Interface, Mechanism, Observer, Options, OtherBranch, Position, Probe,
    State, Step, StepControl, Visitor, Whole, assemble, simulate,
};
use std::ops::ControlFlow;

/// Outputs that a description may have; all of them are zero on the right motion, those of
/// a reduction are coordinates and velocities.
pub const OUTPUTS: usize = 18;
/// Fractions of a step at which rows inside it are taken.
const INSIDE: [f64; 2] = [0.3, 0.7];

/// The rows of a run: time, coordinates, velocities.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// How many coordinates there are.
    pub n: usize,
    /// Times (s), ascending.
    pub times: Vec<f64>,
    /// Coordinates and velocities of each row.
    pub numbers: Vec<f64>,
}

impl Rows {
    /// Coordinates and velocities of a row.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.numbers[2 * self.n * i..2 * self.n * (i + 1)]
    }

    fn push<const N: usize>(&mut self, state: &State<f64, N>) {
        self.n = N;
        self.times.push(state.t);
        self.numbers.extend(state.q.iter().chain(state.v.iter()));
    }
}

/// What a run came to.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// Its rows, if they were wanted; at least the first and the last.
    pub rows: Rows,
    /// The largest invariant, and when.
    pub off: (f64, f64),
    /// The largest error of a constraint, in its own unit.
    pub residual: f64,
    /// The largest change of a conserved energy (J).
    pub energy: f64,
    /// The size of the energy at the start (J).
    pub size: f64,
    /// The error it ended in.
    pub failed: Option<String>,
    /// Passages that it reported.
    pub passages: Option<u64>,
    /// Accepted steps.
    pub steps: u64,
}

/// Looks at every row.
struct Watch<'a, const N: usize, const R: usize> {
    mechanism: &'a dyn Whole<f64, N, R>,
    track: Track,
    conserved: Option<f64>,
    keep: bool,
    position: Box<Position<f64, N, R>>,
}

impl<const N: usize, const R: usize> Watch<'_, N, R> {
    fn look(&mut self, state: &State<f64, N>) {
        let mut values = [0.0; OUTPUTS];
        self.mechanism.outputs(state, &mut values);
        let worst = values.iter().fold(0.0, |worst, x| larger(worst, x.abs()));
        if exceeds(worst, self.track.off.0) {
            self.track.off = (worst, state.t);
        }
        self.mechanism.position(state, &mut self.position);
        for residual in self.position.residual.iter() {
            self.track.residual = larger(self.track.residual, residual.abs());
        }
        if let Some(before) = self.conserved {
            let change = self.mechanism.energy(state).balance - before;
            self.track.energy = larger(self.track.energy, change.abs());
        }
        if self.keep {
            self.track.rows.push(state);
        }
    }
}

/// Whether a size is larger than another, or not a number at all.
pub fn exceeds(a: f64, b: f64) -> bool {
    a > b || a.is_nan()
}

/// The larger of two sizes; what is not a number stays.
pub fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

impl<const N: usize, const R: usize> Observer<f64, N> for Watch<'_, N, R> {
    fn begin(
        &mut self,
        state: &State<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let energy = self.mechanism.energy(state);
        self.track.size = energy.kinetic + energy.potential.abs();
        let conservative = self.mechanism.structure().conservative;
        self.conserved = conservative.then_some(energy.balance);
        self.look(state);
        Ok(ControlFlow::Continue(()))
    }

    fn step(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        for part in INSIDE {
            let mut inside = step.at(step.start().t + part * step.length());
            probe.project(&mut inside, OtherBranch::Refused)?;
            self.look(&inside);
        }
        self.look(step.end());
        Ok(ControlFlow::Continue(()))
    }
}

/// Runs a mechanism from its start.
pub fn play<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    options: &Options<f64>,
    keep: bool,
) -> Track {
    let mut track = Track::default();
    track.rows.n = N;
    let start = match assemble(mechanism, &mechanism.start(), 0.0) {
        Ok(start) => start,
        Err(error) => {
            track.failed = Some(format!("refused: {error}"));
            return track;
        }
    };
    let mut watch = Watch {
        mechanism,
        track,
        conserved: None,
        keep,
        position: Box::default(),
    };
    let ran = simulate(mechanism, &start, options, &mut [&mut watch]);
    let mut track = watch.track;
    let summary = match ran {
        Ok(summary) => summary,
        Err(failure) => {
            track.failed = Some(failure.error.to_string());
            failure.summary
        }
    };
    (track.passages, track.steps) = (summary.passages, summary.steps);
    track
}

/// Runs a described mechanism as a trial says.
struct Described<'a>(&'a Trial);

impl Visitor<f64> for Described<'_> {
    type Output = Track;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> Track
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let trial = self.0;
        let parameters = mechanism.structure().parameters;
        for (name, value) in &trial.set {
            let place = parameters.iter().position(|p| p.name == *name);
            let place = place.unwrap_or_else(|| panic!("no parameter {name}"));
            mechanism.set_parameter(place, *value);
        }
        play::<N, R>(&mechanism, &options(trial), trial.keeps_rows())
    }
}

/// Runs a trial.
pub fn run(trial: &Trial) -> Track {
    if let Some(planted) = &trial.planted {
        return planted.run(&options(trial));
    }
    let visited = crate::descriptions::visit(trial.mechanism, Described(trial));
    visited.unwrap_or_else(|| panic!("{} is in no catalogue", trial.mechanism))
}

/// Steps after which a run is given up.
const MOST_STEPS: u64 = 1_000_000;

/// How a trial is run: what it audits itself is not audited twice.
fn options(trial: &Trial) -> Options<f64> {
    let steps = match trial.step {
        Some(step) => StepControl::Fixed { step },
        None => StepControl::Adaptive {
            relative: trial.tolerance,
            absolute: trial.tolerance,
        },
    };
    let mut options = Options::new(trial.until, trial.method, steps);
    options.most_steps = Some(MOST_STEPS);
    options.audit = Audit {
        passages: trial.passages.is_some(),
        ..Audit::NONE
    };
    options
}
