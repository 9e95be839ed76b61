//! A mechanism as an FMU, a functional mock-up unit of FMI 2.0 or 3.0: model exchange and
//! co-simulation in one file.
//!
//! In:  a description.
//! Out: `NAME.fmu`, with the library for this machine and the sources to build others.
//!
//! What the versions share is in `variables` and `instance.c`, what they say differently in
//! `description`, `fmi2.c` and `fmi3.c`.

mod description;
mod variables;
mod version;

pub use version::Version;

use super::archive::{self, Files};
use super::c::library_sources;
use super::sources::described;
use crate::compiled::compiler::{command, output};
use crate::compiled::{Library, generate, identity, library, module_of};
use crate::description::{Description, wrong};
use crate::error::CommandError;
use crate::files::refuse;
use crate::hash::hash;
use crate::output::print;
use bricard_codegen::internals::analyse;
use bricard_codegen::{CompileSettings, Compiled};
use description::{About, description};
use std::fs;
use std::path::{Path, PathBuf};

const HEADER: &str = include_str!("../../../capi/include/bricard.h");
const INSTANCE: &str = include_str!("instance.c");
/// The file that describes an FMU, and the words by which it is known as one of this command.
const DESCRIPTION: &str = "modelDescription.xml";
const TOOL: &str = "generationTool=\"bricard ";

/// Writes the FMU.
///
/// # Errors
///
/// [`CommandError::Description`], [`CommandError::FileKind`], [`CommandError::Exists`] if
/// something else has the name, [`CommandError::Write`], and what stands in the way of
/// compiling.
pub fn export(
    subject: &Description,
    version: Version,
    out: Option<&Path>,
) -> Result<(), CommandError> {
    let module = module_of(&subject.file);
    let path = out.map_or_else(|| PathBuf::from(format!("{module}.fmu")), Path::to_path_buf);
    if path.extension().is_none_or(|kind| kind != "fmu") {
        return refuse(&path, "an FMU is one file; write `--out NAME.fmu`");
    }
    if path.exists() && !archive::holds(&path, DESCRIPTION, TOOL) {
        return Err(CommandError::Exists(path));
    }
    let files = files(subject, version, &module)?;
    archive::write(&path, &files)?;
    print(&format!(
        "{} is an FMU of FMI {}, for model exchange and co-simulation on {}\n",
        path.display(),
        version.number(),
        version.platform()
    ))
}

/// What is in the FMU.
fn files(subject: &Description, version: Version, module: &str) -> Result<Files, CommandError> {
    let Description { file, source } = subject;
    let compiled = generate(file, source, true)?;
    let (mechanism, _) =
        analyse(source, &CompileSettings::beside(file)).map_err(wrong(file, source))?;
    let identity = identity(file, source);
    let functions = [INSTANCE, version.functions().1, HEADER];
    let parts = [&*identity, env!("CARGO_PKG_VERSION")];
    let token = format!(
        "{{bricard-{:016x}}}",
        hash(parts.into_iter().chain(functions))
    );
    let built = library(file, source)?;
    let instance = instance(module, &token, &variables::inputs(&mechanism));
    let sources = sources(version, module, &compiled, &instance);
    let linked = link(&built, module, &sources)?;
    let about = About {
        version,
        identifier: module,
        token: &token,
        differentiated: compiled.differentiated,
    };
    let (platform, suffix) = (version.platform(), std::env::consts::DLL_SUFFIX);
    let text = |name: String, text: String| (name, text.into_bytes());
    let mut files = vec![
        text(DESCRIPTION.to_string(), description(&mechanism, &about)),
        (format!("binaries/{platform}/{module}{suffix}"), linked),
        text(
            "sources/build.sh".to_string(),
            build_script(version, &built, &platform),
        ),
    ];
    let sources = sources
        .into_iter()
        .chain(described(module, subject, &compiled)?)
        .chain(library_sources(module, &compiled));
    files.extend(sources.map(|(name, content)| text(format!("sources/{name}"), content)));
    Ok(files)
}

/// What makes an FMU of a mechanism.
fn instance(module: &str, token: &str, inputs: &str) -> String {
    format!(
        "/* What makes an FMU of `{module}`. */\n#include \"{module}.h\"\n#define \
         MECHANISM_CREATE {module}_create\n#define MECHANISM_TOKEN \"{token}\"\n#define \
         MECHANISM_INPUTS {inputs}\n"
    )
}

/// The sources in C, and what tells a tool of them.
fn sources(
    version: Version,
    module: &str,
    compiled: &Compiled,
    instance: &str,
) -> Vec<(String, String)> {
    let (name, functions) = version.functions();
    let mut sources = vec![
        (
            "fmu.c".to_string(),
            format!("{instance}#include \"{name}\"\n"),
        ),
        (name.to_string(), functions.to_string()),
        ("instance.c".to_string(), INSTANCE.to_string()),
        ("bricard.h".to_string(), HEADER.to_string()),
        (format!("{module}.h"), compiled.c_header.clone()),
    ];
    if version == Version::Three {
        let text = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription \
             fmiVersion=\"3.0\">\n  <BuildConfiguration modelIdentifier=\"{module}\">\n    \
             <SourceFileSet language=\"C99\">\n      <SourceFile name=\"fmu.c\"/>\n    \
             </SourceFileSet>\n    <Library name=\"{}\" description=\"what `cargo build \
             --release` makes of Cargo.toml; build.sh does all of it\"/>\n  \
             </BuildConfiguration>\n</fmiBuildDescription>\n",
            Library::called(module)
        );
        sources.push(("buildDescription.xml".to_string(), text));
    }
    sources
}

/// What the functions are compiled and linked with.
const FLAGS: [&str; 5] = ["-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden"];
/// On Linux besides: two FMUs in one process keep their own functions.
const ALONE: [&str; 3] = ["-s", "-Wl,--exclude-libs,ALL", "-Wl,-Bsymbolic"];

/// Builds the FMU's library anew, on a machine with cargo and a C compiler.
fn build_script(version: Version, built: &Library, platform: &str) -> String {
    let (module, fixed) = (&built.module, Library::fixed(&built.module));
    let suffix = std::env::consts::DLL_SUFFIX;
    format!(
        "#!/bin/sh
# Builds the library of this FMU of FMI {number} anew, by cargo and a C compiler: as it was
# on {platform}; on other systems give the name of the library, and flags as CFLAGS.
set -e
cd \"$(dirname \"$0\")\"
cargo build --release
${{CC:-cc}} {flags} ${{CFLAGS:-{alone}}} fmu.c -I. \\
    \"${{CARGO_TARGET_DIR:-target}}/release/{fixed}\" {native} -o \"${{1:-{module}{suffix}}}\"
",
        number = version.number(),
        flags = FLAGS.join(" "),
        alone = alone().join(" "),
        native = built.native(),
    )
}

/// The flags of this system.
fn alone() -> &'static [&'static str] {
    if cfg!(target_os = "linux") {
        &ALONE
    } else {
        &[]
    }
}

/// Compiles the functions of FMI, and links them with the mechanism.
fn link(
    built: &Library,
    module: &str,
    sources: &[(String, String)],
) -> Result<Vec<u8>, CommandError> {
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
    cc.args(FLAGS)
        .args(["fmu.c", "-I.", "-o", "fmu"])
        .arg(built.folder.join(Library::fixed(module)))
        .args(built.native().split_whitespace())
        .args(alone());
    output(cc, folder, "the FMU could not be linked by the C compiler")?;
    let linked = folder.join("fmu");
    fs::read(&linked).map_err(|error| CommandError::Read(linked, error))
}
