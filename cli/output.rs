//! Text and rows that leave the program.
//!
//! In:  text, rows of numbers.
//! Out: standard output, standard error, CSV files.

use crate::checkpoint::Rows;
use crate::error::CommandError;
use crate::number::exact;
use anstyle::AnsiColor;
use csv::{ErrorKind, Writer};
use std::ffi::OsStr;
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process;

/// What messages call standard output.
const STANDARD_OUTPUT: &str = "standard output";

/// Prints text to standard output.
///
/// # Errors
///
/// [`CommandError::NobodyReads`] if the reader has gone, and
/// [`CommandError::Write`] for everything else.
pub fn print(text: &str) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.map_err(|error| CommandError::write(Path::new(STANDARD_OUTPUT), error))
}

/// Prints a line to standard error. A standard error that nobody reads is no
/// reason to stop.
pub fn say(line: &str) {
    let _unread = writeln!(io::stderr().lock(), "{line}");
}

/// Prints an error to standard error, in colour on a terminal unless `NO_COLOR` is set.
pub fn complain(error: &dyn Display) {
    let red = AnsiColor::Red.on_default().bold();
    let _unread = writeln!(anstream::stderr().lock(), "{red}error:{red:#} {error}");
}

/// Writes a whole file.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn write(path: &Path, text: &str) -> Result<(), CommandError> {
    fs::write(path, text).map_err(|error| CommandError::write(path, error))
}

/// Writes a whole file in place of what bears its name, all at once. What is no file, such
/// as a pipe, is written to.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    let failed = |error| CommandError::write(path, error);
    // A link stays one.
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    if place.exists() && !place.is_file() {
        return fs::write(&place, bytes).map_err(failed);
    }
    let beside = beside(&place);
    let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, &place));
    if written.is_err() {
        let _nothing_left = fs::remove_file(&beside);
    }
    written.map_err(failed)
}

/// A name beside a file that nobody else uses.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or(OsStr::new("file"));
    let name = format!(".{}.{}", name.to_string_lossy(), process::id());
    path.with_file_name(name)
}

/// Finds out whether a file can be written, before anything is computed for it.
/// What it holds stays as it is until there is something to write.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn probe(path: &Path) -> Result<(), CommandError> {
    let failed = |error| CommandError::write(path, error);
    let is_new = !path.exists();
    File::options()
        .append(true)
        .create(true)
        .open(path)
        .map_err(failed)?;
    if is_new {
        fs::remove_file(path).map_err(failed)
    } else {
        Ok(())
    }
}

/// Rows of numbers on their way to a CSV file or to standard output.
pub struct CsvWriter {
    path: Option<PathBuf>,
    /// Opened when the first row comes, so that a run that can't begin harms no
    /// file of the same name.
    out: Option<Writer<Box<dyn Write>>>,
    header: Vec<String>,
    rows: usize,
    /// The length at which rows are added to a file.
    tail: Option<u64>,
}

impl CsvWriter {
    /// Rows for a file, which is replaced when the first one comes, or for
    /// standard output (`None`, `-`).
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`] if the file can't be written.
    pub fn new(path: Option<&Path>, header: &[String]) -> Result<Self, CommandError> {
        let path = path.filter(|path| *path != Path::new("-"));
        path.map(probe).transpose()?;
        Ok(Self {
            path: path.map(Path::to_path_buf),
            out: None,
            header: header.to_vec(),
            rows: 0,
            tail: None,
        })
    }

    /// Goes on after rows of an earlier part of the run. What a file has after them is
    /// cut off.
    pub fn go_on(&mut self, rows: Rows) {
        self.rows = usize::try_from(rows.count).unwrap_or(usize::MAX);
        self.tail = rows.bytes;
        if self.path.is_none() || rows.bytes.is_some() {
            self.header.clear();
        }
    }

    /// Hands rows over, and says what is there.
    ///
    /// # Errors
    ///
    /// As [`row`](Self::row).
    pub fn settle(&mut self) -> Result<Rows, CommandError> {
        self.finish()?;
        let file = self.path.as_ref().and_then(|path| fs::metadata(path).ok());
        let bytes = file.filter(|file| file.is_file()).map(|file| file.len());
        Ok(Rows {
            count: self.rows as u64,
            bytes,
        })
    }

    /// Writes a row.
    ///
    /// # Errors
    ///
    /// [`CommandError::WriteRows`]; what was written before stays.
    pub fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        let written = self.write(values);
        written.map_err(|error| self.failed(system(error)))?;
        self.rows += 1;
        Ok(())
    }

    fn write(&mut self, values: &[f64]) -> csv::Result<()> {
        let out = match &mut self.out {
            Some(out) => out,
            None => {
                let sink: Box<dyn Write> = match &self.path {
                    Some(path) => Box::new(opened(path, self.tail)?),
                    None => Box::new(io::stdout()),
                };
                let out = self.out.insert(Writer::from_writer(sink));
                if !self.header.is_empty() {
                    out.write_record(&self.header)?;
                }
                out
            }
        };
        out.write_record(values.iter().map(|value| exact(*value)))
    }

    /// Hands the last rows over.
    ///
    /// # Errors
    ///
    /// As [`row`](Self::row).
    pub fn finish(&mut self) -> Result<(), CommandError> {
        let flushed = self.out.as_mut().map_or(Ok(()), |out| out.flush());
        flushed.map_err(|error| self.failed(error))
    }

    fn failed(&self, error: io::Error) -> CommandError {
        CommandError::write_rows(Path::new(&self.destination()), self.rows, error)
    }

    /// Where the rows go, as a message names it.
    pub fn destination(&self) -> String {
        let path = self.path.as_ref().map(|path| path.display().to_string());
        path.unwrap_or_else(|| STANDARD_OUTPUT.to_string())
    }
}

/// A new file, or one that goes on after a length.
fn opened(path: &Path, tail: Option<u64>) -> io::Result<File> {
    let Some(length) = tail else {
        return File::create(path);
    };
    let mut file = File::options().write(true).open(path)?;
    if file.metadata()?.len() < length {
        return Err(io::Error::other("it has lost rows since the checkpoint"));
    }
    file.set_len(length)?;
    file.seek(SeekFrom::End(0))?;
    Ok(file)
}

/// What the system says of a failed row. As an `io::Error` of its own a CSV error
/// would no longer tell a reader that has gone from other causes.
fn system(error: csv::Error) -> io::Error {
    let text = error.to_string();
    match error.into_kind() {
        ErrorKind::Io(error) => error,
        _ => io::Error::other(text),
    }
}

#[cfg(test)]
mod tests {
    use super::exact;

    #[test]
    fn printed_numbers_read_back_to_the_same_bits() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for _ in 0..10_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let value = f64::from_bits(bits);
            if value.is_finite() {
                let read: f64 = exact(value).parse().unwrap_or(f64::NAN);
                assert_eq!(read.to_bits(), value.to_bits(), "{value:?}");
            }
        }
        assert_eq!(exact(-0.0), "-0");
        assert_eq!(exact(4.0), "4");
        assert_eq!(exact(1e-300), "1e-300");
    }
}
