//! The folder that something is exported to.
//!
//! In:  paths and texts.
//! Out: files.

use crate::error::CommandError;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Component, Path, PathBuf};

/// The file by which a folder that was exported is known. Its lines, but the first, are the
/// files that were written.
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

/// Whether a path leads to something in the folder that it begins in, or below.
pub fn is_inside(path: &Path) -> bool {
    let mut parts = path.components();
    parts.all(|part| matches!(part, Component::Normal(_)))
}

impl Folder {
    /// Makes a folder, or takes one that is empty or was exported before, without the files of
    /// that export.
    ///
    /// # Errors
    ///
    /// [`CommandError::Exists`] if something else is in it, [`CommandError::Write`].
    pub fn new(path: &Path) -> Result<Self, CommandError> {
        vacant(path)?;
        let folder = Self(path.to_path_buf());
        folder.empty()?;
        let said = format!(
            "Written by `bricard export` {}, which may replace what is here:\n",
            env!("CARGO_PKG_VERSION")
        );
        let mark = path.join(MARK);
        fs::create_dir_all(path)
            .and_then(|()| fs::write(&mark, said))
            .map_err(|error| CommandError::write(&mark, error))?;
        Ok(folder)
    }

    /// Removes the files of the earlier export: mixed with those of another they would be no
    /// crate. What somebody else has put there stays.
    fn empty(&self) -> Result<(), CommandError> {
        let written = fs::read_to_string(self.0.join(MARK)).unwrap_or_default();
        let names = written.lines().skip(1).map(Path::new);
        for name in names.filter(|name| is_inside(name)) {
            let path = self.0.join(name);
            if path.is_file() {
                fs::remove_file(&path).map_err(|error| CommandError::write(&path, error))?;
            }
            for above in name.ancestors().skip(1) {
                // One in which there is something else stays.
                let _stays = fs::remove_dir(self.0.join(above));
            }
        }
        Ok(())
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

    /// Writes files in it: paths with texts.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn write_all(
        &self,
        files: impl IntoIterator<Item = (String, String)>,
    ) -> Result<(), CommandError> {
        let mut files = files.into_iter();
        files.try_for_each(|(name, text)| self.write(&name, &text))
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

    /// Where a file of it is; the folder above is made, and the file is noted.
    fn place(&self, name: &str) -> Result<PathBuf, CommandError> {
        let path = self.0.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|error| CommandError::write(folder, error))?;
        }
        let mark = self.0.join(MARK);
        let noted = File::options().append(true).open(&mark);
        noted
            .and_then(|mut noted| writeln!(noted, "{name}"))
            .map_err(|error| CommandError::write(&mark, error))?;
        Ok(path)
    }
}
