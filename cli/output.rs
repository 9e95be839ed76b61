//! Text that leaves the program.
//!
//! In:  text.
//! Out: standard output, standard error, files.

use crate::error::CommandError;
use crate::mistakes::each;
use crate::place::place;
use anstyle::AnsiColor;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether nothing but errors is said. What compiles and what runs say what they do, and
/// none of them knows what was asked for.
static QUIET: AtomicBool = AtomicBool::new(false);

/// What messages call standard output.
pub const STANDARD_OUTPUT: &str = "standard output";

/// Prints text to standard output.
///
/// # Errors
///
/// [`CommandError::NobodyReads`] if the reader has gone, and
/// [`CommandError::Write`] for everything else.
pub fn print(text: &str) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.map_err(|error| CommandError::write(Path::new(STANDARD_OUTPUT), error))
}

/// A path as it is typed in a shell.
pub fn typed(path: &Path) -> String {
    let path = path.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/\\:._-+".contains(c);
    match path.chars().all(is_plain) {
        true => path,
        false => format!("\"{path}\""),
    }
}

/// Says nothing from here on but errors.
pub fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Prints a line to standard error, unless nothing but errors is wanted. A standard error
/// that nobody reads is no reason to stop.
pub fn say(line: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        let _unread = writeln!(io::stderr().lock(), "{line}");
    }
}

/// Prints an error to standard error, in colour on a terminal unless `NO_COLOR` is set.
pub fn complain(error: &CommandError) {
    let red = AnsiColor::Red.on_default().bold();
    for error in each(error) {
        let _unread = writeln!(anstream::stderr().lock(), "{red}error:{red:#} {error}");
    }
}

/// Writes a whole file.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn write(path: &Path, text: &str) -> Result<(), CommandError> {
    fs::write(path, text).map_err(|error| CommandError::write(path, error))
}

/// Writes a whole file in place of what bears its name, all at once. What is no file, such
/// as a pipe, is written to.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    let failed = |error| CommandError::write(path, error);
    // A link stays one.
    let place = place(path);
    if place.exists() && !place.is_file() {
        return fs::write(&place, bytes).map_err(failed);
    }
    let beside = beside(&place);
    let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, &place));
    if written.is_err() {
        let _nothing_left = fs::remove_file(&beside);
    }
    written.map_err(failed)
}

/// A name beside a file that nobody else uses.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or(OsStr::new("file"));
    let name = format!(".{}.{}", name.to_string_lossy(), process::id());
    path.with_file_name(name)
}

/// Finds out whether a file can be written, before anything is computed for it.
/// What it holds stays as it is until there is something to write.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn probe(path: &Path) -> Result<(), CommandError> {
    let failed = |error| CommandError::write(path, error);
    // What is removed again is the file, not a link that leads to it.
    let place = place(path);
    let there = fs::metadata(&place).ok();
    // Whoever reads a pipe takes it for ended when it is closed.
    if there
        .as_ref()
        .is_some_and(|there| !there.is_file() && !there.is_dir())
    {
        return Ok(());
    }
    File::options()
        .append(true)
        .create(true)
        .open(&place)
        .map_err(failed)?;
    match there {
        Some(_) => Ok(()),
        None => fs::remove_file(&place).map_err(failed),
    }
}

#[cfg(test)]
mod tests {
    use super::typed;
    use std::path::Path;

    #[test]
    fn a_path_with_blanks_is_typed_in_quotes() {
        assert_eq!(typed(Path::new("out/ex_1-b")), "out/ex_1-b");
        assert_eq!(typed(Path::new("ex_my mech")), "\"ex_my mech\"");
    }
}
