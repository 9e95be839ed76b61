//! Compiles the mechanisms whose forces jump, one of them with files of many points beside
//! it.

use bricard_codegen::Builder;
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs};

mod points;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::var("OUT_DIR")?);
    for (name, count) in [("thousand.csv", 1_000), ("many.csv", 10_000)] {
        let mut text = String::new();
        for [place, value] in points::points(count) {
            writeln!(text, "{place},{value}")?;
        }
        fs::write(folder.join(name), text)?;
    }
    for name in [
        "contact", "friction", "frozen", "looped", "placed", "tabled", "timed",
    ] {
        Builder::new().compile(format!("{name}.mech"))?;
    }
    println!("cargo::rerun-if-changed=points.rs");
    println!("cargo::rerun-if-changed=measured.mech");
    let measured = folder.join("measured.mech");
    fs::copy("measured.mech", &measured)?;
    Builder::new().compile(measured)?;
    Ok(())
}
