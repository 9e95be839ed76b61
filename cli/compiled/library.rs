//! The libraries of one description for other languages.
//!
//! In:  a description.
//! Out: a shared and a static library in the cache.

use super::cache::{Cache, Digits, Scratch, Version, name};
use super::compiler::{Toolchain, output};
use super::identity;
use super::settings::settings;
use super::shared::{boundary, rustc};

use crate::description::{say_doubts, wrong};
use crate::error::CommandError;
use crate::output::say;
use bricard_codegen::internals::emit::module_name;
use bricard_codegen::{Compiled, compile_source};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};

/// What the static library has to be linked with, in a file beside it.
const NATIVE: &str = "native";
/// How the compiler begins to tell.
const TOLD: &str = "native-static-libs:";

/// The libraries of a mechanism.
#[derive(Clone, Debug)]
pub struct Library {
    /// The folder they are in.
    pub folder: PathBuf,
    /// The name of the mechanism's module, of which those of the libraries are made.
    pub module: String,
}

impl Library {
    /// What a linker calls the library.
    pub fn called(module: &str) -> String {
        format!("bricard_{module}")
    }

    /// The file of the shared library.
    pub fn shared(module: &str) -> String {
        format!("{DLL_PREFIX}{}{DLL_SUFFIX}", Self::called(module))
    }

    /// The file of the static library.
    pub fn fixed(module: &str) -> String {
        match cfg!(windows) {
            true => format!("{}.lib", Self::called(module)),
            false => format!("lib{}.a", Self::called(module)),
        }
    }

    /// What the static library has to be linked with.
    pub fn native(&self) -> String {
        fs::read_to_string(self.folder.join(NATIVE)).unwrap_or_default()
    }
}

/// Headers of C, and the one that all exports include: none of a mechanism may hide them.
const HEADERS: &str = "\
    assert bricard complex ctype errno fenv float inttypes iso646 limits locale math setjmp \
    signal stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn string \
    tgmath threads time uchar wchar wctype";

/// The name of the module of a description: that of its file, in letters that Rust knows.
pub fn module_of(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or(file.as_os_str());
    let letter = |letter: char| match letter.is_ascii_alphanumeric() {
        true => letter,
        false => '_',
    };
    let plain: String = stem.to_string_lossy().chars().map(letter).collect();
    let plain = plain.trim_matches('_');
    let lower = plain.to_ascii_lowercase();
    if HEADERS.split(' ').any(|header| header == lower) {
        return module_name(&format!("{plain}_mechanism"));
    }
    match plain.chars().next() {
        Some(first) if first.is_ascii_alphabetic() => module_name(plain),
        _ => module_name(&format!("mechanism_{plain}")),
    }
}

/// Generates the code of a description for other languages, and says what is doubtful
/// about it.
///
/// # Errors
///
/// [`CommandError::Description`].
pub fn generate(file: &Path, source: &str, for_c: bool) -> Result<Compiled, CommandError> {
    let mut settings = settings(file);
    settings.options.c_interface = for_c;
    let compiled = compile_source(source, &module_of(file), &name(file), &settings)
        .map_err(wrong(file, source))?;
    say_doubts(file, source, &compiled.warnings);
    Ok(compiled)
}

/// The libraries of a description, from the cache or built.
///
/// # Errors
///
/// What is wrong with the description, in the words of `bricard check`; what stands in the
/// way of compiling it.
pub fn library(file: &Path, source: &str) -> Result<Library, CommandError> {
    let identity = identity(file, source);
    let toolchain = Toolchain::find();
    let cache = Cache::find()?;
    let module = module_of(file);
    if let Ok(toolchain) = &toolchain {
        let version = Version::new(&cache, toolchain, Digits::Double);
        let folder = version.exported(file, &identity);
        if Version::holds(&folder, &identity) {
            return Ok(Library { folder, module });
        }
    }
    // A wrong description is the first thing to know, toolchain or not.
    let compiled = generate(file, source, true)?;
    let toolchain = toolchain?;
    let version = Version::new(&cache, &toolchain, Digits::Double);
    let folder = build((file, &identity), &compiled.code, &version, &toolchain)?;
    Ok(Library { folder, module })
}

/// Builds the libraries, unless another process has done so meanwhile.
fn build(
    (file, identity): (&Path, &str),
    code: &str,
    version: &Version,
    toolchain: &Toolchain,
) -> Result<PathBuf, CommandError> {
    let _alone = version.lock()?;
    let entry = version.exported(file, identity);
    if Version::holds(&entry, identity) {
        return Ok(entry);
    }
    let boundary = boundary(version, toolchain)?;
    say(&format!("compiling {}", file.display()));
    let scratch = Scratch::new(version)?;
    scratch.write(Path::new("lib.rs"), code)?;
    let built = scratch.folder("exported")?;
    let mut rustc = rustc(
        &[&version.libraries(), &boundary],
        &["bricard_runtime", "bricard_capi"].map(String::from),
    );
    rustc
        .args(["--crate-type", "cdylib", "--crate-type", "staticlib"])
        .args(["--crate-name", &Library::called(&module_of(file))])
        .args(["--print", "native-static-libs", "lib.rs", "--out-dir"])
        .arg(&built);
    let failed = format!("{} could not be compiled", file.display());
    let output = output(rustc, scratch.path(), &failed)?;
    let said = String::from_utf8_lossy(&output.stderr);
    let native = said.lines().find_map(|line| line.split_once(TOLD));
    let native = native.map_or("", |(_, native)| native.trim());
    let place = built.join(NATIVE);
    fs::write(&place, native).map_err(|error| CommandError::Cache(place, error))?;
    version.shelve(scratch, &built, &entry, identity)?;
    Ok(entry)
}
