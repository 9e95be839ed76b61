//! The map of the code names files and folders that are there.

use crate::source::{read, root};
use std::path::Path;

/// What a name on the page has to end with to be one of a file or folder.
const ENDINGS: [&str; 6] = [".rs", ".md", ".mech", ".h", "/", "/run"];

/// The names between backticks that are paths.
fn paths(line: &str) -> impl Iterator<Item = &str> {
    let names = line.split('`').skip(1).step_by(2);
    names.filter(|name| {
        let stem = name.trim_end_matches('/');
        let is_plain = stem
            .chars()
            .all(|sign| sign.is_alphanumeric() || "/_.".contains(sign));
        is_plain && !stem.starts_with('.') && ENDINGS.iter().any(|end| name.ends_with(end))
    })
}

/// Whether there is a path in one of some folders.
fn is_in(folders: &[&Path], path: &str) -> bool {
    folders
        .iter()
        .any(|folder| root().join(folder).join(path).exists())
}

/// A line may begin with the folder that it is about, and so may the lines above it: `linalg/`
/// below `runtime/src/`.
#[test]
fn every_path_of_the_architecture_is_there() {
    let page = read("ARCHITECTURE.md");
    let (mut missing, mut count) = (Vec::new(), 0);
    let mut package = Path::new("");
    for line in page.lines() {
        let first = paths(line).next();
        if let Some(folder) = first.filter(|name| line.starts_with('`') && name.ends_with('/')) {
            package = Path::new(folder);
        } else if line.starts_with('#') {
            package = Path::new("");
        }
        let stage = first.filter(|name| line.starts_with("- `") && name.ends_with('/'));
        let stage = stage.map_or(package.to_path_buf(), |name| package.join(name));
        let folders = [Path::new(""), package, &stage];
        for path in paths(line) {
            count += 1;
            if !is_in(&folders, path) {
                missing.push(format!("`{path}` in: {line}"));
            }
        }
    }
    assert!(count > 100, "only {count} paths");
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
