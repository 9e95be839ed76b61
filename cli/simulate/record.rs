//! Where the rows of a run go.
//!
//! In:  rows of numbers.
//! Out: a table in a file or on standard output, and the rows kept for a picture.

use crate::arguments::Simulate;
use crate::checkpoint::{Checkpoint, Rows};
use crate::column::{Column, header};
use crate::error::CommandError;
use crate::files::is_of;
use crate::output::{probe, say};
use crate::parquet;
use crate::rows::{CsvWriter, RowWriter};
use crate::run::RowSink;
use crate::simulate::coarse::Sizes;
use bricard_runtime::Structure;
use std::mem;
use std::path::Path;

/// What writes rows to a file, by its name, or to standard output.
fn writer(path: Option<&Path>, header: &[String]) -> Result<Box<dyn RowWriter>, CommandError> {
    match path {
        Some(path) if is_parquet(path) => parquet::writer(path, header),
        path => Ok(Box::new(CsvWriter::new(path, header)?)),
    }
}

/// Whether a file of this name holds Parquet.
pub fn is_parquet(path: &Path) -> bool {
    is_of(path, &["parquet"])
}

/// Where the rows go.
pub struct Record {
    table: Option<Box<dyn RowWriter>>,
    /// What tells the rows of several runs apart, before each row of the table.
    value: Option<f64>,
    /// Numbers of a row that the table gets: a picture may want more.
    width: usize,
    rows: Option<Vec<Vec<f64>>>,
    count: usize,
    last: f64,
    names: Vec<String>,
    undefined: Vec<Undefined>,
    sizes: Sizes,
}

/// A column that had no value in some rows.
struct Undefined {
    column: usize,
    /// When it had none for the first time (s).
    first: f64,
    rows: usize,
}

impl Record {
    /// What the command line asks for; `varied` is the column that tells several runs apart,
    /// `absolute` the absolute tolerance, if steps follow one.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`] if a file can't be written.
    pub fn open(
        arguments: &Simulate,
        structure: &Structure,
        columns: &[Column],
        varied: Option<String>,
        absolute: Option<f64>,
    ) -> Result<Self, CommandError> {
        let pictures = || arguments.plot.iter().chain(&arguments.film);
        pictures().try_for_each(|path| probe(path))?;
        let drawn = pictures().next().is_some();
        let wanted = arguments.out.is_some() || !drawn;
        let header = header(structure, columns);
        let width = header.len();
        let all: Vec<String> = varied.into_iter().chain(header.clone()).collect();
        let open = || writer(arguments.out.as_deref(), &all);
        Ok(Self {
            table: wanted.then(open).transpose()?,
            value: None,
            width,
            rows: drawn.then(Vec::new),
            count: 0,
            last: 0.0,
            names: header,
            undefined: Vec::new(),
            sizes: Sizes::new(structure, absolute),
        })
    }

    /// Notes the columns that have no value in a row.
    fn note(&mut self, values: &[f64]) {
        let t = values.first().copied().unwrap_or(0.0);
        let shown = values.iter().take(self.width).enumerate();
        for (column, _) in shown.filter(|(_, value)| !value.is_finite()) {
            match self.undefined.iter_mut().find(|x| x.column == column) {
                Some(undefined) => undefined.rows += 1,
                None => self.undefined.push(Undefined {
                    column,
                    first: t,
                    rows: 1,
                }),
            }
        }
    }

    /// What to say of columns that had no value, and of coordinates with few digits.
    fn warnings(&self) -> impl Iterator<Item = String> {
        let undefined = self.undefined.iter().map(|undefined| {
            let Undefined {
                column,
                first,
                rows,
            } = undefined;
            let name = self.names.get(*column).map_or("", String::as_str);
            format!(
                "warning: `{name}` has no finite value in {rows} of the {} rows, for the first \
                 time at t = {first} s: look for a root or a logarithm of a negative number in \
                 it, or a quotient by zero",
                self.count
            )
        });
        undefined.chain(self.sizes.warnings())
    }

    /// Takes the rows of another run, which this value tells from the others.
    pub fn begin(&mut self, value: f64) {
        self.value = Some(value);
    }

    /// Gives the rows of a run that has ended, if there will be a picture of them.
    pub fn end(&mut self) -> Vec<Vec<f64>> {
        self.rows.as_mut().map(mem::take).unwrap_or_default()
    }

    /// Goes on after the rows of a checkpoint.
    ///
    /// # Errors
    ///
    /// As [`RowWriter::go_on`].
    pub fn go_on(&mut self, checkpoint: &Checkpoint) -> Result<(), CommandError> {
        self.count = usize::try_from(checkpoint.rows.count).unwrap_or(usize::MAX);
        let table = self.table.as_mut();
        table.map_or(Ok(()), |table| table.go_on(checkpoint.rows))
    }

    /// Writes what is still to be written; `draw` draws the rows and says where. Returns what
    /// to say of the rows if the run failed.
    ///
    /// # Errors
    ///
    /// A [`CommandError`] if a file can't be written to its end.
    pub fn close(
        &mut self,
        draw: impl FnOnce(Vec<Vec<f64>>) -> Result<Vec<String>, CommandError>,
    ) -> Result<String, CommandError> {
        self.warnings().for_each(|text| say(&text));
        let mut places = Vec::new();
        // A reader of the rows that has gone is no reason not to draw the picture.
        let finished = self.table.as_mut().map_or(Ok(()), |table| table.finish());
        places.extend(self.table.as_ref().map(|table| table.destination()));
        if let Some(rows) = self.rows.take()
            && self.count > 0
        {
            places.extend(draw(rows)?);
        }
        finished?;
        Ok(match self.count {
            0 => "\nno rows were computed, and nothing was written".to_string(),
            1 => format!(
                "\nthe row of t = {} s was written: {}",
                self.last,
                places.join(", ")
            ),
            count => format!(
                "\nthe {count} rows computed before, up to t = {} s, were written: {}",
                self.last,
                places.join(", ")
            ),
        })
    }
}

impl RowSink for Record {
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        self.note(values);
        self.sizes.note(values);
        if let Some(table) = &mut self.table {
            let values = values.get(..self.width).unwrap_or(values);
            match self.value {
                Some(value) => table.row(&[&[value], values].concat())?,
                None => table.row(values)?,
            }
        }
        if let Some(rows) = &mut self.rows {
            rows.push(values.to_vec());
        }
        self.count += 1;
        self.last = values.first().copied().unwrap_or(0.0);
        Ok(())
    }

    fn flush(&mut self) -> Result<Rows, CommandError> {
        match &mut self.table {
            Some(table) => table.flush(),
            None => Ok(Rows::default()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_without_a_value_are_named_with_the_first_time() {
        let mut record = Record {
            table: None,
            value: None,
            width: 3,
            rows: None,
            count: 0,
            last: 0.0,
            names: ["t", "x", "p"].map(String::from).to_vec(),
            undefined: Vec::new(),
            sizes: Sizes::new(&Structure::PLAIN, None),
        };
        for (t, p) in [(0.0, 1.0), (0.5, f64::NAN), (1.0, f64::INFINITY)] {
            // What a picture wants besides is not among the rows.
            assert!(record.row(&[t, 0.0, p, f64::NAN]).is_ok());
        }
        let warnings: Vec<String> = record.warnings().collect();
        let [warning] = &warnings[..] else {
            panic!("{warnings:?}");
        };
        let said = "`p` has no finite value in 2 of the 3 rows, for the first time at t = 0.5 s";
        assert!(warning.contains(said), "{warning}");
    }
}
