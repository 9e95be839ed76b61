//! The mechanisms of the library pass without a word.

use super::{accept, warnings};
use std::fs;
use std::path::{Path, PathBuf};

/// Every description in the library.
pub fn library() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms");
    let entries = fs::read_dir(&folder).expect("the library of mechanisms");
    let paths = entries.map(|entry| entry.expect("an entry of the library").path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "mech"))
        .collect();
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a description");
        (path, text)
    };
    paths.into_iter().map(read).collect()
}

#[test]
fn every_mechanism_of_the_library_is_right_and_nothing_in_it_is_unused() {
    let library = library();
    assert!(library.len() >= 7, "{} mechanisms", library.len());
    for (path, source) in library {
        assert_eq!(warnings(&source), "", "{}", path.display());
    }
}

#[test]
fn every_mechanism_of_the_library_says_what_it_is_and_shows_it() {
    for (path, source) in library() {
        let m = accept(&source);
        assert!(!m.docs.is_empty(), "{} has no doc comment", path.display());
        assert!(!m.shapes.is_empty(), "{} has no picture", path.display());
        assert!(!m.starts.is_empty(), "{} has no start", path.display());
        assert!(!m.outputs.is_empty(), "{} has no output", path.display());
    }
}

#[test]
fn the_mechanisms_have_the_sizes_of_the_paper() {
    let sizes = |name: &str| {
        let found = library().into_iter().find(|(path, _)| path.ends_with(name));
        let m = accept(&found.unwrap_or_else(|| panic!("no {name}")).1);
        (m.coordinates.len(), m.constraints.len())
    };
    assert_eq!(sizes("slider_crank.mech"), (3, 2));
    assert_eq!(sizes("slider_crank_driven.mech"), (3, 2));
    assert_eq!(sizes("double_four_bar.mech"), (5, 4));
    assert_eq!(sizes("double_pendulum.mech"), (2, 0));
    assert_eq!(sizes("cart_pole.mech"), (2, 0));
}
