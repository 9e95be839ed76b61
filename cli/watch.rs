//! `bricard watch`: a simulation for each version of a file.
//!
//! In:  the arguments of `simulate`, with a file.
//! Out: what `simulate` gives, again each time the file is saved, or one that it reads.

use crate::arguments::Simulate;
use crate::compiled::{identity, quoted};
use crate::error::CommandError;
use crate::interrupt;
use crate::mechanism::file;
use crate::output::{complain, say};
use crate::page::{Live, is_page};
use crate::place::folder;
use crate::simulate::{only_one, simulate_for};
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher, recommended_watcher};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How often Ctrl-C is looked for.
const PERIOD: Duration = Duration::from_millis(100);
/// Editors write a file in several pieces, or another one that takes its name: after this
/// time of rest it is whole.
const REST: Duration = Duration::from_millis(30);

/// What the watcher hears of.
type Heard = notify::Result<Event>;

/// Simulates, and again each time the file or one that it reads is saved, until Ctrl-C.
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
    useful(arguments)?;
    let (sender, changes) = channel();
    let mut watcher = recommended_watcher(move |heard: Heard| {
        // What is only read has not changed.
        if heard.as_ref().map_or(true, |event| !event.kind.is_access()) {
            // Nobody listens any more when the command ends.
            let _ended = sender.send(heard);
        }
    })
    .map_err(|error| failed(error.to_string()))?;
    interrupt::listen();
    let page = arguments.plot.as_deref().filter(|path| is_page(path));
    loop {
        let seen = Version::of(file);
        seen.listen(&mut watcher, file).map_err(failed)?;
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
        seen.wait(file, &changes).map_err(failed)?;
        if interrupt::is_wanted() {
            live.iter().for_each(Live::end);
            return Err(CommandError::interrupted());
        }
    }
}

/// Refuses what cannot follow a file.
fn useful(arguments: &Simulate) -> Result<(), CommandError> {
    let given = [
        (
            "--live",
            arguments.live,
            "its page follows the file; for sliders say `bricard simulate` with --live",
        ),
        (
            "--checkpoint",
            arguments.checkpoint.is_some(),
            "a checkpoint belongs to the text of the file, which changes: say `bricard simulate` \
             with --checkpoint",
        ),
        (
            "--resume",
            arguments.resume.is_some(),
            "a checkpoint belongs to the text of the file, which changes: say `bricard simulate` \
             with --resume",
        ),
    ];
    match given.into_iter().find(|(_, is_given, _)| *is_given) {
        Some((option, _, instead)) => Err(CommandError::UselessOption {
            option,
            method: "`watch`",
            instead,
        }),
        None => Ok(()),
    }
}

/// A version of a description with the files that it reads.
struct Version {
    /// What they hold; nothing if there is no description.
    text: Option<String>,
    /// The files that the description names.
    files: Vec<PathBuf>,
}

impl Version {
    fn of(file: &Path) -> Self {
        let source = fs::read(file).ok();
        let source = source.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let names = source.as_deref().into_iter().flat_map(quoted);
        let files = names.map(|name| folder(file).join(name)).collect();
        let text = source.as_deref().map(|source| identity(file, source));
        Self { text, files }
    }

    /// Listens to the folders of the files: a new file under the old name is another file.
    fn listen(&self, watcher: &mut RecommendedWatcher, file: &Path) -> Result<(), String> {
        let listened = watcher.watch(folder(file), RecursiveMode::NonRecursive);
        listened.map_err(|error| match folder(file).is_dir() {
            true => error.to_string(),
            false => format!("there is no folder {}", folder(file).display()),
        })?;
        for other in self.files.iter().map(|file| folder(file)) {
            if other != folder(file) {
                // A folder that isn't there is said to be missing by the run.
                let _missing = watcher.watch(other, RecursiveMode::NonRecursive);
            }
        }
        Ok(())
    }

    /// Waits until there is another version, or Ctrl-C.
    fn wait(&self, file: &Path, changes: &Receiver<Heard>) -> Result<(), String> {
        while !interrupt::is_wanted() {
            match changes.recv_timeout(PERIOD) {
                Ok(Ok(event)) if self.concerns(file, &event) => {
                    self.rest(file, changes);
                    let there = Self::of(file).text;
                    if there.is_some() && there != self.text {
                        break;
                    }
                }
                Ok(Ok(_)) | Err(RecvTimeoutError::Timeout) => {}
                Ok(Err(error)) => return Err(error.to_string()),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err("the system has ended the watch".to_string());
                }
            }
        }
        Ok(())
    }

    /// Waits until nothing has happened to the files for a while. Whoever writes other files
    /// of the folder again and again does not keep it from ending.
    fn rest(&self, file: &Path, changes: &Receiver<Heard>) {
        let mut until = Instant::now() + REST;
        while let Ok(heard) = changes.recv_timeout(until.saturating_duration_since(Instant::now()))
        {
            if heard.is_ok_and(|event| self.concerns(file, &event)) {
                until = Instant::now() + REST;
            }
        }
    }

    fn concerns(&self, file: &Path, event: &Event) -> bool {
        let mut names = event.paths.iter().map(|path| path.file_name());
        let reads = |name| self.files.iter().any(|own| own.file_name() == name);
        names.any(|name| name == file.file_name() || reads(name))
    }
}
