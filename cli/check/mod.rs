//! `bricard check`: the front end alone.
//!
//! In:  a file.
//! Out: what is wrong or doubtful in it: for people on standard error, or as JSON on
//!      standard output.

mod json;

use crate::arguments::Check;
use crate::captions::sizes;
use crate::description::read;
use crate::error::CommandError;
use crate::mechanism::names;
use crate::output::{print, say};
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::examine;
use bricard_codegen::internals::model::Mechanism;

/// Checks a description.
pub fn check(arguments: &Check) -> Result<(), CommandError> {
    let file = arguments.file.display().to_string();
    if names().any(|name| name == file) && !arguments.file.exists() {
        return Err(CommandError::NoFile(file));
    }
    let source = read(&arguments.file)?;
    let examined = examine(&source, &CompileSettings::beside(&arguments.file));
    if arguments.json {
        print(&json::report(&file, &examined))?;
        return examined.map(|_| ()).map_err(|_| CommandError::Said);
    }
    let (mechanism, warnings) =
        examined.map_err(|errors| CommandError::Description(errors.render(&file, &source)))?;
    if !warnings.is_empty() {
        say(warnings.render(&file, &source).trim_end());
    }
    print(&in_order(&file, &mechanism))
}

fn in_order(file: &str, mechanism: &Mechanism) -> String {
    let sizes = sizes(mechanism);
    format!("{file}: `{}` is in order: {sizes}\n", mechanism.name)
}
