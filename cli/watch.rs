//! `bricard watch`: a simulation for each version of a file.
//!
//! In:  the arguments of `simulate`, with a file.
//! Out: what `simulate` gives, again each time the file is saved.

use crate::arguments::Simulate;
use crate::error::CommandError;
use crate::interrupt;
use crate::mechanism::file;
use crate::output::{complain, say};
use crate::page::{Live, is_page};
use crate::simulate::{only_one, simulate_for};
use notify::{RecursiveMode, Watcher, recommended_watcher};
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// How often Ctrl-C is looked for.
const PERIOD: Duration = Duration::from_millis(100);
/// Editors write a file in several pieces, or another one that takes its name: after this
/// time of rest it is whole.
const REST: Duration = Duration::from_millis(30);

/// Simulates, and again each time the file is saved, until Ctrl-C.
///
/// # Errors
///
/// [`CommandError::NoFile`], [`CommandError::Runs`], [`CommandError::Watch`], and at its end
/// [`CommandError::Interrupted`].
pub fn watch(arguments: &Simulate) -> Result<(), CommandError> {
    let failed = |reason: String| CommandError::Watch(arguments.name.clone(), reason);
    let Some(file) = file(&arguments.name) else {
        return Err(CommandError::NoFile(arguments.name.clone()));
    };
    only_one(arguments, "`watch` shows one run")?;
    // The folder is watched: a new file under the old name is another file.
    let folder = match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let (sender, changes) = channel();
    let name = file.file_name().map(OsStr::to_owned);
    let mut watcher = recommended_watcher(move |event: notify::Result<notify::Event>| {
        // Somebody who reads files of the folder again and again must not keep it from
        // coming to rest.
        let concerns = event.as_ref().map_or(true, |event| {
            let mut paths = event.paths.iter();
            !event.kind.is_access() && paths.any(|path| path.file_name() == name.as_deref())
        });
        if concerns {
            // Nobody listens any more when the command ends.
            let _ended = sender.send(event);
        }
    })
    .map_err(|error| failed(error.to_string()))?;
    watcher
        .watch(folder, RecursiveMode::NonRecursive)
        .map_err(|error| failed(error.to_string()))?;
    interrupt::listen();
    let page = arguments.plot.as_deref().filter(|path| is_page(path));
    loop {
        let seen = fs::read(file).ok();
        let live = page.map(Live::beside);
        match (simulate_for(arguments, live.as_ref()), &live) {
            (Ok(()), _) => {}
            (Err(error), live) => {
                if let CommandError::Interrupted { .. } | CommandError::NobodyReads = error {
                    live.iter().for_each(|live| live.end());
                    return Err(error);
                }
                if let Some(live) = live {
                    live.complain(&error.to_string())?;
                }
                complain(&error);
            }
        }
        say(&format!("waiting until {} is saved", file.display()));
        wait(file, seen.as_deref(), &changes).map_err(failed)?;
        if interrupt::is_wanted() {
            live.iter().for_each(Live::end);
            let kept = String::new();
            return Err(CommandError::Interrupted { kept });
        }
    }
}

/// Waits until a file holds something else, or Ctrl-C.
fn wait(
    file: &Path,
    seen: Option<&[u8]>,
    changes: &Receiver<notify::Result<notify::Event>>,
) -> Result<(), String> {
    while !interrupt::is_wanted() {
        match changes.recv_timeout(PERIOD) {
            Ok(Ok(_)) => {
                while changes.recv_timeout(REST).is_ok() {}
                let there = fs::read(file).ok();
                if there.is_some() && there.as_deref() != seen {
                    break;
                }
            }
            Ok(Err(error)) => return Err(error.to_string()),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err("the system has ended the watch".to_string());
            }
        }
    }
    Ok(())
}
