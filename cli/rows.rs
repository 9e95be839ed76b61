//! Rows of numbers that leave the program, as CSV.
//!
//! In:  rows of numbers.
//! Out: standard output, CSV files. Not here: Parquet.

use crate::checkpoint::Rows;
use crate::error::CommandError;
use crate::number::exact;
use crate::output::{STANDARD_OUTPUT, probe};
use csv::{ErrorKind, Writer};
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Writes rows to a file or to standard output.
pub trait RowWriter {
    /// Writes a row.
    ///
    /// # Errors
    ///
    /// [`CommandError::WriteRows`] where what was written before stays, else
    /// [`CommandError::Write`].
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError>;

    /// Writes what is still to be written.
    ///
    /// # Errors
    ///
    /// As [`row`](Self::row).
    fn finish(&mut self) -> Result<(), CommandError>;

    /// Where the rows go, as a message names it.
    fn destination(&self) -> String;

    /// Goes on after rows of an earlier part of the run. What a file has after them is
    /// cut off. Nothing to do where checkpoints are refused.
    ///
    /// # Errors
    ///
    /// [`CommandError::Checkpoint`] if the file does not hold these rows.
    fn go_on(&mut self, _rows: Rows) -> Result<(), CommandError> {
        Ok(())
    }

    /// Hands rows over, and says what is there.
    ///
    /// # Errors
    ///
    /// As [`row`](Self::row).
    fn flush(&mut self) -> Result<Rows, CommandError> {
        Ok(Rows::default())
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

    fn failed(&self, error: io::Error) -> CommandError {
        CommandError::write_rows(Path::new(&self.destination()), self.rows, error)
    }
}

impl RowWriter for CsvWriter {
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        let written = self.write(values);
        written.map_err(|error| self.failed(system(error)))?;
        self.rows += 1;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), CommandError> {
        let flushed = self.out.as_mut().map_or(Ok(()), |out| out.flush());
        flushed.map_err(|error| self.failed(error))
    }

    fn destination(&self) -> String {
        let path = self.path.as_ref().map(|path| path.display().to_string());
        path.unwrap_or_else(|| STANDARD_OUTPUT.to_string())
    }

    fn go_on(&mut self, rows: Rows) -> Result<(), CommandError> {
        if let (Some(path), Some(length)) = (&self.path, rows.bytes) {
            holds(path, &self.header.join(","), length).map_err(|reason| {
                CommandError::Checkpoint {
                    path: path.clone(),
                    reason: format!("{reason}; give the --out of the run that was interrupted"),
                }
            })?;
        }
        self.rows = usize::try_from(rows.count).unwrap_or(usize::MAX);
        self.tail = rows.bytes;
        if self.path.is_none() || rows.bytes.is_some() {
            self.header.clear();
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<Rows, CommandError> {
        self.finish()?;
        let file = self.path.as_ref().and_then(|path| fs::metadata(path).ok());
        let bytes = file.filter(|file| file.is_file()).map(|file| file.len());
        Ok(Rows {
            count: self.rows as u64,
            bytes,
        })
    }
}

/// Whether a file begins with a header, and has the end of a row at a length.
fn holds(path: &Path, header: &str, length: u64) -> Result<(), String> {
    let mut file = File::open(path).map_err(|error| error.to_string())?;
    let lost = |_| "it has lost rows since the checkpoint".to_string();
    let mut start = vec![0; header.len() + 1];
    let other = || "it does not hold the rows of this run".to_string();
    file.read_exact(&mut start).map_err(|_| other())?;
    let mut end = [0];
    let place = SeekFrom::Start(length.saturating_sub(1));
    file.seek(place).map_err(|error| error.to_string())?;
    file.read_exact(&mut end).map_err(lost)?;
    match start == format!("{header}\n").as_bytes() && end == *b"\n" {
        true => Ok(()),
        false => Err(other()),
    }
}

/// A new file, or one that goes on after a length.
fn opened(path: &Path, tail: Option<u64>) -> io::Result<File> {
    let Some(length) = tail else {
        return File::create(path);
    };
    let mut file = File::options().write(true).open(path)?;
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
