//! A mechanism as libraries for C and C++.
//!
//! In:  a description.
//! Out: libraries, headers, files for pkg-config and CMake, an example, and the sources to
//!      build all that elsewhere.

use super::folder::{Folder, vacant};
use super::sources;
use crate::compiled::{Library, generate, library, module_of};
use crate::description::Description;
use crate::error::CommandError;
use crate::output::{print, typed};
use bricard_codegen::Compiled;
use std::path::{Path, PathBuf};

/// The header that is the same for all mechanisms.
const HEADER: &str = include_str!("../../capi/include/bricard.h");
const EXAMPLE: &str = include_str!("example.c");
const CMAKE: &str = include_str!("config.cmake");

/// Writes the folder.
///
/// # Errors
///
/// [`CommandError::Description`], [`CommandError::Exists`], [`CommandError::Write`], and what
/// stands in the way of compiling.
pub fn export(subject: &Description, out: Option<&Path>) -> Result<(), CommandError> {
    let module = module_of(&subject.file);
    let path = out.map_or_else(|| PathBuf::from(&module), Path::to_path_buf);
    let compiled = generate(&subject.file, &subject.source, true)?;
    vacant(&path)?;
    let built = library(&subject.file, &subject.source)?;
    // It may be in the folder itself.
    let described = sources::described(&module, subject, &compiled)?;
    let folder = Folder::new(&path)?;
    let called = Library::called(&module);
    folder.write_all(library_sources(&module, &compiled))?;
    folder.write_all(described)?;
    folder.write(".gitignore", "/target\n")?;
    folder.write("include/bricard.h", HEADER)?;
    folder.write(&format!("include/{module}.h"), &compiled.c_header)?;
    let fill = |text: &str| {
        text.replace("UPPER", &module.to_uppercase())
            .replace("MODULE", &module)
    };
    folder.write("example.c", &fill(EXAMPLE))?;
    for file in [Library::shared(&module), Library::fixed(&module)] {
        folder.copy(&built.folder.join(&file), &format!("lib/{file}"))?;
    }
    let native = built.native();
    folder.write(
        &format!("lib/pkgconfig/{called}.pc"),
        &package_config(&called, &about(&compiled), &native),
    )?;
    let cmake = fill(CMAKE)
        .replace("CALLED", &called)
        .replace("SHARED", &Library::shared(&module))
        .replace("FIXED", &Library::fixed(&module))
        .replace("NATIVE", &native);
    folder.write(&format!("lib/cmake/{called}/{called}-config.cmake"), &cmake)?;
    print(&said(&path, &called))
}

/// The crate of the libraries, which makes them anew anywhere: paths with texts.
pub fn library_sources(module: &str, compiled: &Compiled) -> Vec<(String, String)> {
    let about = about(compiled);
    let kinds = "crate-type = [\"cdylib\", \"staticlib\"]\ndoctest = false\n";
    let packages = ["capi", "runtime"];
    let manifest = sources::manifest(&Library::called(module), &about, kinds, &packages);
    let front = format!("//! {about}: `{module}.h` tells how.\n\n");
    let own = [
        ("Cargo.toml".to_string(), manifest),
        ("src/lib.rs".to_string(), front + &compiled.code),
    ];
    own.into_iter().chain(sources::files(&packages)).collect()
}

fn about(compiled: &Compiled) -> String {
    format!("The mechanism {}, for programs in C", compiled.name)
}

/// The file of pkg-config; it may lie anywhere, with its folder.
fn package_config(called: &str, about: &str, native: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "prefix=${{pcfiledir}}/../..

Name: {called}
Description: {about}
Version: {version}
Cflags: -I${{prefix}}/include
Libs: -L${{prefix}}/lib -l{called}
Libs.private: {native}
"
    )
}

fn said(path: &Path, called: &str) -> String {
    let (path, typed) = (path.display(), typed(path));
    format!(
        "{path} holds the libraries `{called}`, headers and an example:\n\n    cd {typed}\n    \
         cc -std=c99 example.c -Iinclude -Llib -l{called} -Wl,-rpath,\"$PWD/lib\" -o example\n    \
         ./example\n\n\
         pkg-config and CMake find them in lib/; `cargo build --release` makes them anew, also \
         on another\nmachine.\n"
    )
}
