//! Crates that the command writes, built.
//!
//! In:  the folder of a crate, or one of its files.
//! Out: cargo, to run it as its owner would, without a network; or the compiler, for one file
//!      beside the runtime that the command keeps for descriptions.

use crate::command::bricard;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// The folder of what the programs of all descriptions share, in the cache of the tests.
static LIBRARIES: LazyLock<PathBuf> = LazyLock::new(|| {
    let ran = bricard(&["export", "slider_crank", "--to", "library"]);
    assert_eq!(ran.status, Some(0), "{}", ran.err);
    // It is said where the library is: in its own folder, among others, in that of a version.
    let version = Path::new(ran.out.trim()).ancestors().nth(3);
    version.expect("a place in the cache").join("libraries")
});

/// How the workspace compiles what is written elsewhere: what it has built of that serves
/// these crates too.
const AS_HERE: [&str; 5] = [
    "profile.dev.lto='off'",
    "profile.dev.package.'*'.opt-level=0",
    "profile.dev.package.'*'.codegen-units=16",
    "profile.dev.package.qd.opt-level=3",
    "profile.dev.package.libm.opt-level=1",
];

/// `cargo run` for a crate.
pub fn run(made: &Path) -> Command {
    // The versions of the workspace.
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.lock");
    fs::copy(lock, made.join("Cargo.lock")).expect("the folder is ours");
    let target = Path::new(env!("CARGO_BIN_EXE_bricard"))
        .parent()
        .and_then(Path::parent);
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args(["run", "--offline", "--quiet"])
        .args(AS_HERE.iter().flat_map(|setting| ["--config", setting]))
        .current_dir(made)
        .env(
            "CARGO_TARGET_DIR",
            target.expect("the folder of target/debug"),
        )
        .env("CARGO_PROFILE_DEV_DEBUG", "false");
    cargo
}

/// The compiler for a file that uses the runtime, and the folder for what comes of it. Warnings
/// are errors; optimisation would take longer than such programs run.
pub fn rustc(file: &Path, into: &Path) -> Command {
    let mut rustc = Command::new("rustc");
    rustc
        .args(["--edition", "2024", "-D", "warnings"])
        .args(["--extern", "bricard_runtime", "-L"])
        .arg(&*LIBRARIES)
        .arg(file)
        .arg("-L")
        .arg(into)
        .arg("--out-dir")
        .arg(into);
    rustc
}
