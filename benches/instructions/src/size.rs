//! Straight lines beside loops: generation and compile time, code size, and the time of an
//! acceleration.
//!
//! Each mechanism is generated here in both forms and compiled in a package of its own, below
//! the target folder, whose dependencies are compiled before.

use bricard_codegen::Builder;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Loops in a row, bodies with Euler parameters, rods in joint angles.
const MECHANISMS: [(&str, &str, &[u32]); 3] = [
    (
        "../../mechanisms/n_four_bar",
        "NFourBar",
        &[5, 10, 20, 40, 80, 160, 320],
    ),
    ("mechanisms/closed_bodies", "ClosedBodies", &[5, 10, 20, 50]),
    ("mechanisms/joint_chain", "JointChain", &[25, 50, 100, 200]),
];
/// The longest straight lines that are waited for: rows, bodies, rods.
const STRAIGHT_MOST: [u32; 3] = [80, 20, 100];
/// Processors that compilers build for when they are not told, and those whose instructions fuse
/// products with sums.
const TARGETS: [&str; 2] = ["x86-64", "x86-64-v3"];
/// From how many operations on there are loops, by form.
const FORMS: [(&str, usize); 2] = [("straight", usize::MAX), ("loops", 0)];
/// Times something is repeated; the median counts.
const REPEATED: usize = 5;

const HEAD: &str = "| | form | lines | generation (s) | rustc (s) | machine code (kB) | q̈, x86-64 (µs) | q̈, x86-64-v3 (µs) |
|---|---|--:|--:|--:|--:|--:|--:|
";

const MANIFEST: &str = r#"[package]
name = "form"
version = "0.1.0"
edition = "2024"

[dependencies]
bricard-runtime = { path = "RUNTIME" }

[profile.release]
codegen-units = 1

[workspace]
"#;

/// Calls everything that a run needs, so that it is compiled, and prints the median time of an
/// acceleration (µs).
const MAIN: &str = r#"#![allow(missing_docs)]
pub mod form { include!("MODULE.rs"); }
use bricard_runtime::{Acceleration, Correction, Mechanism, Position, State, Terms};
use std::hint::black_box;
use std::time::Instant;

fn all<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(mechanism: M) {
    let mut state = State::<f64, N>::default();
    for (i, q) in state.q.iter_mut().enumerate() { *q = 0.3 + 0.1 * (i as f64).sin(); }
    for (i, v) in state.v.iter_mut().enumerate() { *v = (i as f64).cos(); }
    let state = black_box(state);
    let mut terms = Box::<Terms<f64, N, R>>::default();
    mechanism.terms(&state, &mut terms);
    let mut position = Box::<Position<f64, N, R>>::default();
    mechanism.position(&state, &mut position);
    let mut correction = Box::<Correction<f64, N, R>>::default();
    correction.weights.fill(1.0);
    mechanism.correction(&state, &mut correction);
    let mut acceleration = Box::<Acceleration<f64, N, R>>::default();
    acceleration.weights.fill(1.0);
    let mut times = Vec::new();
    for _ in 0..501 {
        let begun = Instant::now();
        for _ in 0..20 {
            mechanism.acceleration(black_box(&state), black_box(&mut *acceleration));
        }
        times.push(begun.elapsed().as_secs_f64() / 20.0);
    }
    times.sort_by(f64::total_cmp);
    black_box((terms, position, correction));
    print!("{}", 1e6 * times[times.len() / 2]);
}

fn main() { all(form::MODULE::TYPE::default()); }
"#;

/// The table.
///
/// # Errors
///
/// What the compiler or the system says.
pub fn table() -> Result<String, Box<dyn Error>> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let packages = TARGETS.map(|target| Package::new(here, target));
    let [plain, fused] = packages;
    let packages = [plain?, fused?];
    let mut text = String::from(HEAD);
    for ((path, kind, counts), most) in MECHANISMS.into_iter().zip(STRAIGHT_MOST) {
        for &n in counts {
            for (form, unrolled) in FORMS {
                if form == "straight" && n > most {
                    continue;
                }
                eprintln!("{kind} {n}, {form}");
                let mut columns = Vec::new();
                for package in &packages {
                    columns.push(package.measure(&here.join(path), kind, (n, unrolled))?);
                }
                let [first, second] = [&columns[0], &columns[1]];
                let _infallible = writeln!(
                    text,
                    "| {kind}, {n} | {form} | {} | {:.2} | {:.1} | {:.0} | {:.2} | {:.2} |",
                    first.lines,
                    first.generation,
                    first.rustc,
                    first.code,
                    first.acceleration,
                    second.acceleration
                );
            }
        }
    }
    Ok(text)
}

