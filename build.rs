//! Compiles every description in `mechanisms/`, and collects the sources that a compiled
//! description needs, for the command to carry along.

use bricard_codegen::Builder;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// What a program of one mechanism is built from.
const SHARED: [&str; 8] = [
    "Cargo.toml",
    "Cargo.lock",
    "runtime/Cargo.toml",
    "runtime/src",
    "driver/Cargo.toml",
    "driver/src",
    "reference/Cargo.toml",
    "reference/src",
];

fn main() -> Result<(), Box<dyn Error>> {
    Builder::new()
        .coriolis_matrix(true)
        .compile_dir("mechanisms")?;
    embed()
}

/// Writes `OUT_DIR/sources.rs`: pairs of paths and texts, in alphabetical order.
fn embed() -> Result<(), Box<dyn Error>> {
    let mut files = Vec::new();
    for shared in SHARED {
        println!("cargo::rerun-if-changed={shared}");
        // A package in a registry is without the others: the command is built from a checkout.
        collect(Path::new(shared), &mut files).map_err(|error| format!("{shared}: {error}"))?;
    }
    files.sort();
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let mut list = String::from("[\n");
    for file in files {
        let name = file.to_string_lossy().replace('\\', "/");
        list.push_str(&format!(
            "({name:?}, include_str!({:?})),\n",
            root.join(file)
        ));
    }
    list.push(']');
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("sources.rs"), list)?;
    Ok(())
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
