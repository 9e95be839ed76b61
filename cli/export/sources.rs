//! The sources of bricard that an exported crate is built with, as packages that stand
//! alone.
//!
//! In:  the sources that the command carries; a description.
//! Out: the same in a folder, manifests without a workspace; the description with the files
//!      that it reads.

use super::folder::{Folder, is_inside};
use crate::compiled::sources::SOURCES;
use crate::description::{Description, read};
use crate::error::CommandError;
use bricard_codegen::Compiled;
use std::path::Path;

/// Where they are in an exported crate.
pub const PLACE: &str = "bricard";

/// Writes packages by the names of their folders.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn write(folder: &Folder, packages: &[&str]) -> Result<(), CommandError> {
    folder.write_all(files(packages))
}

/// A description and the files that it reads in its folder or below, as paths with texts. What
/// it reads elsewhere has no place beside it.
///
/// # Errors
///
/// [`CommandError::Read`].
pub fn described(
    module: &str,
    subject: &Description,
    compiled: &Compiled,
) -> Result<Vec<(String, String)>, CommandError> {
    let mut files = vec![(format!("{module}.mech"), subject.source.clone())];
    let above = subject.file.parent().unwrap_or(Path::new(""));
    for path in &compiled.files {
        let name = path.strip_prefix(above).ok();
        if let Some(name) = name.filter(|name| is_inside(name)) {
            // Other systems know `/` as well.
            let name = name.to_string_lossy().replace('\\', "/");
            files.push((name, read(path)?));
        }
    }
    files.sort();
    files.dedup();
    Ok(files)
}

/// Packages by the names of their folders, as paths with texts.
pub fn files(packages: &[&str]) -> impl Iterator<Item = (String, String)> {
    let wanted = |name: &str| {
        let package = name.split('/').next().unwrap_or_default();
        packages.contains(&package)
    };
    let files = SOURCES.1.iter().filter(move |(name, _)| wanted(name));
    files.map(|(name, text)| {
        let text = match name.ends_with("Cargo.toml") {
            true => standalone(text, workspace()),
            false => (*text).to_string(),
        };
        (format!("{PLACE}/{name}"), text)
    })
}

/// The manifest of the workspace.
fn workspace() -> &'static str {
    let all = SOURCES.1.iter();
    all.filter(|(name, _)| *name == "Cargo.toml")
        .map(|(_, text)| *text)
        .next()
        .unwrap_or_default()
}

/// The manifest of a package with what it has from the workspace written out, and without
/// what only tests and lints need.
fn standalone(manifest: &str, workspace: &str) -> String {
    let mut text = String::new();
    let mut section = "";
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line;
        }
        if section.starts_with("[lints") || section.starts_with("[dev") || section == "[[test]]" {
            continue;
        }
        match line.split_once(".workspace = true") {
            None => text += line,
            Some((key, _)) => text += &inherited(workspace, section, key),
        }
        text.push('\n');
    }
    text.trim_end().to_string() + "\n"
}

/// A line of the workspace that a package has from it; packages lie side by side here as
/// they do there.
fn inherited(workspace: &str, section: &str, key: &str) -> String {
    let table = format!("[workspace.{}", section.trim_start_matches('['));
    let inside = workspace.split_once(&table).map_or("", |(_, after)| after);
    let mut lines = inside.lines().take_while(|line| !line.starts_with('['));
    let begin = format!("{key} = ");
    let line = lines.find(|line| line.starts_with(&begin));
    line.unwrap_or_default()
        .replace("path = \"", "path = \"../")
}

/// `Cargo.toml` of an exported crate.
pub fn manifest(name: &str, about: &str, library: &str, packages: &[&str]) -> String {
    let dependency = |package: &&str| {
        let path = Path::new(PLACE).join(package);
        format!("bricard-{package} = {{ path = {path:?} }}\n")
    };
    let dependencies: String = packages.iter().map(dependency).collect();
    format!(
        "[package]
name = \"{name}\"
description = {about:?}
version = \"0.1.0\"
edition = \"2024\"
publish = false

[lib]
{library}
[dependencies]
{dependencies}
# A package of its own, wherever it lies.
[workspace]
exclude = [\"{PLACE}\"]
"
    )
}

#[cfg(test)]
mod tests {
    use super::standalone;

    #[test]
    fn a_manifest_stands_alone() {
        let workspace = "[workspace.package]\nversion = \"1.2.3\"\n\n[workspace.dependencies]\n\
                         other = { path = \"other\", version = \"1.2.3\" }\n";
        let manifest = "[package]\nname = \"one\"\nversion.workspace = true\n\n[[test]]\n\
                        name = \"main\"\n\n[dependencies]\nother.workspace = true\n\n\
                        [dev-dependencies]\nmore = \"1\"\n\n[lints]\nworkspace = true\n";
        let alone = "[package]\nname = \"one\"\nversion = \"1.2.3\"\n\n[dependencies]\n\
                     other = { path = \"../other\", version = \"1.2.3\" }\n";
        assert_eq!(standalone(manifest, workspace), alone);
    }
}