/// What is measured of one form.
struct Measured {
    lines: usize,
    /// Times (s).
    generation: f64,
    rustc: f64,
    /// Size of the machine code (kB).
    code: f64,
    /// Time of an acceleration (µs).
    acceleration: f64,
}

/// A package that is compiled for a processor.
struct Package {
    folder: PathBuf,
    target: &'static str,
    /// The machine code of a program that does nothing (kB).
    empty: f64,
}

impl Package {
    fn new(here: &Path, target: &'static str) -> Result<Self, Box<dyn Error>> {
        let all = std::env::var_os("CARGO_TARGET_DIR")
            .map_or_else(|| here.join("../target"), PathBuf::from);
        let folder = all.join(format!("form-{target}"));
        fs::create_dir_all(folder.join("src"))?;
        let runtime = here.join("../../runtime").canonicalize()?;
        fs::write(
            folder.join("Cargo.toml"),
            MANIFEST.replace("RUNTIME", &runtime.display().to_string()),
        )?;
        let nothing = "use bricard_runtime as _;\nfn main() {}\n";
        fs::write(folder.join("src/main.rs"), nothing)?;
        let mut package = Self {
            folder,
            target,
            empty: 0.0,
        };
        package.compile()?;
        package.empty = package.code()?;
        Ok(package)
    }

    fn measure(
        &self,
        path: &Path,
        kind: &str,
        (n, unrolled): (u32, usize),
    ) -> Result<Measured, Box<dyn Error>> {
        let description = path.with_extension("mech");
        let module = path.file_name().ok_or("no name")?.to_string_lossy();
        let builder = Builder::new()
            .constant("N", n)
            .out_dir(self.folder.join("src"));
        let builder = builder.unrolled(unrolled).straight_line(usize::MAX);
        let generation = median(|| {
            let begun = Instant::now();
            builder.try_compile(&description)?;
            Ok(begun.elapsed().as_secs_f64())
        })?;
        let code = fs::read_to_string(self.folder.join(format!("src/{module}.rs")))?;
        let main = MAIN.replace("MODULE", &module).replace("TYPE", kind);
        fs::write(self.folder.join("src/main.rs"), main)?;
        let rustc = self.compile()?;
        let acceleration = median(|| {
            let output = Command::new(self.program()).output()?;
            Ok(String::from_utf8_lossy(&output.stdout).parse()?)
        })?;
        Ok(Measured {
            lines: code.lines().count(),
            generation,
            rustc,
            code: self.code()? - self.empty,
            acceleration,
        })
    }

    /// Compiles the package; the time it took (s).
    fn compile(&self) -> Result<f64, Box<dyn Error>> {
        let begun = Instant::now();
        let status = Command::new("cargo")
            .args(["build", "--release", "--quiet"])
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            .env("RUSTFLAGS", format!("-C target-cpu={}", self.target))
            .current_dir(&self.folder)
            .status()?;
        match status.success() {
            true => Ok(begun.elapsed().as_secs_f64()),
            false => Err("cargo failed".into()),
        }
    }

    fn program(&self) -> PathBuf {
        self.folder.join("target/release/form")
    }

    /// Size of the program's machine code (kB).
    fn code(&self) -> Result<f64, Box<dyn Error>> {
        let output = Command::new("size")
            .arg("-A")
            .arg(self.program())
            .output()?;
        let said = String::from_utf8_lossy(&output.stdout);
        let line = said.lines().find(|line| line.starts_with(".text"));
        let size = line
            .and_then(|line| line.split_whitespace().nth(1))
            .ok_or("`size` (binutils) tells no .text")?;
        Ok(size.parse::<f64>()? / 1000.0)
    }
}

fn median(measure: impl Fn() -> Result<f64, Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut measured = Vec::new();
    for _ in 0..REPEATED {
        measured.push(measure()?);
    }
    measured.sort_by(f64::total_cmp);
    Ok(measured[REPEATED / 2])
}
