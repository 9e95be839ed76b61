//! A mechanism as a wheel, a package for Python that needs no compiler where it is installed.
//!
//! In:  a description.
//! Out: a wheel (PEP 427) with the shared library, the package `bricard` that calls it, and
//!      an example.

use super::archive::{self, Files};
use super::sources;
use crate::compiled::{Library, generate, library, module_of};
use crate::description::Description;
use crate::error::CommandError;
use crate::output::{print, typed};
use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// A file of the package `bricard`, which wheels carry along.
macro_rules! carried {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../../python/bricard/", $name)))),*]
    };
}

/// The package `bricard`; `_bricard` in a wheel, so that each has the one it was made with.
const PACKAGE: [(&str, &str); 10] = carried![
    "__init__.py",
    "_abi.py",
    "_compile.py",
    "_handle.py",
    "_picture.py",
    "_run.py",
    "errors.py",
    "library.py",
    "mechanism.py",
    "result.py",
];

const OWN: &str = include_str!("package.py");
const EXAMPLE: &str = include_str!("example.py");
/// The version of what is exported.
const VERSION: &str = "0.1.0";

/// Words of Python, the modules that it has itself, and the packages that all exports import: no
/// package can be called so.
const TAKEN: &str = include_str!("taken.txt");

/// Writes the wheel into a folder.
///
/// # Errors
///
/// [`CommandError::Description`], [`CommandError::Write`], and what stands in the way of
/// compiling.
pub fn export(subject: &Description, out: Option<&Path>) -> Result<(), CommandError> {
    let module = module_of(&subject.file);
    let compiled = generate(&subject.file, &subject.source, true)?;
    let built = library(&subject.file, &subject.source)?;
    let name = package(&module);
    let shared = Library::shared(&module);
    let place = built.folder.join(&shared);
    let bytes = fs::read(&place).map_err(|error| CommandError::Read(place, error))?;
    let about = format!("The mechanism {}, compiled by bricard.", compiled.name);
    let own = OWN
        .replace("ABOUT", &about)
        .replace("PACKAGE", &name)
        .replace("LIBRARY", &shared)
        .replace("MODULE", &module)
        .replace("VERSION", env!("CARGO_PKG_VERSION"));
    let mut files: Files = vec![
        (format!("{name}/__init__.py"), own.into_bytes()),
        (format!("{name}/__main__.py"), EXAMPLE.into()),
        (format!("{name}/{shared}"), bytes),
    ];
    let described = sources::described(&module, subject, &compiled)?;
    let described = described.into_iter();
    files.extend(described.map(|(file, text)| (format!("{name}/{file}"), text.into())));
    let carried = PACKAGE.iter();
    files.extend(carried.map(|(file, text)| (format!("{name}/_bricard/{file}"), (*text).into())));
    let tag = format!("py3-none-{}", platform());
    describe(&mut files, &name, &about, &tag);
    let folder = out.map_or_else(PathBuf::new, Path::to_path_buf);
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(&folder).map_err(|error| CommandError::write(&folder, error))?;
    }
    let wheel = folder.join(format!("{name}-{VERSION}-{tag}.whl"));
    archive::write(&wheel, &files)?;
    print(&format!(
        "{shown} is a wheel for this kind of machine:\n\n    pip install {wheel}\n    python -m \
         {name}\n",
        shown = wheel.display(),
        wheel = typed(&wheel)
    ))
}

/// The name of the package of a module.
fn package(module: &str) -> String {
    match TAKEN.split_whitespace().any(|taken| taken == module) {
        true => format!("{module}_mechanism"),
        false => module.to_string(),
    }
}

/// The kind of machine that a library is for, as Python names it (PEP 425).
fn platform() -> String {
    let machine = std::env::consts::ARCH;
    match (cfg!(windows), cfg!(target_os = "macos"), machine) {
        (true, _, "aarch64") => "win_arm64".to_string(),
        (true, _, _) => "win_amd64".to_string(),
        (_, true, "aarch64") => "macosx_11_0_arm64".to_string(),
        (_, true, _) => format!("macosx_10_12_{machine}"),
        _ => format!("linux_{machine}"),
    }
}

/// Adds what an installer wants to know.
fn describe(files: &mut Files, name: &str, about: &str, tag: &str) {
    let info = format!("{name}-{VERSION}.dist-info");
    let metadata = format!(
        "Metadata-Version: 2.1\nName: {name}\nVersion: {VERSION}\nSummary: {about}\n\
         Requires-Python: >=3.10\nRequires-Dist: numpy >=1.24\n"
    );
    let wheel = format!(
        "Wheel-Version: 1.0\nGenerator: bricard {}\nRoot-Is-Purelib: false\nTag: {tag}\n",
        env!("CARGO_PKG_VERSION")
    );
    files.push((format!("{info}/METADATA"), metadata.into_bytes()));
    files.push((format!("{info}/WHEEL"), wheel.into_bytes()));
    let own = format!("{info}/RECORD");
    let mut record: String = files
        .iter()
        .map(|(name, bytes)| line(name, bytes))
        .collect();
    record += &format!("{own},,\n");
    files.push((own, record.into_bytes()));
}

/// What is recorded of a file: its name, hash and size.
fn line(name: &str, bytes: &[u8]) -> String {
    let hash = URL_SAFE_NO_PAD.encode(Sha256::digest(bytes));
    format!("{name},sha256={hash},{}\n", bytes.len())
}

#[cfg(test)]
mod tests {
    use super::{PACKAGE, line, package};
    use std::fs;
    use std::path::Path;

    #[test]
    fn wheels_carry_the_whole_package() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("python/bricard");
        let entries = fs::read_dir(folder).expect("it is there");
        let names = entries.map(|entry| entry.expect("it is there").file_name());
        let mut names: Vec<_> = names.filter_map(|name| name.into_string().ok()).collect();
        names.retain(|name| name.ends_with(".py"));
        names.sort();
        assert_eq!(names, PACKAGE.map(|(name, _)| name));
    }

    #[test]
    fn no_package_is_called_by_a_word_of_python() {
        for taken in ["lambda", "time", "queue", "numpy"] {
            assert_eq!(package(taken), format!("{taken}_mechanism"));
        }
        assert_eq!(package("four_bar"), "four_bar");
    }

    #[test]
    fn a_record_has_the_hash_that_the_standard_wants() {
        // The SHA-256 of "abc" is an example of FIPS 180-2.
        let hash = "ungWv48Bz-pBQUDeXa4iI7ADYaOWF3qctBD_YfIAFa0";
        assert_eq!(line("a", b"abc"), format!("a,sha256={hash},3\n"));
    }
}
