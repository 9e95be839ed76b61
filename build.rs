//! Collects the sources that a compiled description needs, for the command to carry along.

use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// What a program, or a library, of one mechanism is built from.
const SHARED: [&str; 13] = [
    "Cargo.toml",
    "Cargo.lock",
    "capi/Cargo.toml",
    "capi/include",
    "capi/src",
    "runtime/Cargo.toml",
    "runtime/src",
    "driver/Cargo.toml",
    "driver/src",
    "reference/Cargo.toml",
    "reference/src",
    "wasm/Cargo.toml",
    "wasm/src",
];

/// What makes a program of it.
const MAKERS: [&str; 3] = ["codegen/Cargo.toml", "codegen/src", "cli/compiled"];

/// Writes `OUT_DIR/sources.rs`: a key, which changes with the sources and with what makes a
/// program of them, and pairs of paths and texts, in alphabetical order.
fn main() -> Result<(), Box<dyn Error>> {
    let (shared, makers) = (below(&SHARED)?, below(&MAKERS)?);
    let mut key = DefaultHasher::new();
    for file in shared.iter().chain(&makers) {
        (file, fs::read(file)?).hash(&mut key);
    }
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let mut text = format!("({}, &[\n", key.finish());
    for file in shared {
        let name = file.to_string_lossy().replace('\\', "/");
        let place = root.join(file);
        text.push_str(&format!("({name:?}, include_str!({place:?})),\n"));
    }
    text.push_str("])");
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("sources.rs"), text)?;
    Ok(())
}

/// All files of some folders.
fn below(folders: &[&str]) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut files = Vec::new();
    for folder in folders {
        println!("cargo::rerun-if-changed={folder}");
        // A package in a registry is without the others: the command is built from a checkout.
        collect(Path::new(folder), &mut files).map_err(|error| format!("{folder}: {error}"))?;
    }
    files.sort();
    Ok(files)
}

/// All files of a folder, or one file.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if !path.is_dir() {
        files.push(path.to_path_buf());
        return Ok(());
    }
    for entry in fs::read_dir(path)? {
        collect(&entry?.path(), files)?;
    }
    Ok(())
}
