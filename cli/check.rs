//! `bricard check`: the front end alone.
//!
//! In:  a file.
//! Out: what is wrong or doubtful in it, on standard error.

use crate::arguments::Check;
use crate::error::CommandError;
use crate::output::{print, say};
use bricard_codegen::{Settings, examine};
use std::fs;
use std::path::Path;

/// Checks a description.
pub fn check(arguments: &Check) -> Result<(), CommandError> {
    let source = read(&arguments.file)?;
    let file = arguments.file.display().to_string();
    let (mechanism, warnings) = examine(&source, &Settings::default())
        .map_err(|errors| CommandError::Description(errors.render(&file, &source)))?;
    if !warnings.is_empty() {
        say(warnings.render(&file, &source).trim_end());
    }
    print(&format!(
        "{file}: `{}` is in order: {} coordinates, {} constraint equations\n",
        mechanism.name,
        mechanism.coordinates.len(),
        mechanism.constraints.len()
    ))
}

/// The text of a description.
pub fn read(path: &Path) -> Result<String, CommandError> {
    fs::read_to_string(path).map_err(|error| CommandError::Read(path.to_path_buf(), error))
}
