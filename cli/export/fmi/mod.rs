//! A mechanism as an FMU, a functional mock-up unit of FMI 2.0: model exchange and
//! co-simulation in one file.
//!
//! In:  a description.
//! Out: `NAME.fmu`, with the library for this machine and the sources to build others.

mod description;

use super::Subject;
use crate::compiled::compiler::{command, output};
use crate::compiled::{Library, generate, hash, identity, library, module_of};
use crate::error::CommandError;
use crate::output::print;
use bricard_codegen::Settings;
use bricard_codegen::internals::analyse;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use zip::write::{SimpleFileOptions, ZipWriter};

const HEADER: &str = include_str!("../../../capi/include/bricard.h");
const FUNCTIONS: &str = include_str!("fmi2.c");
/// The folder of libraries for this machine, as the standard names it.
const PLATFORM: &str = match (cfg!(windows), cfg!(target_os = "macos")) {
    (true, _) => "win64",
    (_, true) => "darwin64",
    _ => "linux64",
};

/// Writes the FMU.
///
/// # Errors
///
/// [`CommandError::Description`], [`CommandError::FileKind`], [`CommandError::Write`], and
/// what stands in the way of compiling.
pub fn export(subject: &Subject, out: Option<&Path>) -> Result<(), CommandError> {
    let module = module_of(&subject.file);
    let path = out.map_or_else(|| PathBuf::from(format!("{module}.fmu")), Path::to_path_buf);
    if path.extension().is_none_or(|kind| kind != "fmu") {
        return Err(CommandError::FileKind {
            path,
            instead: "an FMU is one file; write `--out NAME.fmu`",
        });
    }
    let compiled = generate(&subject.file, &subject.source, true)?;
    let shown = subject.file.display().to_string();
    let (mechanism, _) = analyse(&subject.source, &Settings::beside(&subject.file))
        .map_err(|errors| CommandError::Description(errors.render(&shown, &subject.source)))?;
    let version = env!("CARGO_PKG_VERSION");
    let identity = identity(&subject.file, &subject.source);
    let key = hash([&*identity, FUNCTIONS, HEADER, version]);
    let guid = format!("{{bricard-{key:016x}}}");
    let built = library(&subject.file, &subject.source)?;
    let instance = format!(
        "/* What makes an FMU of `{module}`. */\n#include \"{module}.h\"\n#define \
         MECHANISM_CREATE {module}_create\n#define MECHANISM_GUID \"{guid}\"\n#define \
         MECHANISM_INPUTS {inputs}\n#include \"fmi2.c\"\n",
        inputs = description::inputs(&mechanism),
    );
    let sources = [
        ("fmu.c", &*instance),
        ("fmi2.c", FUNCTIONS),
        ("bricard.h", HEADER),
        (&*format!("{module}.h"), &*compiled.c_header),
        (&*format!("{module}.mech"), &*subject.source),
        ("lib.rs", &*compiled.code),
    ];
    let linked = link(&built, &module, &sources)?;
    let model = description::description(&mechanism, &module, &guid);
    let mut files = vec![
        ("modelDescription.xml".to_string(), model.into_bytes()),
        (
            format!(
                "binaries/{PLATFORM}/{module}{}",
                std::env::consts::DLL_SUFFIX
            ),
            linked,
        ),
    ];
    let sources = sources.map(|(name, text)| (format!("sources/{name}"), text.into()));
    files.extend(sources);
    pack(&path, &files).map_err(|error| CommandError::write(&path, error))?;
    print(&format!(
        "{} is an FMU of FMI 2.0, for model exchange and co-simulation on {PLATFORM}\n",
        path.display()
    ))
}

/// Compiles the functions of FMI, and links them with the mechanism.
fn link(built: &Library, module: &str, sources: &[(&str, &str)]) -> Result<Vec<u8>, CommandError> {
    let name = format!("bricard-fmu-{}-{module}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    let written = fs::create_dir_all(&folder).and_then(|()| {
        let mut all = sources.iter();
        all.try_for_each(|(name, text)| fs::write(folder.join(name), text))
    });
    let linked = written
        .map_err(|error| CommandError::write(&folder, error))
        .and_then(|()| linked(built, module, &folder));
    let _stays = fs::remove_dir_all(&folder);
    linked
}

fn linked(built: &Library, module: &str, folder: &Path) -> Result<Vec<u8>, CommandError> {
    let mut cc = command("cc");
    cc.args(["-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden"])
        .args(["fmu.c", "-I.", "-o", "fmu"])
        .arg(built.folder.join(Library::fixed(module)))
        .args(built.native().split_whitespace());
    if cfg!(target_os = "linux") {
        // Two FMUs in one process keep their own functions.
        cc.args(["-s", "-Wl,--exclude-libs,ALL", "-Wl,-Bsymbolic"]);
    }
    output(cc, folder, "the FMU could not be linked by the C compiler")?;
    let linked = folder.join("fmu");
    fs::read(&linked).map_err(|error| CommandError::Read(linked, error))
}

/// Writes files into a ZIP archive.
fn pack(path: &Path, files: &[(String, Vec<u8>)]) -> io::Result<()> {
    let mut archive = ZipWriter::new(File::create(path)?);
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        .unix_permissions(0o755);
    for (name, bytes) in files {
        archive.start_file(name.as_str(), options)?;
        archive.write_all(bytes)?;
    }
    archive.finish()?;
    Ok(())
}
