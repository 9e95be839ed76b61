//! Wrong descriptions and the exact message each of them gets.
//!
//! `BRICARD_BLESS=1` rewrites the messages; read them in the diff as a user would.

use bricard_codegen::CompileSettings;
use bricard_codegen::internals::examine;
use std::fs;
use std::path::{Path, PathBuf};

/// The least number of pairs.
const PAIRS: usize = 80;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong")
}

/// The descriptions, sorted by name.
fn descriptions() -> Vec<PathBuf> {
    let entries = fs::read_dir(folder()).expect("the folder of wrong descriptions");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "mech"))
        .collect();
    paths.sort();
    paths
}

/// What is said about a description: errors, or warnings.
fn message(path: &Path) -> String {
    let source = fs::read_to_string(path).expect("a wrong description");
    said(path, &source)
}

/// What is said about the text of a description.
fn said(path: &Path, source: &str) -> String {
    let name = path
        .file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default();
    match examine(source, &CompileSettings::default()) {
        Ok((_, warnings)) => warnings.render(&name, source),
        Err(errors) => errors.render(&name, source),
    }
}

#[test]
fn every_wrong_description_gets_its_message() {
    let bless = std::env::var_os("BRICARD_BLESS").is_some();
    let mut differing = Vec::new();
    for path in descriptions() {
        let expected = path.with_extension("txt");
        let found = message(&path);
        assert!(
            !found.is_empty(),
            "nothing is said about {}",
            path.display()
        );
        if bless {
            fs::write(&expected, found).expect("a message that can be written");
        } else if fs::read_to_string(&expected).unwrap_or_default() != found {
            differing.push(format!("{}:\n{found}", path.display()));
        }
    }
    let list = differing.join("\n");
    assert!(
        differing.is_empty(),
        "{list}\nBRICARD_BLESS=1 rewrites the messages"
    );
}

#[test]
fn lines_that_end_as_in_windows_get_the_same_messages() {
    for path in descriptions() {
        let source = fs::read_to_string(&path).expect("a wrong description");
        if !source.contains('\r') {
            let other = said(&path, &source.replace('\n', "\r\n"));
            assert_eq!(other, said(&path, &source), "{}", path.display());
        }
    }
}

#[test]
fn every_message_belongs_to_a_description_and_there_are_enough() {
    let descriptions = descriptions();
    assert!(descriptions.len() >= PAIRS, "{} pairs", descriptions.len());
    for entry in fs::read_dir(folder()).expect("the folder") {
        let path = entry.expect("an entry").path();
        assert!(
            path.with_extension("mech").exists(),
            "{} is about nothing",
            path.display()
        );
    }
}
