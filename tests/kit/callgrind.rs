//! Counting instructions by callgrind.
//!
//! In:  what the running program is to be called with.
//! Out: the instructions of that call, or of a function in it.

use std::env;
use std::error::Error;
use std::process::Command;

/// Whether valgrind can be called.
pub fn is_there() -> bool {
    Command::new("valgrind")
        .arg("--version")
        .output()
        .is_ok_and(|output| output.status.success())
}

/// Instructions of the running program from beginning to end, called with some words; `None`
/// if this valgrind does not know an instruction of it.
///
/// # Errors
///
/// A call that fails, valgrind without a count.
pub fn collected(words: &[&str]) -> Result<Option<f64>, Box<dyn Error>> {
    collect(None, words)
}

/// Instructions of the running program from beginning to end, called with some words, all of which
/// this valgrind has to know.
///
/// # Errors
///
/// As [`collected`]; an instruction that this valgrind does not know.
pub fn counted(words: &[&str]) -> Result<f64, Box<dyn Error>> {
    known(collect(None, words)?)
}

/// Instructions of a function of the running program, called with some words.
///
/// # Errors
///
/// As [`counted`].
pub fn counted_in(function: &str, words: &[&str]) -> Result<f64, Box<dyn Error>> {
    known(collect(Some(function), words)?)
}

fn known(count: Option<f64>) -> Result<f64, Box<dyn Error>> {
    let unknown = "this valgrind does not know an instruction of the program";
    Ok(count.ok_or(unknown)?)
}

fn collect(function: Option<&str>, words: &[&str]) -> Result<Option<f64>, Box<dyn Error>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .args(function.map(|function| format!("--toggle-collect=*{function}*")))
        .arg(env::current_exe()?)
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
