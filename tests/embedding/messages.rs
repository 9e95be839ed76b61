//! What the C interface says where it refuses something, and the section of the page.
//!
//! A program in C brings it about; the sentences are those of the interface's sources. What
//! the runtime says through it stands in a section of its own.

use crate::program::{Language, Linked, compile, finished};
use bricard_testkit::page::{code, hold_section, prose, row};
use bricard_testkit::sentences::{Sentence, sentences};
use std::path::Path;
use std::process::Command;

/// The interface.
const SOURCES: &str = "capi/src";

/// What the header says where there is no mechanism.
const NOTHING: &str = "the mechanism is NULL";

/// What the program does not bring about, and why.
const ELSEWHERE: [(&str, &str); 2] = [
    (
        "internal error, please report",
        "the library itself has a defect",
    ),
    (
        "this mechanism has no derivatives",
        "python/tests/test_messages.py: it is too large",
    ),
];

const INTRODUCTION: &str = "\
`bricard_message` says them; the status is what the call returned. They are about the engine \
of `tests/embedding`, which has one input. Starts, options and runs are refused in the words \
of [starts and runs](#starts-and-runs), too: `BRICARD_ERROR_ASSEMBLY`, `BRICARD_ERROR_ARGUMENT`, \
`BRICARD_ERROR_RUN`.
";

/// What the program printed: statuses, what brought them about, messages.
fn said() -> Vec<[String; 3]> {
    let program = compile("misuse", Language::C, Linked::Shared);
    let text = finished(&mut Command::new(program));
    let line = |line: &str| {
        let cells: Vec<String> = line.split('\t').map(String::from).collect();
        cells.try_into().expect("three cells")
    };
    text.lines().map(line).collect()
}

/// The message with `…` in place of numbers that depend on steps.
fn steady(message: &str) -> String {
    match message.split_once(" s ") {
        Some((before, after)) if before.starts_with("at t = ") => format!("at t = … s {after}"),
        _ => message.to_string(),
    }
}

#[test]
fn the_page_of_messages_shows_what_the_c_interface_says() {
    let said = said();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let own = sentences(&root, SOURCES);
    assert!(own.len() > 30, "only {} texts", own.len());
    let is_said = |sentence: &Sentence| said.iter().any(|[.., text]| sentence.is_in(text));
    let is_elsewhere = |sentence: &Sentence| {
        let place = &sentence.place;
        ELSEWHERE.iter().any(|(text, _)| place.contains(text))
    };
    let whole = own.iter().filter(|sentence| sentence.is_whole());
    let wrong: Vec<&str> = whole
        .filter(|sentence| is_said(sentence) == is_elsewhere(sentence))
        .map(|sentence| sentence.place.as_str())
        .collect();
    assert!(
        wrong.is_empty(),
        "never said, or said after all:\n{}",
        wrong.join("\n")
    );

    let mut shown: Vec<&str> = Vec::new();
    let mut rows = String::new();
    for [status, how, message] in &said {
        let of = own
            .iter()
            .filter(|sentence| sentence.is_whole() && sentence.is_in(message));
        let of = of.max_by_key(|sentence| sentence.length());
        let of = of.map(|sentence| sentence.place.as_str());
        let Some(of) = of.or((message == NOTHING).then_some(NOTHING)) else {
            continue;
        };
        if !shown.contains(&of) {
            rows += &row(&[prose(&steady(message)), code(status), how.clone()]);
            shown.push(of);
        }
    }
    let head = "\n| message | status | brought about by |\n|---|---|---|\n";
    let text = format!("{INTRODUCTION}{head}{rows}");
    hold_section(&root.join("docs/messages.md"), "The C interface", &text);
}
