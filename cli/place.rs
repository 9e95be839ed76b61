//! Where files are.
//!
//! In:  paths.
//! Out: folders, and what links lead to.

use std::fs;
use std::path::{Path, PathBuf};

/// Links that are followed, one to the next; systems stop there, too.
const LINKS: usize = 40;

/// The folder that a file is in.
pub fn folder(file: &Path) -> &Path {
    let folder = file.parent().filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

/// Where a file is, whatever links and folders lead to it, or where it would be: a link may
/// lead to a file that is still to be written.
pub fn place(path: &Path) -> PathBuf {
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = path.with_file_name("").join(next),
            Err(_) => break,
        }
    }
    let new = || {
        Some(
            fs::canonicalize(folder(&path))
                .ok()?
                .join(path.file_name()?),
        )
    };
    let there = fs::canonicalize(&path).ok().or_else(new);
    there.unwrap_or(path)
}
