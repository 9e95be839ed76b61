//! The program of one description.
//!
//! In:  a description.
//! Out: a program in the cache.

use super::cache::{Scratch, Version, name};
use super::compiler::{Toolchain, output};
use super::settings::settings;
use super::shared::{rustc, sized};
use crate::description::wrong;
use crate::error::CommandError;
use crate::output::say;
use bricard_codegen::compile_source;
use bricard_codegen::internals::emit::type_name;
use std::path::{Path, PathBuf};

/// The module that a description becomes.
const MODULE: &str = "described";

/// A description and the code that was generated from it.
pub struct Program<'a> {
    file: &'a Path,
    /// What it is known by: the description, and the files that it reads.
    identity: &'a str,
    code: String,
    sizes: [usize; 2],
}

impl<'a> Program<'a> {
    /// Generates the code of a description.
    ///
    /// # Errors
    ///
    /// [`CommandError::Description`].
    pub fn generate(file: &'a Path, source: &str, identity: &'a str) -> Result<Self, CommandError> {
        let compiled = compile_source(source, MODULE, &name(file), &settings(file))
            .map_err(wrong(file, source))?;
        let kind = type_name(&compiled.name);
        let main = format!(
            "fn main() -> std::process::ExitCode {{\n    \
             sized::serve(|| Box::new({MODULE}::{kind}::<sized::Number>::default()))\n}}\n"
        );
        Ok(Self {
            file,
            identity,
            code: compiled.code + &main,
            sizes: [compiled.coordinates, compiled.constraints],
        })
    }

    /// Builds the program, unless another process has done so meanwhile.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`], [`CommandError::Compile`].
    pub fn build(self, version: &Version, toolchain: &Toolchain) -> Result<PathBuf, CommandError> {
        let _alone = version.lock()?;
        if let Some(program) = version.program(self.file, self.identity) {
            return Ok(program);
        }
        let sized = sized(version, toolchain, self.sizes)?;
        say(&format!("compiling {}", self.file.display()));
        let scratch = Scratch::new(version)?;
        scratch.write(Path::new("main.rs"), &self.code)?;
        let built = scratch.folder("program")?;
        let mut rustc = rustc(
            &[&version.libraries(), &sized],
            &["bricard_runtime", "sized"].map(String::from),
        );
        // A long mechanism is a few long functions, which several units of code would only
        // optimise twice.
        rustc
            .args(["-C", "codegen-units=1"])
            .args(["-C", "strip=symbols", "main.rs", "-o"])
            .arg(built.join(Version::EXECUTABLE));
        let failed = format!("{} could not be compiled", self.file.display());
        output(rustc, scratch.path(), &failed)?;
        version.add(scratch, &built, self.file, self.identity)
    }
}
