//! The table of the cases, in the docs.

use crate::case::Case;
use crate::judge::judge;
use crate::{limits, masses, starts};
use std::fs;
use std::path::Path;

const INTRODUCTION: &str = "\
# Stress

What becomes of mechanisms that are driven to where simulations fail: a right answer,
or an error that says when and why. \"Right\" means that the energy adds up and that an
implicit method, which shares no coefficients with the one used, ends in the same place.
The test `stress` runs every case and writes this table.
";

/// What other tests check.
const CONCLUSION: &str = "
## Long runs

The test `long` of this package makes a thousandth of them every day, and all with
`BRICARD_LONG=1`.

| case | mechanism | comes to |
|---|---|---|
| 1e9 steps of RK4, 1e-3 s each, energy kept | pendulum | right: energy to 1e-9 of itself |
| 1e6 s by DOP853, energy kept | pendulum, point_pendulum | right: energy to 1e-7 of itself |

## Interrupted runs

The tests `command` and `resume` of the package `bricard` run the command and break it off.

| case | comes to |
|---|---|
| Ctrl-C | the rows are kept, how many and up to when is said, status 130 |
| a full disk | error: could not write … to its end, and how many rows it holds at most; status 1 |
| a reader of standard output that has gone | the run ends in silence |
| taken up again from a checkpoint | the same bytes as in one piece |
| a checkpoint that is cut off, changed, or of another run | error: can't go on from …, and why; no row is written, status 2 |
";

/// Characters of a number that are shown.
const LONGEST: usize = 8;
/// Below this, a number in a message only round-off decides.
const TINY: f64 = 1e-8;

fn cases() -> impl Iterator<Item = &'static Case> {
    masses::CASES
        .iter()
        .chain(starts::CASES)
        .chain(limits::CASES)
}

#[test]
fn every_case_ends_in_a_right_answer_or_an_error_that_says_when_and_why() {
    let mut text = INTRODUCTION.to_string();
    let (mut kind, mut broken) = ("", Vec::new());
    for case in cases() {
        if case.kind != kind {
            kind = case.kind;
            text += &format!("\n## {kind}\n\n| case | mechanism | comes to |\n|---|---|---|\n");
        }
        match judge(case) {
            Ok(said) => {
                let said = shortened(&said);
                text += &format!("| {} | {} | {said} |\n", case.what, case.mechanism);
            }
            Err(complaint) => broken.push(complaint),
        }
    }
    text += CONCLUSION;
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/stress.md");
    if std::env::var_os("BRICARD_BLESS").is_some() {
        fs::write(&path, &text).expect("the docs can be written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == text,
        "docs/stress.md is not what the runs came to; write it with BRICARD_BLESS=1"
    );
}

/// A text without what is round-off in it: the digits of long numbers, tiny numbers, and the times
/// after the start at which runs failed.
fn shortened(text: &str) -> String {
    let words: Vec<&str> = text.split(' ').collect();
    let after = |i: usize| i.checked_sub(2).map(|before| &words[before..i]);
    let short = words.iter().enumerate().map(|(i, word)| {
        let number = word.trim_end_matches(|c: char| !c.is_ascii_digit());
        let rest = &word[number.len()..];
        match number.parse::<f64>() {
            Ok(time) if after(i) == Some(&["t", "="]) && time > 0.0 => format!("…{rest}"),
            Ok(tiny) if tiny != 0.0 && tiny.abs() < TINY => format!("(tiny){rest}"),
            Ok(_) if number.len() > LONGEST => format!("{}…{rest}", &number[..LONGEST]),
            _ => (*word).to_string(),
        }
    });
    short.collect::<Vec<_>>().join(" ")
}
