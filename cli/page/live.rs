//! What keeps an open page up to date: a script beside it, which the page reads again and
//! again.
//!
//! In:  versions of a page, messages.
//! Out: the script.
//!
//! A page that was opened as a file may read scripts beside it, and nothing else.

use super::template::page;
use crate::error::CommandError;
use crate::output::replace;
use serde_json::json;
use std::cell::Cell;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process;
use std::time::SystemTime;

/// The script beside a page.
#[derive(Clone, Debug)]
pub struct Live {
    page: PathBuf,
    script: PathBuf,
    /// Tells versions of the page from each other.
    pub version: String,
    renewed: Cell<bool>,
}

impl Live {
    /// The script beside a page, for its next version.
    pub fn beside(path: &Path) -> Self {
        let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
        name.push(".live.js");
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        let nanos = now.map_or(0, |now| now.as_nanos());
        Self {
            page: path.to_path_buf(),
            script: path.with_file_name(name),
            version: format!("{}-{nanos}", process::id()),
            renewed: Cell::new(false),
        }
    }

    /// The name of the script, as the page calls it.
    pub fn name(&self) -> String {
        let name = self.script.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// Tells the open page to load its new version.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn renew(&self) -> Result<(), CommandError> {
        self.renewed.set(true);
        self.say(&json!({ "version": self.version }))
    }

    /// Shows a message in the open page, or in a new one that has nothing else if there is
    /// none. A page of this version has it already.
    ///
    /// # Errors
    ///
    /// [`CommandError::Write`].
    pub fn complain(&self, message: &str) -> Result<(), CommandError> {
        if self.renewed.get() {
            return Ok(());
        }
        if !self.page.exists() {
            let live = json!({ "script": self.name(), "version": self.version });
            let data = json!({ "live": live, "error": message });
            replace(&self.page, page("bricard", &data).as_bytes())?;
        }
        self.say(&json!({ "error": message }))
    }

    /// Tells the open page that nobody keeps it up to date any more.
    pub fn end(&self) {
        // The page shows what it has.
        let _unread = self.say(&json!({ "ended": true }));
    }

    fn say(&self, news: &serde_json::Value) -> Result<(), CommandError> {
        replace(&self.script, format!("bricardLive({news});\n").as_bytes())
    }
}
