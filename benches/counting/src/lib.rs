//! Counting instructions.
//!
//! In:  what the running program is to be called with.
//! Out: the instructions of that call, from beginning to end.

use std::error::Error;
use std::process::Command;

/// Instructions of the running program, called with some words; `None` if this valgrind
/// does not know an instruction of it.
///
/// # Errors
///
/// A call that fails, valgrind without a count.
pub fn collected(words: &[&str]) -> Result<Option<f64>, Box<dyn Error>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe()?)
        .args(words)
        .output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    if said.contains("Unrecognised instruction") {
        return Ok(None);
    }
    let count = said
        .lines()
        .find_map(|line| line.split_once("Collected : "));
    match count {
        Some((_, count)) if output.status.success() => Ok(Some(count.trim().parse()?)),
        _ => Err(format!("callgrind could not count {}:\n{said}", words.join(" ")).into()),
    }
}

/// The same where every instruction is known.
///
/// # Errors
///
/// As [`collected`]; an instruction that this valgrind does not know.
pub fn counted(words: &[&str]) -> Result<f64, Box<dyn Error>> {
    let unknown = "this valgrind does not know an instruction of the program";
    Ok(collected(words)?.ok_or(unknown)?)
}
