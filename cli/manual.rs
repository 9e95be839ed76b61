//! `bricard completions`, `bricard man`: the command line, for shells and for `man`.
//!
//! In:  the definition of the command line.
//! Out: a script on standard output; pages in a folder.

use crate::arguments::{Arguments, Completions, Man, ShellName};
use crate::error::CommandError;
use crate::output::{print, say};
use clap::CommandFactory;
use clap_complete::{Shell, generate};
use std::fs;

impl From<ShellName> for Shell {
    fn from(name: ShellName) -> Self {
        match name {
            ShellName::Bash => Shell::Bash,
            ShellName::Elvish => Shell::Elvish,
            ShellName::Fish => Shell::Fish,
            ShellName::PowerShell => Shell::PowerShell,
            ShellName::Zsh => Shell::Zsh,
        }
    }
}

/// Prints what makes a shell complete the command's words.
///
/// # Errors
///
/// As [`print`].
pub fn completions(arguments: &Completions) -> Result<(), CommandError> {
    let mut script = Vec::new();
    let shell = Shell::from(arguments.shell);
    generate(shell, &mut Arguments::command(), "bricard", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Writes a page of the manual for the command and one for each of its commands.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn man(arguments: &Man) -> Result<(), CommandError> {
    let folder = &arguments.folder;
    let failed = |error| CommandError::write(folder, error);
    fs::create_dir_all(folder).map_err(failed)?;
    clap_mangen::generate_to(Arguments::command(), folder).map_err(failed)?;
    say(&format!("the pages are in {}", folder.display()));
    Ok(())
}
