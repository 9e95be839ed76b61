//! Checkpoints: where a run can be taken up again, to the same bits.
//!
//! In:  a state at the end of a segment and what was done until then.
//! Out: a file, written whole or not at all, and what is read back from it.
//!
//! Not here: what stands in the file ([`text`]).
//!
//! A run with checkpoints is divided into segments of about a thousand steps. Each begins
//! with nothing but a state and the beginning of the run, so that the bits of the next
//! segment do not depend on whether the program was ended in between.

#[cfg(test)]
mod tests;
mod text;

pub use text::{Checkpoint, Rows};

use crate::error::CommandError;
use crate::output::say;
use crate::place::place;
use bricard_runtime::Structure;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What is said of a run that was too short.
pub const NONE: &str = "no checkpoint was written: the first is due after some thousand steps";
/// How often the file is written while the run goes on.
const PERIOD: Duration = Duration::from_secs(5);

/// Which checkpoints a run writes, and which it begins with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checkpoints {
    /// What the run is, a line for each choice: a checkpoint of another one is refused.
    pub run: String,
    /// Where checkpoints go.
    pub file: Option<PathBuf>,
    /// Where the run goes on.
    pub from: Option<Checkpoint>,
}

/// Writes checkpoints, not too often.
#[derive(Debug)]
pub struct CheckpointWriter<'a> {
    checkpoints: &'a Checkpoints,
    written: Instant,
    last: Option<Checkpoint>,
}

impl<'a> CheckpointWriter<'a> {
    /// Nothing written yet; the last checkpoint is what the run begins with, if it does.
    pub fn new(checkpoints: &'a Checkpoints) -> Self {
        Self {
            checkpoints,
            written: Instant::now(),
            last: checkpoints.from.clone(),
        }
    }

    /// Takes a checkpoint, and writes it if the last one is some time ago.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn take(&mut self, checkpoint: Checkpoint) -> Result<(), CommandError> {
        self.last = Some(checkpoint);
        match self.written.elapsed() >= PERIOD {
            true => self.write(),
            false => Ok(()),
        }
    }

    /// Whether the file holds a checkpoint that this run has written, or may have begun with.
    pub fn can_be_resumed(&self) -> bool {
        let file = self.checkpoints.file.as_ref();
        self.last.is_some() && file.is_some_and(|file| file.exists())
    }

    /// Writes the last checkpoint before the end of the run, from which it can go further to
    /// the same bits: the step that ends at its end is none of a longer run.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn end(&mut self) -> Result<(), CommandError> {
        if self.checkpoints.file.is_some() && self.last.is_none() {
            say(NONE);
        }
        self.write()
    }

    /// Writes the last checkpoint that was taken.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn write(&mut self) -> Result<(), CommandError> {
        if let (Some(file), Some(checkpoint)) = (&self.checkpoints.file, &self.last) {
            let text = checkpoint.text(&self.checkpoints.run);
            replace(&place(file), &text).map_err(|error| CommandError::write(file, error))?;
        }
        self.written = Instant::now();
        Ok(())
    }
}

/// Replaces a file as a whole: whoever reads it sees the old text or the new one. What is no
/// file, such as a pipe, is written to.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    if path.exists() && !path.is_file() {
        return fs::write(path, text);
    }
    let mut beside = path.as_os_str().to_owned();
    beside.push(".new");
    let written = File::create(&beside).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.sync_all()
    });
    match written.and_then(|()| fs::rename(&beside, path)) {
        Ok(()) => Ok(()),
        Err(error) => {
            let _not_there = fs::remove_file(&beside);
            Err(error)
        }
    }
}

/// Reads the checkpoint of a run.
///
/// # Errors
///
/// [`CommandError::Read`], and [`CommandError::Checkpoint`] if the file is no checkpoint, or one
/// of another run.
pub fn read(path: &Path, run: &str, structure: &Structure) -> Result<Checkpoint, CommandError> {
    if !path.exists() {
        let hint = "there is no such file; a run writes its first checkpoint after some thousand \
                    steps, when it has taken five seconds, ends or is interrupted";
        let error = io::Error::new(io::ErrorKind::NotFound, hint);
        return Err(CommandError::Read(path.to_path_buf(), error));
    }
    let bytes = fs::read(path).map_err(|error| CommandError::Read(path.to_path_buf(), error))?;
    // What is no text is no checkpoint either.
    let text = String::from_utf8_lossy(&bytes);
    Checkpoint::read(&text, run, structure).map_err(|reason| CommandError::Checkpoint {
        path: path.to_path_buf(),
        reason,
    })
}
