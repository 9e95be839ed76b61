//! What is said between a mechanism in a program of its own and whoever started it.

use super::{Wire, record::choices};
use crate::{Around, Changes, Exact, Given, Path, Reached, Scene, Segment, TimedRun};
use bricard_runtime::{Options, Structure};

/// What the mechanism is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// Sets a parameter. Not answered.
    Parameter(usize, f64),
    /// Holds an input. Not answered.
    Input(usize, f64),
    /// Gives a value at the start. Not answered.
    Begin(Given),
    /// Wants any number of [`Reply::Row`] and [`Reply::At`], and [`Reply::Segment`].
    Segment(Segment),
    /// Breaks a part of a run off, which is then answered as it stands.
    Stop,
    /// Wants [`Reply::TimedRun`].
    TimedRun(Option<Vec<f64>>, Options<f64>),
    /// Wants [`Reply::Scene`].
    Scene(Vec<Vec<f64>>),
    /// Wants [`Reply::RankAtStart`].
    RankAtStart,
}

/// What the mechanism answers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Reply {
    /// The first words: what is known of the mechanism.
    Structure(Structure),
    /// A row.
    Row(Vec<f64>),
    /// How far a run has come, and in how many steps since the last time.
    At(f64, u64),
    /// The end of a part of a run.
    Segment(Result<Reached, String>),
    /// The end of a run against the clock.
    TimedRun(Result<TimedRun, String>),
    /// What can be seen in some rows.
    Scene(Result<Scene, String>),
    /// How many constraint equations are independent at the start.
    RankAtStart(Result<usize, String>),
}

/// What a mechanism in numbers of many digits is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Question {
    /// Wants [`Answer::Exact`].
    Exact(Changes, f64),
    /// Wants [`Answer::Path`].
    Path(Around),
}

/// What it answers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Answer {
    /// The end of a motion.
    Exact(Result<Exact, String>),
    /// States around a passage.
    Path(Result<Path, String>),
}

choices! {
    Question { 0 => Exact(changes, until), 1 => Path(around) }
    Answer { 0 => Exact(exact), 1 => Path(path) }
    Request {
        0 => Parameter(place, value), 1 => Input(place, value), 2 => Begin(given),
        3 => Segment(segment), 4 => Stop, 5 => TimedRun(from, options), 6 => Scene(rows),
        7 => RankAtStart
    }
    Reply {
        0 => Structure(structure), 1 => Row(values), 2 => At(time, steps), 3 => Segment(reached),
        4 => TimedRun(timed), 5 => Scene(scene), 6 => RankAtStart(rank)
    }
}
