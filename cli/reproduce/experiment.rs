//! The experiments: what is run, and which bounds hold.

use super::reference::{self, End};
use crate::column::Column;
use crate::error::CommandError;
use crate::mechanism::find;
use crate::number::largest;
use crate::run::{Plan, Report, Stopped, run};
use bricard_driver::AnyMechanism;
use bricard_runtime::{Form, Options};

/// The paper's step (s).
pub const STEP: f64 = 0.01;

/// A run of the paper.
#[derive(Debug)]
pub struct Experiment {
    /// What it is called in tables.
    pub title: &'static str,
    /// The mechanism, by name.
    pub mechanism: &'static str,
    /// Its end (s).
    pub until: f64,
    /// The exact solution at the end.
    pub exact: End,
    /// Bound of the error of q₁ at the end (rad).
    pub angle_bound: f64,
    /// What the paper's figure shows of the constraint errors.
    pub paper_error: &'static str,
    /// Bound of the constraint errors, in the unit of each equation.
    pub constraint_bound: f64,
}

/// All of them.
pub const EXPERIMENTS: [Experiment; 4] = [
    Experiment {
        title: "slider–crank, free, 8 s",
        mechanism: "slider_crank",
        until: 8.0,
        exact: reference::SLIDER_CRANK_8,
        angle_bound: 2e-5,
        paper_error: "1e-14",
        constraint_bound: 1e-14,
    },
    Experiment {
        title: "slider–crank, driven, 8 s",
        mechanism: "slider_crank_driven",
        until: 8.0,
        exact: reference::DRIVEN_8,
        angle_bound: 1e-5,
        paper_error: "1e-14",
        constraint_bound: 1e-13,
    },
    Experiment {
        title: "slider–crank, driven, 20 s",
        mechanism: "slider_crank_driven",
        until: 20.0,
        exact: reference::DRIVEN_20,
        angle_bound: 5e-5,
        paper_error: "1e-13",
        constraint_bound: 1e-13,
    },
    Experiment {
        title: "double four-bar, 8 s",
        mechanism: "double_four_bar",
        until: 8.0,
        exact: reference::DOUBLE_FOUR_BAR_8,
        angle_bound: 2e-5,
        paper_error: "1e-14",
        constraint_bound: 1e-14,
    },
];

/// What a run gave: a row after each step of time, coordinates, velocities, the
/// largest error of a constraint equation and of its rate.
pub struct Outcome {
    /// The experiment.
    pub experiment: &'static Experiment,
    /// Its mechanism.
    pub mechanism: Box<dyn AnyMechanism>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
    /// What was done.
    pub report: Report,
}

impl Outcome {
    /// The number of coordinates.
    pub fn n_coordinates(&self) -> usize {
        self.mechanism.structure().coordinates.len()
    }

    /// The state at the end: q₁ and its velocity.
    pub fn end(&self) -> End {
        let last = self.rows.last().map_or(&[][..], Vec::as_slice);
        let at = |i: usize| last.get(i).copied().unwrap_or(f64::NAN);
        End {
            q1: at(1),
            dq1: at(1 + self.n_coordinates()),
        }
    }

    /// The largest value of the column of constraint errors (0) or of their
    /// rates (1).
    pub fn largest_error(&self, which: usize) -> f64 {
        let column = 1 + 2 * self.n_coordinates() + which;
        largest(self.rows.iter().filter_map(|row| row.get(column).copied()))
    }
}

/// Runs an experiment as the paper did: RK4 with fixed step, positions and
/// velocities projected after each step.
pub fn perform(experiment: &'static Experiment) -> Result<Outcome, CommandError> {
    let mechanism = find(experiment.mechanism)?;
    let plan = plan(experiment, STEP, Form::Reduced);
    let mut rows = Vec::new();
    let report = run(mechanism.as_ref(), &plan, &mut rows).map_err(|stopped| stopped.error)?;
    Ok(Outcome {
        experiment,
        mechanism,
        rows,
        report,
    })
}

/// A failed run, under the name of its experiment.
pub fn named(experiment: &Experiment, stopped: Stopped) -> CommandError {
    match stopped.error {
        CommandError::Run { reason, kept } => CommandError::Run {
            reason: format!("{}: {reason}", experiment.title),
            kept,
        },
        error => error,
    }
}

/// The plan of an experiment with a step (s) and a form of the equations.
pub fn plan(experiment: &Experiment, step: f64, form: Form) -> Plan {
    let mut options = Options::rk4(experiment.until, step);
    options.settings.form = form;
    let columns = vec![Column::ConstraintError, Column::VelocityError];
    Plan::new(options, None, columns)
}
