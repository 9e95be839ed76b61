//! What compiled descriptions share.
//!
//! In:  the sources that the command carries.
//! Out: libraries in the cache: the runtime and the driver with all that they depend on,
//!      the driver for each pair of sizes, and the boundary to C.

use super::cache::{Digits, Scratch, Version};
use super::compiler::{Toolchain, command, output};
use super::sources::SOURCES;
use crate::error::CommandError;
use crate::output::say;
use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How the shared libraries are compiled. What a run computes with is generic and compiled
/// with each pair of sizes, so what others have written is compiled without optimisation,
/// but for functions of numbers; and so is the driver, the messages between two programs.
const PROFILE: &str = "
[profile.release.package.\"*\"]
opt-level = 0
codegen-units = 16

[profile.release.package.qd]
opt-level = 3

[profile.release.package.libm]
opt-level = 3

[profile.release.package.bricard-driver]
opt-level = 0
";

/// The packages among the sources of which programs are made, with numbers of either kind:
/// what 106 bits need besides is built in a second, while a processor has nothing to do.
const PACKAGES: [&str; 3] = ["runtime", "driver", "reference"];

impl Digits {
    /// What descriptions of one pair of sizes share: a `main` but for the mechanism.
    fn serve(self, [coordinates, constraints]: [usize; 2]) -> String {
        let (number, serve) = match self {
            Self::Double => ("f64", "bricard_driver::serve(make)".to_string()),
            Self::Many => (
                "bricard_reference::DoubleDouble",
                "bricard_driver::with_room(move || {\n        \
                 bricard_driver::serve_precise(bricard_reference::precise(make()))\n    })"
                    .to_string(),
            ),
        };
        let kind = format!("dyn bricard_runtime::Whole<Number, {coordinates}, {constraints}>");
        format!(
            "pub type Number = {number};\n\n\
             pub fn serve(make: fn() -> Box<{kind}>) -> std::process::ExitCode {{\n    \
             {serve}\n}}\n"
        )
    }
}

/// Builds what all descriptions share, unless it is there.
///
/// # Errors
///
/// [`CommandError::Cache`], [`CommandError::Compile`].
pub fn libraries(version: &Version, toolchain: &Toolchain) -> Result<PathBuf, CommandError> {
    let shared = Shared {
        packages: &PACKAGES,
        wanted: &PACKAGES,
        target: &toolchain.host,
        kind: "",
    };
    shared.build(version, version.libraries())
}

/// What libraries are built of, and for which machine.
pub struct Shared<'a> {
    /// Packages among the sources that take part.
    pub packages: &'a [&'a str],
    /// Those of them that are asked for; the others with the features that these want.
    pub wanted: &'a [&'a str],
    /// The machine.
    pub target: &'a str,
    /// What tells them from others, in words.
    pub kind: &'a str,
}

impl Shared<'_> {
    /// Builds libraries in their place, unless they are there.
    ///
    /// # Errors
    ///
    /// As [`libraries`].
    pub fn build(&self, version: &Version, libraries: PathBuf) -> Result<PathBuf, CommandError> {
        if libraries.is_dir() {
            return Ok(libraries);
        }
        say(&format!(
            "compiling what all mechanisms share{}: once for this version of bricard and of \
             Rust, about 20 s",
            self.kind
        ));
        let scratch = Scratch::new(version)?;
        for (name, text) in SOURCES.1 {
            let text = manifest(name, text, self.packages);
            scratch.write(&Path::new("sources").join(name), &text)?;
        }
        let sources = scratch.path().join("sources");
        let built = scratch.folder("libraries")?;
        copy(self.compiled(&sources)?, &built)?;
        scratch.keep(&built, &libraries)?;
        Ok(libraries)
    }

    /// Compiles the sources; the libraries that came of it.
    fn compiled(&self, sources: &Path) -> Result<Vec<PathBuf>, CommandError> {
        let cargo = |network: &[&str]| {
            let mut cargo = command("cargo");
            cargo
                .args([
                    "build",
                    "--release",
                    "--message-format=json-render-diagnostics",
                    "--target-dir",
                ])
                .arg("target")
                .args(["--target", self.target])
                .args(network);
            for package in self.wanted {
                cargo.args(["--package", &format!("bricard-{package}")]);
            }
            cargo
        };
        let failed = "what all mechanisms share could not be compiled; the first time it may need a \
                      network, for nalgebra and what that depends on";
        // Whoever has built bricard has all of it, so the network is asked last.
        let run = |cargo: Command| output(cargo, sources, failed);
        let output = run(cargo(&["--offline"])).or_else(|_| run(cargo(&[])))?;
        let text = String::from_utf8_lossy(&output.stdout);
        let messages = text
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok());
        let files = messages.flat_map(|message: Value| files(&message));
        Ok(files.filter(|file| is_library(file)).collect())
    }
}

