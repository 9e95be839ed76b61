//! The folder that something is exported to.
//!
//! In:  paths and texts.
//! Out: files.

use crate::error::CommandError;
use std::fs;
use std::path::{Path, PathBuf};

/// The file by which a folder that was exported is known.
const MARK: &str = ".bricard-export";

/// Refuses a folder in which there is something that was not exported.
///
/// # Errors
///
/// [`CommandError::Exists`].
pub fn vacant(path: &Path) -> Result<(), CommandError> {
    let is_empty = || fs::read_dir(path).is_ok_and(|mut all| all.next().is_none());
    match path.exists() && !is_empty() && !path.join(MARK).is_file() {
        true => Err(CommandError::Exists(path.to_path_buf())),
        false => Ok(()),
    }
}

/// A folder that is new, or that an earlier export has made.
pub struct Folder(PathBuf);

impl Folder {
    /// Makes a folder, or takes one that is empty or was exported before.
    ///
    /// # Errors
    ///
    /// [`CommandError::Exists`] if something else is in it, [`CommandError::Write`].
    pub fn new(path: &Path) -> Result<Self, CommandError> {
        vacant(path)?;
        let folder = Self(path.to_path_buf());
        let said = format!(
            "Written by `bricard export` {}, which may replace what is here.\n",
            env!("CARGO_PKG_VERSION")
        );
        folder.write(MARK, &said)?;
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file in it.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn write(&self, name: &str, text: &str) -> Result<(), CommandError> {
        let path = self.place(name)?;
        fs::write(&path, text).map_err(|error| CommandError::write(&path, error))
    }

    /// Copies a file into it.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn copy(&self, from: &Path, name: &str) -> Result<(), CommandError> {
        let path = self.place(name)?;
        let copied = fs::copy(from, &path);
        copied
            .map(|_| ())
            .map_err(|error| CommandError::write(&path, error))
    }

    /// Where a file of it is; the folder above is made.
    fn place(&self, name: &str) -> Result<PathBuf, CommandError> {
        let path = self.0.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|error| CommandError::write(folder, error))?;
        }
        Ok(path)
    }
}
