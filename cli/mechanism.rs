//! Finding a mechanism: one of the library by its name, or that of a file by its path.
//!
//! In:  what the command line calls it.
//! Out: [`AnyMechanism`], on which the commands work.

use crate::compiled;
use crate::description::{Description, read};
use crate::error::CommandError;
use crate::words::freedom;
use bricard_driver::{AnyMechanism, Precise, erase_type};
use bricard_runtime::{Interface, Mechanism, Settings, Solver, Visitor, Whole, assemble};
use std::path::{self, Path, PathBuf};

/// Finds a mechanism of the library or of the benchmark problems, or compiles a file.
///
/// # Errors
///
/// [`CommandError::UnknownName`]; what stands in the way of the file.
pub fn find(name: &str) -> Result<Box<dyn AnyMechanism>, CommandError> {
    if let Some(file) = file(name) {
        return Ok(Box::new(compiled::open(file)?));
    }
    let found =
        bricard::visit(name, EraseType).or_else(|| bricard_benchmarks::visit(name, EraseType));
    found.ok_or_else(|| unknown(name))
}

fn unknown(name: &str) -> CommandError {
    CommandError::UnknownName {
        kind: "mechanism",
        owner: String::new(),
        name: name.to_string(),
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
            Ok(format!("{:016x}", compiled::hash([&*identity])))
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
    let source = bricard::source(name).or_else(|| bricard_benchmarks::source(name));
    let source = source.ok_or_else(|| unknown(name))?;
    Ok(Description {
        file: PathBuf::from(find(name)?.structure().file),
        source: source.to_string(),
    })
}

struct EraseType;

impl Visitor<f64> for EraseType {
    type Output = Box<dyn AnyMechanism>;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        erase_type::<N, R>(Box::new(mechanism))
    }
}

/// The same mechanism in numbers of 106 bits, in a program of its own: few commands ask
/// for them, and everyone who builds the command would pay for their code.
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
    bricard::visit(name, Freedom).or_else(|| bricard_benchmarks::visit(name, Freedom))
}

struct Freedom;

impl Visitor<f64> for Freedom {
    type Output = String;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        free::<N, R>(&mechanism)
    }
}

fn free<const N: usize, const R: usize>(mechanism: &dyn Whole<f64, N, R>) -> String {
    if R == 0 {
        return freedom(N);
    }
    let state = match assemble(mechanism, &mechanism.start(), 0.0) {
        Ok(state) => state,
        Err(error) => return format!("the start can't be assembled: {error}"),
    };
    match Solver::new(Settings::default()).on(mechanism).rank(&state) {
        Ok(rank) => format!(
            "at the start {} of {R} constraint equations are independent: {}",
            rank.rank,
            freedom(N - rank.rank)
        ),
        Err(error) => format!("the rank at the start can't be decided: {error}"),
    }
}
