//! `bricard new`: a crate to begin with.
//!
//! In:  a name.
//! Out: a folder with a commented mechanism, the build script that compiles it, and a
//!      program that simulates it.
//!
//! Not here: an existing folder is never touched.

mod text;

use crate::arguments::New;
use crate::error::CommandError;
use crate::output::print;
use bricard_codegen::internals::emit::{module_name, type_name};
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Names that Rust or cargo keep for themselves, and those that the program uses.
const RESERVED: &str = "\
    alloc bool bricard_codegen bricard_runtime build char core deps examples f32 f64 i128 i16 \
    i32 i64 i8 incremental isize main proc_macro std str test u128 u16 u32 u64 u8 usize";

/// Writes the crate.
pub fn new(arguments: &New) -> Result<(), CommandError> {
    let name = arguments.name.as_str();
    let module = module(name)?;
    let workspace = match arguments.path.as_deref() {
        Some(path) => Some(workspace(path)?),
        None => checkout(),
    };
    let folder = PathBuf::from(name);
    if folder.exists() {
        return Err(CommandError::Exists(folder));
    }
    let kind = type_name(&module);
    let files = [
        ("Cargo.toml", text::manifest(name, workspace.as_deref())),
        ("build.rs", text::build_script(&module)),
        ("src/main.rs", text::program(&module, &kind)),
        (
            &*format!("mechanisms/{module}.mech"),
            text::description(&kind),
        ),
        (".gitignore", "/target\n".to_string()),
    ];
    for (file, text) in files {
        write(&folder.join(file), &text)?;
    }
    print(&format!(
        "{name}/ holds a mechanism, its build script and a program that simulates it:\n\n    \
         cd {name}\n    cargo run --release\n\n\
         The mechanism is in mechanisms/{module}.mech.\n{}",
        origin(workspace.as_deref())
    ))
}

/// Where the crates come from, for a person.
fn origin(workspace: Option<&Path>) -> String {
    match workspace {
        Some(folder) => format!(
            "Its dependencies are those in {}; `Cargo.toml` names them.\n",
            folder.display()
        ),
        None => "Its dependencies are the published packages; `bricard new NAME --path DIR` takes \
                 those of a checkout in DIR.\n"
            .to_string(),
    }
}

/// Whether a name means something to Rust, to cargo or in the program.
pub fn is_reserved(name: &str) -> bool {
    RESERVED.split(' ').any(|known| known == name)
}

/// The name of the module and of the description's file.
fn module(name: &str) -> Result<String, CommandError> {
    let refuse = |why| {
        Err(CommandError::Name {
            name: name.to_string(),
            why,
        })
    };
    let first = name.chars().next();
    let letters = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == '-';
    if !first.is_some_and(|c| c.is_ascii_lowercase()) || !name.chars().all(letters) {
        return refuse(
            "it begins with a lower-case letter and goes on with these, digits, `-` and `_`",
        );
    }
    let module = name.replace('-', "_");
    if module.ends_with('_') || module.contains("__") {
        return refuse("`-` and `_` stand alone and between letters");
    }
    if is_reserved(&module) || module_name(&module) != module {
        return refuse("it means something in Rust or to cargo");
    }
    Ok(module)
}

/// The checkout that this command was built from, or is called in, as long as it is there.
/// Packages from a registry hold neither of the two crates.
fn checkout() -> Option<PathBuf> {
    let built = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let here = env::current_dir().ok();
    let around = here.iter().flat_map(|here| here.ancestors());
    let mut folders = [built.as_path()].into_iter().chain(around);
    folders.find_map(|folder| workspace(folder).ok())
}

/// The folder that holds the crates to depend on, in full.
fn workspace(path: &Path) -> Result<PathBuf, CommandError> {
    let has = |package: &&str| path.join(package).join("Cargo.toml").is_file();
    let whole = path.canonicalize().ok();
    whole
        .filter(|_| ["codegen", "runtime"].iter().all(has))
        .ok_or_else(|| CommandError::NoCheckout(path.to_path_buf()))
}

fn write(path: &Path, text: &str) -> Result<(), CommandError> {
    let failed = |error| CommandError::write(path, error);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(failed)?;
    }
    fs::write(path, text).map_err(failed)
}
