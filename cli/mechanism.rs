//! Finding a mechanism: one of the library by its name, or that of a file by its path.
//!
//! In:  what the command line calls it.
//! Out: [`AnyMechanism`], on which the commands work.

use crate::captions::freedom;
use crate::compiled;
use crate::description::{Description, read};
use crate::error::CommandError;
use crate::hash::hash;
use bricard_driver::{AnyMechanism, Precise};
use bricard_runtime::Structure;
use std::path::{self, Path, PathBuf};

/// Finds a mechanism of the library or of the benchmark problems, or compiles a file.
///
/// # Errors
///
/// [`CommandError::UnknownName`], [`CommandError::NameOfFile`]; what stands in the way of the
/// file.
pub fn find(name: &str) -> Result<Box<dyn AnyMechanism>, CommandError> {
    if let Some(file) = file(name) {
        return Ok(Box::new(compiled::open(file)?));
    }
    bricard::any(name).ok_or_else(|| unknown(name))
}

fn unknown(name: &str) -> CommandError {
    let beside = [format!("{name}.mech"), format!("./{name}")];
    if let Some(file) = beside
        .map(PathBuf::from)
        .into_iter()
        .find(|file| file.is_file())
    {
        return CommandError::NameOfFile(name.to_string(), file);
    }
    CommandError::UnknownName {
        kind: "mechanism",
        owner: String::new(),
        names: vec![name.to_string()],
        known: names().map(str::to_string).collect(),
    }
}

/// The file that is meant, if it is not a name: it ends in `.mech`, or lies in a folder.
pub fn file(name: &str) -> Option<&Path> {
    let path = Path::new(name);
    let is_file =
        path.extension().is_some_and(|kind| kind == "mech") || name.contains(path::is_separator);
    is_file.then_some(path)
}

/// What tells a mechanism from all others: its name, or the text of its file.
///
/// # Errors
///
/// [`CommandError::Read`].
pub fn identity(name: &str) -> Result<String, CommandError> {
    match file(name) {
        Some(file) => {
            let identity = compiled::identity(file, &read(file)?);
            Ok(format!("{:016x}", hash([&*identity])))
        }
        None => Ok(name.to_string()),
    }
}

/// The names that [`find`] knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    let library = bricard::NAMES.iter();
    library.chain(bricard_benchmarks::NAMES).copied()
}

/// The description of a mechanism by its name or path.
///
/// # Errors
///
/// As [`find`]; [`CommandError::Read`].
pub fn description(name: &str) -> Result<Description, CommandError> {
    if let Some(file) = file(name) {
        return Ok(Description {
            file: file.to_path_buf(),
            source: read(file)?,
        });
    }
    let (folder, source) = match bricard::source(name) {
        Some(source) => ("mechanisms", Some(source)),
        None => ("mechanisms/benchmarks", bricard_benchmarks::source(name)),
    };
    let source = source.ok_or_else(|| unknown(name))?;
    let file = Path::new(folder).join(find(name)?.structure().file);
    Ok(Description {
        // Without the `.` of the folder that the library was compiled in.
        file: file.components().collect(),
        source: source.to_string(),
    })
}

/// A mechanism of the library in numbers of 106 bits, in a program of its own: few commands ask for
/// them, and everyone who builds the command would pay for their code.
///
/// # Errors
///
/// As [`find`]; what stands in the way of compiling it.
pub fn precise(name: &str) -> Result<Box<dyn Precise>, CommandError> {
    let Description { file, source } = description(name)?;
    Ok(Box::new(compiled::open_precise(&file, &source)?))
}

/// In words: rank of the constraints of a mechanism of the library at its start, and what
/// is left free; `None` if there is no such mechanism.
pub fn freedom_at_start(name: &str) -> Option<String> {
    let mechanism = bricard::any(name)?;
    let Structure {
        coordinates,
        constraints,
        ..
    } = mechanism.structure();
    Some(match mechanism.rank_at_start() {
        _ if constraints.is_empty() => freedom(coordinates.len()),
        Ok(rank) => format!(
            "at the start {rank} of {} constraint equations are independent: {}",
            constraints.len(),
            freedom(coordinates.len() - rank)
        ),
        Err(error) => error,
    })
}
