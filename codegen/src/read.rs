//! The text of a description.
//!
//! In:  a file.
//! Out: its text, or what the system says; of a file in another encoding the place where that
//!      shows.

use crate::diagnostic::{Position, without_mark};
use std::fmt;
use std::fs;
use std::io;
use std::path::Path;

/// A text in another encoding.
#[derive(Debug)]
pub struct NotUtf8 {
    /// Where that shows.
    pub place: Position,
}

impl NotUtf8 {
    /// What to do about it.
    pub const HELP: &str = "save the file as UTF-8";

    /// The place behind the part of a text that can be read.
    fn behind(before: &str) -> Self {
        let before = without_mark(before);
        let line = before.rsplit('\n').next().unwrap_or("");
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let place = Position {
            line: count(before.matches('\n').count() + 1),
            column: count(line.chars().count() + 1),
            offset: count(before.len()),
        };
        Self { place }
    }
}

impl fmt::Display for NotUtf8 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Position { line, column, .. } = self.place;
        let help = Self::HELP;
        write!(f, "line {line} is not UTF-8 at column {column}; {help}")
    }
}

impl std::error::Error for NotUtf8 {}

/// The text of a description.
///
/// # Errors
///
/// What the system says, or [`NotUtf8`].
pub fn read_description(description: &Path) -> io::Result<String> {
    String::from_utf8(fs::read(description)?).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = error.as_bytes().get(..valid).unwrap_or(&[]);
        let fault = NotUtf8::behind(&String::from_utf8_lossy(before));
        io::Error::new(io::ErrorKind::InvalidData, fault)
    })
}
