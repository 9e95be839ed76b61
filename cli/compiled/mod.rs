//! A mechanism of a file, compiled behind the scenes.
//!
//! In:  the path of a description.
//! Out: a program of its own that simulates it, found in the cache or built.
//!
//! ```text
//! description ── codegen ──> its code ──┐
//! the sources that the command carries ─┴─ rustc ──> a program ── started ──> Link
//! ```
//!
//! Three layers, each built once and kept ([`cache`]): what all programs share
//! ([`shared`]), what those of one pair of sizes share, and the code of the description
//! ([`program`]). Parameters and starts are told to the running program.

pub mod browser;
pub mod cache;
pub mod compiler;
mod library;
mod parameters;
mod program;
mod settings;
mod shared;
pub mod sources;

pub use compiler::{command, output};
pub use library::{Library, generate, library, module_of};

use crate::description::{read, say_doubts, wrong};
use crate::error::CommandError;
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::examine;
use bricard_driver::{Link, PreciseLink};
use cache::{Cache, Digits, Version};
use compiler::Toolchain;
use program::Program;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Compiles a description if it is not in the cache, and starts its program.
///
/// # Errors
///
/// What is wrong with the description, in the words of `bricard check`; what stands in the
/// way of compiling it.
pub fn open(file: &Path) -> Result<Link, CommandError> {
    open_text(file, &read(file)?)
}

/// As [`open`], a description that is in no file but called as if it were.
///
/// # Errors
///
/// As [`open`].
pub fn open_text(file: &Path, source: &str) -> Result<Link, CommandError> {
    let mut link = start(&program(file, source, Digits::Double)?, Link::start)?;
    parameters::tell(&mut link, source);
    Ok(link)
}

/// As [`open_text`], in numbers of 106 bits.
///
/// # Errors
///
/// As [`open`].
pub fn open_precise(file: &Path, source: &str) -> Result<PreciseLink, CommandError> {
    start(&program(file, source, Digits::Many)?, PreciseLink::start)
}

/// The program of a description, from the cache or built.
fn program(file: &Path, source: &str, digits: Digits) -> Result<PathBuf, CommandError> {
    // A program serves all values of the parameters.
    let identity = match digits {
        Digits::Double => identity(file, &parameters::without_values(source)),
        Digits::Many => identity(file, source),
    };
    // A wrong description is the first thing to know, toolchain or not.
    warn(file, source)?;
    let toolchain = Toolchain::find();
    let cache = Cache::find()?;
    let known = toolchain.as_ref().ok().and_then(|toolchain| {
        let version = Version::new(&cache, toolchain, digits);
        version.program(file, &identity)
    });
    match known {
        Some(program) => Ok(program),
        None => {
            let program = Program::generate(file, source, &identity)?;
            let toolchain = toolchain?;
            program.build(&Version::new(&cache, &toolchain, digits), &toolchain)
        }
    }
}

/// Says what is doubtful about a description, whether or not it has a program already: with
/// other values of the parameters something else may be.
///
/// # Errors
///
/// [`CommandError::Description`].
fn warn(file: &Path, source: &str) -> Result<(), CommandError> {
    let examined = examine(source, &CompileSettings::beside(file));
    let (_, warnings) = examined.map_err(wrong(file, source))?;
    say_doubts(file, source, &warnings);
    Ok(())
}

/// A description with the files that it may read: quoted names of files that are there.
pub fn identity(file: &Path, source: &str) -> String {
    let mut identity = source.to_string();
    for name in quoted(source) {
        if let Ok(data) = fs::read_to_string(beside(file, name)) {
            identity.push_str(&format!("\n// {name}\n{data}"));
        }
    }
    identity
}

/// What a description quotes: names of files beside it and of their columns. A comment may
/// hold a single quote, so what is between quotes may be what is outside.
pub fn quoted(source: &str) -> impl Iterator<Item = &str> {
    source.lines().flat_map(|line| line.split('"').skip(1))
}

/// The file of a description, and those that it may read.
pub fn files_of(file: &Path) -> Vec<PathBuf> {
    // What can't be read is told when it is compiled.
    let source = read(file).unwrap_or_default();
    let others = quoted(&source).map(|name| beside(file, name));
    others.chain([file.to_path_buf()]).collect()
}

fn beside(file: &Path, name: &str) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(name)
}

/// Starts a program.
fn start<L>(
    program: &Path,
    link: impl FnOnce(Command) -> io::Result<L>,
) -> Result<L, CommandError> {
    link(Command::new(program)).map_err(|error| {
        CommandError::Compile(format!(
            "the program {} could not be started: {error}; if programs can't run there, name \
             another folder with XDG_CACHE_HOME, and if it is damaged, say `bricard cache --clear`",
            program.display()
        ))
    })
}
