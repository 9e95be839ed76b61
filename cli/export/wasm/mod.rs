//! A mechanism as a WebAssembly module in a package for npm.
//!
//! In:  a description.
//! Out: the module, its wrapper in JavaScript with types, an example, and the sources to
//!      build all that elsewhere.

use super::folder::Folder;
use super::sources;
use crate::compiled::browser::{TARGET, can_compile, krate as code};
use crate::compiled::{command, generate, module_of, output};
use crate::description::Description;
use crate::error::CommandError;
use crate::output::{print, typed};
use bricard_codegen::Compiled;
use std::path::{Path, PathBuf};

/// The module in the package.
const MODULE: &str = "mechanism.wasm";

const WRAPPER: &str = include_str!("../../../wasm/js/index.js");
const TYPES: &str = include_str!("../../../wasm/js/index.d.ts");
const PACKAGE: &str = include_str!("package.json");
const README: &str = include_str!("README.md");
const EXAMPLE: &str = include_str!("example.mjs");

/// What the manifest ends with: a module that is small and fast.
const PROFILE: &str = "
[profile.release]
codegen-units = 1
lto = true
panic = \"abort\"
";

/// Writes the package.
///
/// # Errors
///
/// [`CommandError::Description`], [`CommandError::Exists`], [`CommandError::Write`], and
/// [`CommandError::Compile`] if the module can't be compiled: all but that is there then.
pub fn export(subject: &Description, out: Option<&Path>) -> Result<(), CommandError> {
    let module = module_of(&subject.file);
    let compiled = generate(&subject.file, &subject.source, false)?;
    // It may be in the folder itself.
    let described = sources::described(&module, subject, &compiled)?;
    let folder = Folder::new(&out.map_or_else(|| PathBuf::from(&module), Path::to_path_buf))?;
    write(&folder, &module, &compiled)?;
    folder.write_all(described)?;
    let built = build(folder.path(), &module)?;
    folder.copy(&built, MODULE)?;
    print(&format!(
        "{} holds the package `{}`:\n\n    cd {}\n    node example.mjs\n    npm pack\n",
        folder.path().display(),
        package(&module),
        typed(folder.path())
    ))
}

/// All but the module and the description.
fn write(folder: &Folder, module: &str, compiled: &Compiled) -> Result<(), CommandError> {
    let about = format!("The mechanism {}, for browsers and Node", compiled.name);
    let packages = ["runtime", "wasm"];
    let library = "crate-type = [\"cdylib\"]\ndoctest = false\n";
    let manifest = sources::manifest(&krate(module), &about, library, &packages)
        .replace("runtime\" }", "runtime\", default-features = false }");
    folder.write("Cargo.toml", &(manifest + PROFILE))?;
    folder.write(
        "src/lib.rs",
        &code(
            &format!("{about}: `index.js` calls its functions."),
            module,
            compiled,
        ),
    )?;
    folder.write("index.js", WRAPPER)?;
    folder.write("index.d.ts", TYPES)?;
    for (name, text) in [
        ("package.json", PACKAGE),
        ("README.md", README),
        ("example.mjs", EXAMPLE),
    ] {
        let text = text
            .replace("PACKAGE", &package(module))
            .replace("CRATE", &krate(module))
            .replace("ABOUT", &about);
        folder.write(name, &text)?;
    }
    folder.write(".gitignore", "/target\n/*.tgz\n")?;
    sources::write(folder, &packages)
}

fn package(module: &str) -> String {
    krate(module).replace('_', "-")
}

fn krate(module: &str) -> String {
    format!("bricard_{module}")
}

/// Compiles the module.
fn build(folder: &Path, module: &str) -> Result<PathBuf, CommandError> {
    can_compile().map_err(|error| {
        CommandError::Compile(format!(
            "the module is not made: {error}\nand say the same again, or, because all else is in \
             {}:\n\n    cd {} && npm run build",
            folder.display(),
            typed(folder)
        ))
    })?;
    let mut cargo = command("cargo");
    cargo.args([
        "build",
        "--release",
        "--target",
        TARGET,
        "--target-dir",
        "target",
    ]);
    output(cargo, folder, "the module could not be compiled")?;
    let built = folder.join("target").join(TARGET).join("release");
    Ok(built.join(krate(module)).with_extension("wasm"))
}
