//! What a command reads and what it writes: no file for two purposes, of which one would
//! destroy the other.
//!
//! In:  a mechanism's name or file, and the files that options want to write.
//! Out: a refusal, before anything is computed.

use crate::compiled::files_of;
use crate::error::CommandError;
use crate::mechanism::file;
use crate::place::place;
use std::path::{Path, PathBuf};

/// Refuses a file that two options want to write, or that the description is in or reads.
///
/// # Errors
///
/// [`CommandError::SameFile`], [`CommandError::ReadHere`].
pub fn apart(name: &str, written: &[(&'static str, &Option<PathBuf>)]) -> Result<(), CommandError> {
    let read: Vec<PathBuf> = file(name).map(files_of).unwrap_or_default();
    let read: Vec<PathBuf> = read.iter().map(|path| place(path)).collect();
    let mut known: Vec<(&'static str, PathBuf)> = Vec::new();
    for (option, path) in written {
        let Some(path) = path.as_ref().filter(|path| *path != Path::new("-")) else {
            continue;
        };
        let (here, path) = (place(path), path.clone());
        if let Some((other, _)) = known.iter().find(|(_, other)| *other == here) {
            return Err(CommandError::SameFile {
                options: [other, option],
                path,
                instead: "give them different names",
            });
        }
        if read.contains(&here) {
            return Err(CommandError::ReadHere { option, path });
        }
        known.push((option, here));
    }
    Ok(())
}

/// Whether a file is of one of some kinds, by its ending.
pub fn is_of(path: &Path, kinds: &[&str]) -> bool {
    let kind = path.extension();
    kind.is_some_and(|kind| kinds.iter().any(|known| kind.eq_ignore_ascii_case(known)))
}

/// Refuses a file of a kind that can't be written, with what to write instead.
///
/// # Errors
///
/// [`CommandError::FileKind`], always.
pub fn refuse<T>(path: &Path, instead: &'static str) -> Result<T, CommandError> {
    Err(CommandError::FileKind {
        path: path.to_path_buf(),
        instead,
    })
}
