//! The Rust toolchain.
//!
//! In:  command lines of `cargo` and `rustc`.
//! Out: what they print, or why they failed.
//!
//! What the user's environment says about builds is not passed on: the programs in the
//! cache are the same for everyone who builds them.

use crate::error::CommandError;
use crate::output::say;
use std::env;
use std::io;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Variables of the environment that would change what is built, by how they begin.
const MEDDLING: [&str; 6] = [
    "CARGO_BUILD_",
    "CARGO_ENCODED_RUSTFLAGS",
    "CARGO_PROFILE_",
    "CARGO_TARGET_",
    "RUSTC",
    "RUSTFLAGS",
];

/// After this time it is worth a word that the compiler still works.
const PATIENCE: Duration = Duration::from_secs(30);

/// The toolchain.
#[derive(Clone, Debug)]
pub struct Toolchain {
    /// All that `rustc` says about itself.
    pub identity: String,
    /// The machine it compiles for.
    pub host: String,
}

impl Toolchain {
    /// The toolchain of the user.
    ///
    /// # Errors
    ///
    /// [`CommandError::Compile`] if there is none.
    pub fn find() -> Result<Self, CommandError> {
        let mut rustc = command("rustc");
        rustc.arg("-vV");
        let output = output(rustc, &env::temp_dir(), "`rustc -vV` failed")?;
        let identity = String::from_utf8_lossy(&output.stdout).into_owned();
        let host = identity
            .lines()
            .find_map(|line| line.strip_prefix("host: "));
        let host = host.unwrap_or_default().to_string();
        Ok(Self { identity, host })
    }
}

/// A command of the toolchain.
pub fn command(name: &str) -> Command {
    let mut command = Command::new(name);
    let meddles = |name: &str| MEDDLING.iter().any(|begin| name.starts_with(begin));
    for (name, _) in env::vars_os().filter(|(name, _)| name.to_str().is_some_and(meddles)) {
        command.env_remove(name);
    }
    command
}

/// Runs a command of the toolchain in a folder to its end. `failed` says what it means
/// that it fails.
///
/// # Errors
///
/// [`CommandError::Compile`], with what the command says.
pub fn output(mut command: Command, folder: &Path, failed: &str) -> Result<Output, CommandError> {
    let name = command.get_program().to_string_lossy().into_owned();
    let (done, waiting) = channel::<()>();
    thread::spawn(move || {
        if waiting.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
            say(
                "still compiling; Ctrl-C ends it and leaves nothing behind (`bricard show` tells \
                 how many operations a description comes to)",
            );
        }
    });
    let output = command
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| missing(&name, &error))?;
    drop(done);
    match output.status.success() {
        true => Ok(output),
        false => {
            let said = String::from_utf8_lossy(&output.stderr);
            let status = output.status;
            let room = match said.contains("os error 28") || said.contains("No space left") {
                true => "\nthe disk is full: make room, or name another folder with XDG_CACHE_HOME",
                false => "",
            };
            Err(CommandError::Compile(format!(
                "{failed} ({name}: {status})\n{}{room}",
                said.trim_end()
            )))
        }
    }
}

fn missing(name: &str, error: &io::Error) -> CommandError {
    CommandError::Compile(match error.kind() {
        io::ErrorKind::NotFound => format!(
            "`{name}` was not found: descriptions are compiled by Rust, so install it (rustup), \
             or put the folder of `{name}` on the PATH"
        ),
        _ => format!("`{name}` could not be started: {error}"),
    })
}
