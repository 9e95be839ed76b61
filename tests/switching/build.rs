//! Compiles the mechanisms whose forces jump, one of them with files of many points beside
//! it.

use bricard_codegen::Builder;
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

mod points;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::var("OUT_DIR")?);
    for (name, count) in [("thousand.csv", 1_000), ("many.csv", 10_000)] {
        let mut text = String::new();
        for [place, value] in points::points(count) {
            writeln!(text, "{place},{value}")?;
        }
        write(&folder.join(name), &text)?;
    }
    for name in [
        "contact",
        "cranked",
        "drawn",
        "friction",
        "frozen",
        "gripped",
        "jointed",
        "jointed_reduced",
        "kicked",
        "knotted",
        "looped",
        "parallelogram",
        "paused",
        "placed",
        "pulsed",
        "released",
        "saturated",
        "shifted",
        "slowing",
        "stopping",
        "tabled",
        "timed",
        "warmed",
    ] {
        Builder::new().compile(format!("{name}.mech"))?;
    }
    println!("cargo::rerun-if-changed=points.rs");
    println!("cargo::rerun-if-changed=measured.mech");
    let measured = folder.join("measured.mech");
    write(&measured, &fs::read_to_string("measured.mech")?)?;
    Builder::new().compile(measured)?;
    Ok(())
}

/// Writes a file that cargo watches, unless it holds this already: a file that is newer than
/// the last run of this program is a reason to run it again.
fn write(path: &Path, text: &str) -> io::Result<()> {
    match fs::read_to_string(path) {
        Ok(known) if known == text => Ok(()),
        _ => fs::write(path, text),
    }
}
