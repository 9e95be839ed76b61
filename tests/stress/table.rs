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

/// The same text with numbers cut to a few characters: the rest is round-off.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 8;
    let mut short = String::new();
    let mut length = 0;
    for c in text.chars() {
        length = if c.is_ascii_digit() || c == '.' {
            length + 1
        } else {
            0
        };
        match length.cmp(&(LONGEST + 1)) {
            std::cmp::Ordering::Less => short.push(c),
            std::cmp::Ordering::Equal => short.push('…'),
            std::cmp::Ordering::Greater => {}
        }
    }
    short
}
