//! The text of a description.
//!
//! In:  a file.
//! Out: what is in it; what the compiler finds in it, for people.

use crate::error::CommandError;
use crate::output::say;
use bricard_codegen::Diagnostics;
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

/// What is wrong with the text of a file, as an error.
pub fn wrong(file: &Path, source: &str) -> impl Fn(Diagnostics) -> CommandError {
    move |errors| CommandError::Description(errors.render(&file.display().to_string(), source))
}

/// Says what is doubtful about the text of a file, if something is.
pub fn say_doubts(file: &Path, source: &str, warnings: &Diagnostics) {
    if !warnings.is_empty() {
        say(warnings
            .render(&file.display().to_string(), source)
            .trim_end());
    }
}
