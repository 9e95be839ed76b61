//! Text and rows that leave the program.
//!
//! In:  text, rows of numbers.
//! Out: standard output, standard error, CSV files.

use crate::error::CommandError;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

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

/// Finds out whether a file can be written, before anything is computed for it.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn probe(path: &Path) -> Result<(), CommandError> {
    let opened = File::options().append(true).create(true).open(path);
    opened
        .map(|_| ())
        .map_err(|error| CommandError::write(path, error))
}

/// What messages call standard output.
const STANDARD_OUTPUT: &str = "standard output";

/// Rows of numbers on their way to a CSV file.
pub struct CsvWriter {
    out: Box<dyn Write>,
    path: PathBuf,
    rows: usize,
    line: String,
}

impl CsvWriter {
    /// Opens a file, which is emptied, or standard output for `None` and `-`,
    /// and writes the header.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn create(path: Option<&Path>, header: &[String]) -> Result<Self, CommandError> {
        let path = path.filter(|path| *path != Path::new("-"));
        let (out, path): (Box<dyn Write>, PathBuf) = match path {
            Some(path) => {
                let file = File::create(path).map_err(|error| CommandError::write(path, error))?;
                (Box::new(BufWriter::new(file)), path.to_path_buf())
            }
            None => (
                Box::new(BufWriter::new(io::stdout())),
                PathBuf::from(STANDARD_OUTPUT),
            ),
        };
        let mut writer = Self {
            out,
            path,
            rows: 0,
            line: header.join(","),
        };
        writer.end_line()?;
        Ok(writer)
    }

    /// Writes a row.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`]; what was written before stays.
    pub fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        for (i, value) in values.iter().enumerate() {
            if i > 0 {
                self.line.push(',');
            }
            self.line.push_str(&exact(*value));
        }
        self.end_line()?;
        self.rows += 1;
        Ok(())
    }

    /// Hands the last rows over. Returns how many there are.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn finish(&mut self) -> Result<usize, CommandError> {
        self.out.flush().map_err(|error| self.failed(error))?;
        Ok(self.rows)
    }

    fn end_line(&mut self) -> Result<(), CommandError> {
        self.line.push('\n');
        let written = self.out.write_all(self.line.as_bytes());
        self.line.clear();
        written.map_err(|error| self.failed(error))
    }

    fn failed(&self, error: io::Error) -> CommandError {
        CommandError::write_rows(&self.path, self.rows, error)
    }

    /// Where the rows go, as a message names it.
    pub fn destination(&self) -> String {
        self.path.display().to_string()
    }
}

/// A number in the fewest digits that read back to the same bits.
pub fn exact(value: f64) -> String {
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_string(),
        None => text,
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
