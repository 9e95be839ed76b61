//! `bricard cache`: what was compiled.
//!
//! In:  the cache.
//! Out: where it is, how large it is and what is in it; with `--clear`, an empty cache.

use crate::arguments;
use crate::captions::counted;
use crate::compiled::cache::{Cache, entries};
use crate::error::CommandError;
use crate::output::print;
use crate::table::{Align, headed};
use std::fs;
use std::path::Path;

/// A megabyte.
const MEGABYTE: f64 = 1e6;

/// Shows or clears the cache.
///
/// # Errors
///
/// [`CommandError::Cache`], [`CommandError::Compile`].
pub fn cache(arguments: &arguments::Cache) -> Result<(), CommandError> {
    let cache = Cache::find()?;
    let place = cache.root.display();
    if !cache.root.is_dir() {
        return print(&format!("{place}: nothing has been compiled yet\n"));
    }
    let before = megabytes(&cache.root);
    if arguments.clear {
        clear(&cache)?;
        return print(&format!("{place}: {before} MB were removed\n"));
    }
    print(&format!("{place}: {before} MB\n"))?;
    let rows = contents(&cache.root);
    if rows.is_empty() {
        return Ok(());
    }
    let align = [Align::Left, Align::Left, Align::Right];
    print(&format!(
        "\n{}\n`bricard cache --clear` removes all of it\n",
        headed(&["version", "what", "MB"], &rows, &align)
    ))
}

/// Removes everything, when no other process is compiling.
fn clear(cache: &Cache) -> Result<(), CommandError> {
    let _alone = cache.lock()?;
    for entry in entries(&cache.root) {
        let path = entry.path();
        let removed = match path.is_dir() {
            true => fs::remove_dir_all(&path),
            // The lock itself is no larger than its name.
            false => Ok(()),
        };
        removed.map_err(|error| CommandError::Cache(path, error))?;
    }
    Ok(())
}

/// What is there, version by version: what programs share, the programs, and libraries for
/// other languages.
fn contents(root: &Path) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for version in sorted(root) {
        let folder = root.join(&version);
        let count = entries(&folder.join("sizes")).len();
        let shared = ["libraries", "boundary", "sizes"].map(|shared| folder.join(shared));
        let size: u64 = shared.iter().map(|folder| bytes(folder)).sum();
        let pairs = counted(count, "pair");
        let what = format!("shared by all, and by mechanisms of {pairs} of sizes");
        rows.push(vec![version.clone(), what, in_megabytes(size)]);
        for shelf in ["programs", "exported"].map(|shelf| folder.join(shelf)) {
            for entry in sorted(&shelf) {
                let size = megabytes(&shelf.join(&entry));
                // Files have any names, also such as end a line.
                let entry = entry.replace(char::is_control, "?");
                rows.push(vec![String::new(), entry, size]);
            }
        }
    }
    rows
}

/// The names of the folders in a folder.
fn sorted(folder: &Path) -> Vec<String> {
    let folders = entries(folder).into_iter();
    let mut names: Vec<String> = folders
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn megabytes(path: &Path) -> String {
    in_megabytes(bytes(path))
}

fn in_megabytes(bytes: u64) -> String {
    format!("{:.1}", bytes as f64 / MEGABYTE)
}

/// The size of all files in a folder.
fn bytes(folder: &Path) -> u64 {
    let size = |entry: &fs::DirEntry| match entry.metadata() {
        Ok(data) if data.is_dir() => bytes(&entry.path()),
        Ok(data) => data.len(),
        Err(_) => 0,
    };
    entries(folder).iter().map(size).sum()
}
