//! `bricard export`: a mechanism for other programs.
//!
//! In:  a description.
//! Out: a folder: a crate of generated Rust, or libraries for C or a package for npm with
//!      all that belongs to them; or a file, an FMU or a wheel. Each has an example that
//!      runs, but FMUs.
//!
//! Not here: a folder that something else has made is never touched.

mod archive;
mod c;
mod fmi;
mod folder;
mod python;
mod rust;
mod sources;
mod wasm;

use crate::arguments::{Export, Target};
use crate::compiled::{Library, library};
use crate::error::CommandError;
use crate::mechanism::description;
use crate::output::print;

/// Writes a mechanism for other programs.
///
/// # Errors
///
/// What is wrong with the description, or stands in the way of the folder or the compiler.
pub fn export(arguments: &Export) -> Result<(), CommandError> {
    let subject = description(&arguments.subject)?;
    let out = arguments.out.as_deref();
    match arguments.to {
        Target::Rust => rust::export(&subject, out),
        Target::C => c::export(&subject, out),
        Target::Fmi2 => fmi::export(&subject, fmi::Version::Two, out),
        Target::Fmi3 => fmi::export(&subject, fmi::Version::Three, out),
        Target::Python => python::export(&subject, out),
        Target::Wasm => wasm::export(&subject, out),
        Target::Library => {
            if out.is_some() {
                return Err(CommandError::UselessOption {
                    option: "--out",
                    method: "--to library",
                    instead: "the library stays in the cache; for a folder of its own write `--to c`",
                });
            }
            let built = library(&subject.file, &subject.source)?;
            let path = built.folder.join(Library::shared(&built.module));
            print(&format!("{}\n", path.display()))
        }
    }
}
