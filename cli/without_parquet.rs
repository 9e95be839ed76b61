//! What stands for the writer of Parquet files in a command that was built without it.

use crate::error::CommandError;
use crate::files::refuse;
use crate::rows::RowWriter;
use std::path::Path;

/// Why no file in this format can be written, and what to do.
pub const MISSING: Option<&str> = Some(
    "this bricard was built without Parquet; write `--out run.csv`, or build it with its \
     default features",
);

/// Refuses a file.
///
/// # Errors
///
/// [`CommandError::FileKind`], always.
pub fn writer(path: &Path, _: &[String]) -> Result<Box<dyn RowWriter>, CommandError> {
    refuse(path, MISSING.unwrap_or_default())
}
