//! Every reason for which the command may refuse can be brought about, and is told with
//! what to do; so is every value that it can't read.
//!
//! The reasons, and the sentences about values, are read from the command's sources, so that
//! a new one needs a case here. The cases stand on the page of messages.

mod refusals;
mod values;

use crate::command::{folder, read};
use bricard_testkit::page::{code, hold_section, prose, row};
use bricard_testkit::sentences::sentences;
use bricard_testkit::variants;
use refusals::{CASES, Case, PARQUET, WITHOUT_PARQUET};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What is said where a folder is not fit to keep what is compiled.
const SPOILT: &str = "could not keep what was compiled in …CACHEDIR.TAG: …; name another \
                      folder with XDG_CACHE_HOME";

const INTRODUCTION: &str = "\
The command ends with status 2 where the command line is wrong, and with 1 where something \
else is. `broken.mech` and `notes.txt` are wrong descriptions, `crane` is a folder, and `…` stands for what \
depends on the machine or follows from what is above.
";

/// Reasons that no command line alone brings about: the test that does, or why none can.
const ELSEWHERE: [(&str, &str); 6] = [
    ("Interrupted", "command.rs"),
    ("NobodyReads", "command.rs"),
    ("WriteRows", "command.rs: some systems have no full disk"),
    ("Cache", "here: its folder has to be spoilt"),
    ("Draw", "none: a library that draws has failed"),
    ("OutOfBounds", "none: this program has failed"),
];

/// The variants of the command's error, as its source declares them.
fn reasons() -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cli/error.rs");
    variants(&path, "CommandError").into_iter().collect()
}

/// A folder with wrong descriptions and something in the way.
fn place(test: &str) -> std::path::PathBuf {
    let folder = folder(test);
    let wrong = "mechanism Broken { coord q: rad; kinetic L9*der(q)^2; }";
    fs::write(folder.join("broken.mech"), wrong).expect("the folder is ours");
    fs::write(folder.join("notes.txt"), wrong).expect("the folder is ours");
    fs::create_dir(folder.join("crane")).expect("the folder is ours");
    folder
}

/// The command in a folder, where nothing says where a cache may be.
fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bricard"));
    command.current_dir(folder);
    for name in ["XDG_CACHE_HOME", "HOME", "LOCALAPPDATA"] {
        command.env_remove(name);
    }
    command
}

/// Whether a text contains the parts between `…` one after the other.
fn says(text: &str, expected: &str) -> bool {
    let mut rest = text;
    expected.split('…').all(|part| match rest.split_once(part) {
        Some((_, after)) => {
            rest = after;
            true
        }
        None => false,
    })
}

#[test]
fn every_refusal_says_what_is_wrong_and_what_to_do() {
    let folder = place("messages");
    let mut wrong = String::new();
    let of_this_build = match cfg!(feature = "parquet") {
        true => PARQUET,
        false => WITHOUT_PARQUET,
    };
    for (reason, line, status, expected) in CASES.iter().chain([&of_this_build]) {
        let output = command(&folder).args(line.split_whitespace()).output();
        let ran = read(output.expect("the command starts"));
        let silent = expected.is_empty() && !ran.err.is_empty();
        if ran.status != Some(*status) || silent || !says(&ran.err, expected) {
            let (code, err) = (ran.status, ran.err);
            wrong += &format!("{reason}: {line}: {code:?}\n{err}\nand not\n{expected}\n\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_cache_that_cannot_be_kept_is_told_with_how_to_move_it() {
    let folder = folder("spoilt_cache");
    fs::create_dir_all(folder.join("bricard/CACHEDIR.TAG")).expect("the folder is ours");
    let mut command = command(&folder);
    command
        .env("XDG_CACHE_HOME", &folder)
        .args(["cache", "--clear"]);
    let ran = read(command.output().expect("the command starts"));
    assert_eq!(ran.status, Some(1), "{}", ran.err);
    assert!(says(&ran.err, SPOILT), "{}", ran.err);
}

/// The page shows it in every build.
#[test]
fn what_is_said_without_parquet_is_what_the_sources_say() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let said = sentences(root, "cli/without_parquet.rs");
    assert_eq!(said.len(), 1);
    assert!(said[0].is_in(WITHOUT_PARQUET.3), "{}", said[0].place);
}

#[test]
fn every_reason_has_a_case() {
    let cases = CASES.iter().map(|(reason, ..)| *reason);
    let others = ELSEWHERE.iter().map(|(reason, _)| *reason);
    let told: BTreeSet<String> = cases.chain(others).map(String::from).collect();
    assert_eq!(told, reasons());
    let twice = ELSEWHERE
        .iter()
        .find(|(reason, _)| CASES.iter().any(|(of, ..)| of == reason));
    assert_eq!(twice, None);
}

#[test]
fn the_page_of_messages_shows_the_refusals() {
    let spoilt = ("Cache", "cache --clear", 1, SPOILT);
    let shown = |case: &Case, note: &str| {
        let (_, line, status, said) = case;
        let line = code(&format!("bricard {line}"));
        row(&[prose(said), status.to_string(), format!("{line}{note}")])
    };
    let cases = CASES.iter().chain([&spoilt, &PARQUET]);
    let cases = cases.filter(|(.., said)| !said.is_empty());
    let mut rows: Vec<String> = cases.map(|case| shown(case, "")).collect();
    rows.push(shown(
        &WITHOUT_PARQUET,
        ", built with `--no-default-features`",
    ));
    rows.sort();
    let head = "\n| message | status | command |\n|---|---|---|\n";
    let text = format!("{INTRODUCTION}{head}{}\n{}", rows.concat(), values::table());
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/messages.md");
    hold_section(&page, "The command", &text);
}
