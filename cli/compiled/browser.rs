//! The module of one description for browsers.
//!
//! In:  a description.
//! Out: WebAssembly, from the cache or built.

use super::cache::{Cache, Scratch, Version};
use super::compiler::{Toolchain, command, output};
use super::library::{generate, module_of};
use super::shared::{Shared, rustc};
use super::{Digits, identity};
use crate::error::CommandError;
use crate::output::say;
use bricard_codegen::Compiled;
use bricard_codegen::internals::emit::type_name;
use std::env;
use std::fs;
use std::path::Path;

/// What modules are compiled for.
pub const TARGET: &str = "wasm32-unknown-unknown";
/// The module in its entry.
const MODULE: &str = "mechanism.wasm";
/// Bytes of the stack: matrices of large mechanisms lie there.
const STACK: u32 = 1 << 24;

/// The crate of a module: the generated code and the functions that it exports.
pub fn krate(about: &str, module: &str, compiled: &Compiled) -> String {
    let kind = type_name(&compiled.name);
    let (n, r) = (compiled.coordinates, compiled.constraints);
    format!(
        "//! {about}\n#![no_std]\n\n{}\n\
         bricard_wasm::module!({module}::{kind}<f64>, {n}, {r});\n",
        compiled.code
    )
}

/// Finds out whether Rust can compile modules.
///
/// # Errors
///
/// [`CommandError::Compile`], which says how to get what is missing.
pub fn can_compile() -> Result<(), CommandError> {
    let mut rustc = command("rustc");
    rustc.args(["--print", "target-libdir", "--target", TARGET]);
    let said = output(
        rustc,
        &env::temp_dir(),
        "`rustc --print target-libdir` failed",
    )?;
    let place = String::from_utf8_lossy(&said.stdout).trim().to_string();
    match Path::new(&place).is_dir() {
        true => Ok(()),
        false => Err(CommandError::Compile(format!(
            "this Rust can't compile for {TARGET} yet.\nGet that with\n\n    \
             rustup target add {TARGET}\n"
        ))),
    }
}

/// The module of a description, from the cache or built.
///
/// # Errors
///
/// What is wrong with the description, or stands in the way of compiling it.
pub fn module(file: &Path, source: &str) -> Result<Vec<u8>, CommandError> {
    let identity = identity(file, source);
    let toolchain = Toolchain::find()?;
    let version = Version::new(&Cache::find()?, &toolchain, Digits::Double);
    let entry = version.module(file, &identity);
    if !Version::holds(&entry, &identity) {
        can_compile()?;
        build((file, source, &identity), &version, &entry)?;
    }
    let path = entry.join(MODULE);
    fs::read(&path).map_err(|error| CommandError::Cache(path, error))
}

/// Builds a module, unless another process has done so meanwhile.
fn build(
    (file, source, identity): (&Path, &str, &str),
    version: &Version,
    entry: &Path,
) -> Result<(), CommandError> {
    let _alone = version.lock()?;
    if Version::holds(entry, identity) {
        return Ok(());
    }
    let shared = Shared {
        packages: &["runtime", "wasm"],
        wanted: &["wasm"],
        target: TARGET,
        kind: " in browsers",
    };
    let libraries = shared.build(version, version.browser_libraries())?;
    say(&format!("compiling {} for browsers", file.display()));
    let module = module_of(file);
    let compiled = generate(file, source, false)?;
    let scratch = Scratch::new(version)?;
    let text = krate("A mechanism in the page of a run.", &module, &compiled);
    scratch.write(Path::new("lib.rs"), &text)?;
    let built = scratch.folder("module")?;
    let mut rustc = rustc(
        &[&libraries],
        &["bricard_runtime", "bricard_wasm"].map(String::from),
    );
    rustc
        .args(["--target", TARGET, "--crate-type", "cdylib"])
        .args(["-C", "codegen-units=1", "-C", "panic=abort"])
        .args(["-C", "strip=symbols"])
        .args(["-C", &format!("link-arg=-zstack-size={STACK}")])
        .args(["lib.rs", "-o"])
        .arg(built.join(MODULE));
    let failed = format!("{} could not be compiled for browsers", file.display());
    output(rustc, scratch.path(), &failed)?;
    version.shelve(scratch, &built, entry, identity)
}
