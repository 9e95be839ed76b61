//! The text of a description.
//!
//! In:  a file.
//! Out: what is in it.

use crate::error::CommandError;
use std::path::{Path, PathBuf};

/// A description, and the file that it is in.
#[derive(Clone, Debug)]
pub struct Description {
    /// The file; of a mechanism that the command has in it, the one it was compiled from.
    pub file: PathBuf,
    /// The text.
    pub source: String,
}

/// The text of a description.
pub fn read(path: &Path) -> Result<String, CommandError> {
    bricard_codegen::internals::read_text(path)
        .map_err(|error| CommandError::Read(path.to_path_buf(), error))
}
