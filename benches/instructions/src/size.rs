//! Generation time, compile time and code size of rows of parallelograms.
//!
//! Each is generated here and compiled in a package of its own, below the target
//! folder, whose dependencies are compiled before.

use bricard_codegen::Builder;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

const ROWS: [u32; 6] = [2, 5, 10, 20, 40, 80];
/// Times something is generated; the median counts.
const REPEATED: usize = 5;

const MANIFEST: &str = r#"[package]
name = "row"
version = "0.1.0"
edition = "2024"

[dependencies]
bricard-runtime = { path = "RUNTIME" }

[profile.release]
codegen-units = 1

[workspace]
"#;

/// Calls everything that a run needs, so that it is compiled.
const MAIN: &str = r#"#![allow(missing_docs)]
pub mod row { include!("n_four_bar.rs"); }
use bricard_runtime::{Correction, Mechanism, Position, Acceleration, State, Terms};
use std::hint::black_box;

fn all<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(mechanism: M) {
    let state = black_box(State::default());
    let mut terms = Box::<Terms<f64, N, R>>::default();
    mechanism.terms(&state, &mut terms);
    let mut regular = Box::<Acceleration<f64, N, R>>::default();
    mechanism.acceleration(&state, &mut regular);
    let mut position = Box::<Position<f64, N, R>>::default();
    mechanism.position(&state, &mut position);
    let mut correction = Box::<Correction<f64, N, R>>::default();
    mechanism.correction(&state, &mut correction);
    black_box((terms, regular, position, correction));
}

fn main() { all(row::n_four_bar::NFourBar::default()); }
"#;

/// The table.
///
/// # Errors
///
/// What the compiler or the system says.
pub fn table() -> Result<String, Box<dyn Error>> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| here.join("../target"), PathBuf::from);
    let package = target.join("row");
    fs::create_dir_all(package.join("src"))?;
    let runtime = here.join("../../runtime").canonicalize()?;
    fs::write(
        package.join("Cargo.toml"),
        MANIFEST.replace("RUNTIME", &runtime.display().to_string()),
    )?;
    fs::write(
        package.join("src/main.rs"),
        "use bricard_runtime as _;\nfn main() {}\n",
    )?;
    compile(&package)?;
    let empty = text_size(&package)?;
    fs::write(package.join("src/main.rs"), MAIN)?;
    let mut text = String::from(
        "| loops in a row | generation (ms) | lines | rustc (s) | machine code (kB) |\n|---|--:|--:|--:|--:|\n",
    );
    for n in ROWS {
        let generated = generate(here, &package, n)?;
        let lines = fs::read_to_string(package.join("src/n_four_bar.rs"))?
            .lines()
            .count();
        let compiled = compile(&package)?;
        let size = (text_size(&package)? - empty) / 1000.0;
        let _infallible = writeln!(
            text,
            "| {n} | {:.0} | {lines} | {:.1} | {size:.1} |",
            1e3 * generated.as_secs_f64(),
            compiled.as_secs_f64()
        );
    }
    Ok(text)
}

fn generate(here: &Path, package: &Path, n: u32) -> Result<Duration, Box<dyn Error>> {
    let description = here.join("../../mechanisms/n_four_bar.mech");
    let builder = Builder::new().constant("N", n).out_dir(package.join("src"));
    let builder = ["L", "m", "v"].into_iter().fold(builder, Builder::freeze);
    let mut times = Vec::new();
    for _ in 0..REPEATED {
        let begun = Instant::now();
        builder.try_compile(&description)?;
        times.push(begun.elapsed());
    }
    times.sort();
    Ok(times[REPEATED / 2])
}

/// Compiles the package; the time it took.
fn compile(package: &Path) -> Result<Duration, Box<dyn Error>> {
    let begun = Instant::now();
    let status = Command::new("cargo")
        .args(["build", "--release", "--quiet"])
        .env("CARGO_TARGET_DIR", package.join("target"))
        .current_dir(package)
        .status()?;
    if status.success() {
        Ok(begun.elapsed())
    } else {
        Err("cargo failed".into())
    }
}

/// Size of the program's machine code (bytes).
fn text_size(package: &Path) -> Result<f64, Box<dyn Error>> {
    let output = Command::new("size")
        .arg("-A")
        .arg(package.join("target/release/row"))
        .output()?;
    let said = String::from_utf8_lossy(&output.stdout);
    let line = said.lines().find(|line| line.starts_with(".text"));
    let size = line
        .and_then(|line| line.split_whitespace().nth(1))
        .ok_or("`size` (binutils) tells no .text")?;
    Ok(size.parse()?)
}