fn copy(files: Vec<PathBuf>, built: &Path) -> Result<(), CommandError> {
    for library in files {
        if let Some(name) = library.file_name() {
            fs::copy(&library, built.join(name))
                .map_err(|error| CommandError::Cache(library.clone(), error))?;
        }
    }
    Ok(())
}

/// The files of a message of cargo.
fn files(message: &Value) -> Vec<PathBuf> {
    let names = message["filenames"].as_array().into_iter().flatten();
    names.filter_map(Value::as_str).map(PathBuf::from).collect()
}

/// Whether a file is a library, or one of the macros that a library names.
fn is_library(file: &Path) -> bool {
    let kinds = ["rlib", "so", "dylib", "dll"];
    let kind = file.extension().and_then(OsStr::to_str);
    kind.is_some_and(|kind| kinds.contains(&kind))
}

/// A manifest without what only tests and the whole workspace need; any other text as it
/// is.
fn manifest(name: &str, text: &str, packages: &[&str]) -> String {
    if name == "Cargo.lock" || !name.ends_with(".toml") {
        return text.to_string();
    }
    let is_root = name == "Cargo.toml";
    let wanted = |section: &str| match is_root {
        true => section.starts_with("[workspace."),
        false => !["[[test]]", "[dev-dependencies]"].contains(&section),
    };
    let mut manifest = match is_root {
        true => format!("[workspace]\nmembers = {packages:?}\nresolver = \"3\"\n\n"),
        false => String::new(),
    };
    let mut keep = false;
    for line in text.lines() {
        if line.starts_with('[') {
            keep = wanted(line);
        }
        if keep {
            manifest.push_str(line);
            manifest.push('\n');
        }
    }
    if is_root {
        manifest.push_str(PROFILE);
    }
    manifest
}

/// Builds what descriptions of one pair of sizes share, unless it is there.
///
/// # Errors
///
/// [`CommandError::Cache`], [`CommandError::Compile`].
pub fn sized(
    version: &Version,
    toolchain: &Toolchain,
    [coordinates, constraints]: [usize; 2],
) -> Result<PathBuf, CommandError> {
    let libraries = libraries(version, toolchain)?;
    let sized = version.sized([coordinates, constraints]);
    if sized.is_dir() {
        return Ok(sized);
    }
    let scratch = Scratch::new(version)?;
    let built = scratch.folder("sized")?;
    let text = version.digits.serve([coordinates, constraints]);
    scratch.write(Path::new("sized.rs"), &text)?;
    let crates = PACKAGES.map(|name| format!("bricard_{name}"));
    let mut rustc = rustc(&[&libraries], &crates);
    rustc
        .args(["--crate-type", "lib", "sized.rs", "--out-dir"])
        .arg(&built);
    let failed = format!(
        "the driver for {coordinates} coordinates and {constraints} constraint equations could \
         not be compiled"
    );
    output(rustc, scratch.path(), &failed)?;
    scratch.keep(&built, &sized)?;
    Ok(sized)
}

/// Builds the boundary to C, which libraries for other languages need and no program, unless
/// it is there.
///
/// # Errors
///
/// [`CommandError::Cache`], [`CommandError::Compile`].
pub fn boundary(version: &Version, toolchain: &Toolchain) -> Result<PathBuf, CommandError> {
    let libraries = libraries(version, toolchain)?;
    let boundary = version.boundary();
    if boundary.is_dir() {
        return Ok(boundary);
    }
    let scratch = Scratch::new(version)?;
    let built = scratch.folder("boundary")?;
    let sources = SOURCES.1.iter();
    for (name, text) in sources.filter(|(name, _)| name.starts_with("capi/")) {
        scratch.write(Path::new(name), text)?;
    }
    let mut rustc = rustc(&[&libraries], &["bricard_runtime".to_string()]);
    rustc
        .args(["--crate-type", "lib", "--crate-name", "bricard_capi"])
        .args(["capi/src/lib.rs", "--out-dir"])
        .arg(&built);
    let failed = "the boundary to C could not be compiled";
    output(rustc, scratch.path(), failed)?;
    scratch.keep(&built, &boundary)?;
    Ok(boundary)
}

/// The compiler, with folders of libraries and the crates that are used of them.
pub fn rustc(libraries: &[&Path], crates: &[String]) -> Command {
    let mut rustc = command("rustc");
    rustc.args([
        "--edition",
        "2024",
        "-C",
        "opt-level=3",
        "-C",
        "embed-bitcode=no",
        "--cap-lints",
        "allow",
    ]);
    for name in crates {
        rustc.args(["--extern", name]);
    }
    for folder in libraries {
        rustc.arg("-L").arg(folder);
    }
    rustc
}
