//! Crates that the command writes, built as their owner would.
//!
//! In:  the folder of a crate.
//! Out: cargo, to run it without a network.

use std::fs;
use std::path::Path;
use std::process::Command;

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
