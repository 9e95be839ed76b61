//! What a run comes to: right, ended in an error with all rows right, or wrong.
//!
//! In:  a [`Trial`].
//! Out: [`Verdict`].

use crate::along;
use crate::exact::{Exact, exact};
use crate::track::{Track, exceeds, larger, run};
use crate::trial::{Compare, Trial};

/// What invariants may be off by, and constraints in their own units.
const INVARIANT: f64 = 1e-5;
/// What a row may be off by: this multiple of the tolerance.
const MULTIPLE: f64 = 1e4;
/// What a row may be off by where motions turn sharply, in short runs: this multiple of the
/// tolerance.
const OF_TURNING: f64 = 300.0;
/// What the references themselves may be off by.
const REFERENCE: f64 = 1e-9;
/// What may move at rest.
const REST: f64 = 1e-9;

/// What a run comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Score {
    /// It reached its end, all rows are right.
    Right,
    /// It ended in an error, all rows that were kept are right.
    Ended,
    /// Anything else.
    Wrong,
}

/// The score of a run and what led to it.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The score.
    pub score: Score,
    /// The largest error of a row beside the exact motion; where there is none, of an
    /// invariant.
    pub error: f64,
    /// The error of the last row.
    pub last: f64,
    /// What is wrong, or the error it ended in.
    pub why: String,
    /// Passages that were reported, and those of the exact motion, where both are known.
    pub passages: Option<(u64, u64)>,
    /// Accepted steps.
    pub steps: u64,
}

impl Verdict {
    /// Wrong without any row: it panicked, or did not end.
    pub fn lost(why: String) -> Self {
        Self {
            score: Score::Wrong,
            error: f64::INFINITY,
            last: f64::INFINITY,
            why,
            passages: None,
            steps: 0,
        }
    }

    /// Whether passages were invented or missed.
    pub fn miscounted(&self) -> bool {
        self.passages.is_some_and(|(found, exact)| found != exact)
    }
}

impl Trial {
    /// Whether single rows are compared.
    pub fn keeps_rows(&self) -> bool {
        self.compare != Compare::Invariants || self.passages.is_some() || !self.held.is_empty()
    }

    /// What a row may be off by: of a run that ended in an error as much as an
    /// invariant, else as much as the tolerance says.
    fn bound(&self, ended: bool) -> f64 {
        let floor = match self.compare {
            Compare::Along => 1e-6,
            Compare::Rest => return REST,
            Compare::Turning(_) => return larger(OF_TURNING * self.tolerance, 1e-6),
            Compare::Reduction(_) | Compare::Invariants if ended => INVARIANT,
            Compare::Reduction(_) | Compare::Invariants => REFERENCE,
        };
        larger(MULTIPLE * self.tolerance, floor)
    }
}

/// Runs a trial and compares.
pub fn judge(trial: &Trial) -> Verdict {
    let track = run(trial);
    let moved = reference(trial, &track);
    verdict(trial, &track, moved.as_ref())
}

/// The exact motion at the rows of a run.
fn reference(trial: &Trial, track: &Track) -> Option<Exact> {
    let (times, n) = (&track.rows.times, track.rows.n);
    if times.is_empty() {
        return None;
    }
    let reduced = |name: &str| match &trial.planted {
        Some(planted) => planted.exact(times),
        None => exact(trial.mechanism, name, &trial.set, n, times),
    };
    match trial.compare {
        Compare::Reduction(name) | Compare::Turning(name) => Some(reduced(name)),
        Compare::Along => Some(along::follow(&trial.set, times)),
        Compare::Rest => Some(Exact {
            numbers: track.rows.row(0).repeat(times.len()),
            crossings: None,
        }),
        Compare::Invariants => trial.passages.map(|name| Exact {
            numbers: Vec::new(),
            ..reduced(name)
        }),
    }
}

/// Holds a run against the exact motion.
pub fn verdict(trial: &Trial, track: &Track, moved: Option<&Exact>) -> Verdict {
    let (error, last, when) = compared(trial, track, moved);
    let crossings = moved.and_then(|exact| exact.crossings);
    let counted = track.failed.is_none() && trial.passages.is_some();
    let passages = track.passages.zip(crossings).filter(|_| counted);
    let wrong = complaint(trial, track, (error, when));
    let (score, why) = match (wrong, &track.failed) {
        (Some(wrong), None) => (Score::Wrong, wrong),
        (Some(wrong), Some(failed)) => (Score::Wrong, format!("{wrong}; then: {failed}")),
        (None, Some(failed)) => (Score::Ended, failed.clone()),
        (None, None) => (Score::Right, String::new()),
    };
    let compared = moved.is_some_and(|exact| !exact.numbers.is_empty());
    Verdict {
        score,
        error: if compared { error } else { track.off.0 },
        last,
        why,
        passages,
        steps: track.steps,
    }
}

/// The largest error of a row, that of the last one, and when the largest occurred.
fn compared(trial: &Trial, track: &Track, moved: Option<&Exact>) -> (f64, f64, f64) {
    let Some(exact) = moved.filter(|exact| !exact.numbers.is_empty()) else {
        return (0.0, 0.0, 0.0);
    };
    let width = 2 * track.rows.n;
    // Along the curve velocities turn within the time in which errors are made; there the
    // energy tells whether they are right.
    let (mut worst, mut last, mut when) = (0.0, 0.0, 0.0);
    for (i, t) in track.rows.times.iter().enumerate() {
        let right = &exact.numbers[width * i..width * (i + 1)];
        let is_last = i + 1 == track.rows.times.len() && track.failed.is_none();
        let seen = match trial.compare {
            Compare::Along => track.rows.n,
            Compare::Turning(_) if !is_last => track.rows.n,
            _ => width,
        };
        let pairs = track.rows.row(i).iter().zip(right).take(seen);
        last = pairs.fold(0.0, |off, (a, b)| {
            larger(off, (a - b).abs() / (1.0 + b.abs()))
        });
        if exceeds(last, worst) {
            (worst, when) = (last, *t);
        }
    }
    (worst, last, when)
}

/// What is wrong with the rows of a run, if anything is.
fn complaint(trial: &Trial, track: &Track, (error, when): (f64, f64)) -> Option<String> {
    let within = |x: f64, bound: f64| x <= bound;
    let energy = larger(INVARIANT, MULTIPLE * trial.tolerance) * (1.0 + track.size);
    if !within(track.residual, INVARIANT) {
        return Some(format!("a constraint is off by {:.1e}", track.residual));
    }
    if !within(track.off.0, INVARIANT) {
        let (off, when) = track.off;
        return Some(format!("an invariant is off by {off:.1e} at t = {when:.4}"));
    }
    if !within(track.energy, energy) {
        return Some(format!("the energy is off by {:.1e} J", track.energy));
    }
    if !within(error, trial.bound(track.failed.is_some())) {
        return Some(format!("off by {error:.1e} at t = {when:.4}"));
    }
    displaced(trial, track)
}

/// Says which held start value was moved, if one was.
fn displaced(trial: &Trial, track: &Track) -> Option<String> {
    track.rows.times.first()?;
    let first = track.rows.row(0);
    let moved = |&&(place, name): &&(usize, &str)| {
        let set = trial.set.iter().find(|(other, _)| *other == name);
        set.is_some_and(|(_, value)| value.to_bits() != first[place].to_bits())
    };
    let (place, name) = trial.held.iter().find(moved)?;
    Some(format!(
        "the held start value {name} became {:e}",
        first[*place]
    ))
}
