//! Rows that leave the program as Parquet.
//!
//! In:  rows of numbers.
//! Out: a Parquet file with a column of doubles for each of them.
//!
//! A Parquet file is readable only with its end, so rows go there in blocks and the
//! file is finished once. Not here: checkpoints, which need rows that can be added to.

use crate::error::CommandError;
use crate::output::probe;
use crate::rows::RowWriter;
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Why no file in this format can be written: it can. A command that is built without the
/// feature `parquet` has the module `without_parquet.rs` in place of this one.
pub const MISSING: Option<&str> = None;

/// Rows in a block.
const BLOCK: usize = 1 << 16;

/// Rows of numbers on their way to a Parquet file.
struct ParquetWriter {
    path: PathBuf,
    /// Opened when the first block is full or the rows end, so that a run that can't
    /// begin harms no file of the same name.
    out: Option<SerializedFileWriter<File>>,
    header: Vec<String>,
    /// The rows that are not written yet, column by column.
    block: Vec<Vec<f64>>,
}

/// Rows for a file, which is replaced.
///
/// # Errors
///
/// [`CommandError::Write`] if the file can't be written.
pub fn writer(path: &Path, header: &[String]) -> Result<Box<dyn RowWriter>, CommandError> {
    probe(path)?;
    Ok(Box::new(ParquetWriter {
        path: path.to_path_buf(),
        out: None,
        header: header.to_vec(),
        block: vec![Vec::new(); header.len()],
    }))
}

impl RowWriter for ParquetWriter {
    fn row(&mut self, values: &[f64]) -> Result<(), CommandError> {
        for (column, value) in self.block.iter_mut().zip(values) {
            column.push(*value);
        }
        match self.block.first() {
            Some(column) if column.len() >= BLOCK => {
                self.write_block().map_err(|error| self.failed(&error))
            }
            _ => Ok(()),
        }
    }

    /// Writes the last rows and the end of the file.
    fn finish(&mut self) -> Result<(), CommandError> {
        let written = self.write_block().and_then(|()| match self.out.take() {
            Some(out) => out.close().map(|_| ()),
            None => Ok(()),
        });
        written.map_err(|error| self.failed(&error))
    }

    fn destination(&self) -> String {
        self.path.display().to_string()
    }
}

impl ParquetWriter {
    fn write_block(&mut self) -> Result<(), ParquetError> {
        if self.block.iter().all(Vec::is_empty) {
            return Ok(());
        }
        let out = match &mut self.out {
            Some(out) => out,
            None => {
                let file = File::create(&self.path)?;
                let schema = Arc::new(schema(&self.header)?);
                let writer = SerializedFileWriter::new(file, schema, properties())?;
                self.out.insert(writer)
            }
        };
        let mut group = out.next_row_group()?;
        for values in &mut self.block {
            if let Some(mut column) = group.next_column()? {
                column
                    .typed::<DoubleType>()
                    .write_batch(values, None, None)?;
                column.close()?;
            }
            values.clear();
        }
        group.close()?;
        Ok(())
    }

    fn failed(&self, error: &ParquetError) -> CommandError {
        let text = format!("{error}; without its end it can't be read: CSV keeps the rows before");
        CommandError::write(&self.path, io::Error::other(text))
    }
}

/// A required column of doubles for each name.
fn schema(header: &[String]) -> Result<Type, ParquetError> {
    let column = |name: &String| {
        let double = Type::primitive_type_builder(name, parquet::basic::Type::DOUBLE);
        let required = double.with_repetition(parquet::basic::Repetition::REQUIRED);
        Ok(Arc::new(required.build()?))
    };
    let fields = header
        .iter()
        .map(column)
        .collect::<Result<_, ParquetError>>()?;
    Type::group_type_builder("rows").with_fields(fields).build()
}

/// Motions hardly repeat a number: dictionaries would only cost time.
fn properties() -> Arc<WriterProperties> {
    Arc::new(
        WriterProperties::builder()
            .set_dictionary_enabled(false)
            .build(),
    )
}
