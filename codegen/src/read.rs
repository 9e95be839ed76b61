//! The text of a file that a user wrote.
//!
//! In:  a file.
//! Out: its text, or what the system says; of a file in another encoding the place where that
//!      shows.

use crate::diagnostic::{Position, without_mark};
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
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

/// Bytes that a file has at most: a hundred times as many as any table needs. Devices never end.
const MOST: u64 = 1 << 28;

/// The text of a description, or of a file beside one.
///
/// # Errors
///
/// What the system says, or [`NotUtf8`]; that a file is too large for either.
pub fn read_text(file: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    let read = File::open(file)?.take(MOST + 1).read_to_end(&mut bytes)?;
    if read as u64 > MOST {
        let message = format!("it is larger than {} MiB", MOST >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = error.as_bytes().get(..valid).unwrap_or(&[]);
        let fault = NotUtf8::behind(&String::from_utf8_lossy(before));
        io::Error::new(io::ErrorKind::InvalidData, fault)
    })
}
