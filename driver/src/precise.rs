//! Motions to many more digits than runs have, from a program of their own.
//!
//! In:  questions, to a program that [`serve_precise`]s a mechanism.
//! Out: answers.

use crate::digits::{Around, Changes, Exact, Path, Precise};
use crate::link::Ends;
use crate::serve::listen;
use crate::wire::{Answer, Question, send};
use std::io::{self, Write};
use std::process::{Command, ExitCode};

/// Answers what is asked about a mechanism until nobody asks any more: the whole of a
/// program's `main`.
pub fn serve_precise(mut mechanism: Box<dyn Precise>) -> ExitCode {
    let mut out = io::stdout();
    for question in listen(|_: &Question| {}) {
        let answer = match question {
            Question::Exact(changes, until) => Answer::Exact(mechanism.exact(&changes, until)),
            Question::Path(around) => Answer::Path(mechanism.path(&around)),
        };
        if send(&mut out, &answer).and_then(|()| out.flush()).is_err() {
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// A mechanism in a program of its own.
#[derive(Debug)]
pub struct PreciseLink(Ends);

impl PreciseLink {
    /// Starts a program that [`serve_precise`]s a mechanism.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn start(program: Command) -> io::Result<Self> {
        Ok(Self(Ends::start(program)?))
    }
}

impl Precise for PreciseLink {
    fn exact(&mut self, changes: &Changes, until: f64) -> Result<Exact, String> {
        match self.0.ask(&Question::Exact(changes.clone(), until))? {
            Answer::Exact(exact) => exact,
            Answer::Path(_) => Err(Ends::NONSENSE.to_string()),
        }
    }

    fn path(&mut self, around: &Around) -> Result<Path, String> {
        match self.0.ask(&Question::Path(around.clone()))? {
            Answer::Path(path) => path,
            Answer::Exact(_) => Err(Ends::NONSENSE.to_string()),
        }
    }
}
