//! A mechanism as a crate of generated Rust.
//!
//! In:  a description.
//! Out: a crate without a build script, for people who keep generated code with their own.

use super::folder::Folder;
use super::sources;
use crate::compiled::{generate, module_of};
use crate::description::Description;
use crate::error::CommandError;
use crate::new::is_reserved;
use crate::output::{print, typed};
use bricard_codegen::internals::emit::type_name;
use std::path::{Path, PathBuf};

/// Packages that the crate can't have the name of.
const NEIGHBOURS: [&str; 2] = ["nalgebra", "num_traits"];

/// Writes the crate.
///
/// # Errors
///
/// [`CommandError::Description`], [`CommandError::Exists`], [`CommandError::Write`].
pub fn export(subject: &Description, out: Option<&Path>) -> Result<(), CommandError> {
    let module = module_of(&subject.file);
    let compiled = generate(&subject.file, &subject.source, false)?;
    let name = match is_reserved(&module) || NEIGHBOURS.contains(&&*module) {
        true => format!("{module}_mechanism"),
        false => module.clone(),
    };
    let kind = type_name(&compiled.name);
    // It may be in the folder itself.
    let described = sources::described(&module, subject, &compiled)?;
    let folder = Folder::new(&out.map_or_else(|| PathBuf::from(&module), Path::to_path_buf))?;
    let about = format!("The mechanism {}, compiled by bricard", compiled.name);
    let library = "doctest = false\n";
    folder.write(
        "Cargo.toml",
        &sources::manifest(&name, &about, library, &["runtime"]),
    )?;
    folder.write("src/lib.rs", &(front(&compiled.name) + &compiled.code))?;
    let example = EXAMPLE
        .replace("CRATE", &name)
        .replace("MODULE", &module)
        .replace("KIND", &kind);
    folder.write("examples/simulate.rs", &example)?;
    folder.write_all(described)?;
    folder.write(".gitignore", "/target\n")?;
    sources::write(&folder, &["runtime"])?;
    print(&format!(
        "{} holds the crate `{name}`:\n\n    cd {}\n    cargo run --release --example simulate\n",
        folder.path().display(),
        typed(folder.path())
    ))
}

/// What the library begins with.
fn front(name: &str) -> String {
    format!(
        "//! The mechanism {name}, as bricard has compiled it. `examples/simulate.rs` uses it.\n\n\
         pub use bricard_runtime;\n\n"
    )
}

const EXAMPLE: &str = r#"//! Simulates the mechanism for ten seconds: `cargo run --release --example simulate`.

use CRATE::bricard_runtime::{Interface, Mechanism, Options, Recorder, assemble, simulate};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // Parameters have the values of the description; they are fields of
    // `mechanism.parameters`.
    let mechanism = CRATE::MODULE::KIND::<f64>::default();

    // The guesses of `start` are moved until the constraints hold.
    let start = assemble(&mechanism, &mechanism.start(), 0.0)?;

    // Ten seconds by the Dormand–Prince method of order 8, to nine digits per step; a row
    // each half second.
    let options = Options::dop853(10.0, 1e-9);
    let mut recorder = Recorder::new(0.5)?;
    let summary = simulate(&mechanism, &start, &options, &mut [&mut recorder])?;

    // Coordinates, and behind them what the description calls states, if it has some:
    // their values stand behind the velocities.
    let structure = mechanism.structure();
    let freedoms = structure.freedoms().len();
    print!("{:>6}", "t");
    for quantity in structure.coordinates {
        print!(" {:>12}", quantity.name);
    }
    println!();
    for state in recorder.rows() {
        print!("{:6.2}", state.t);
        let states = state.v.iter().skip(freedoms);
        for value in state.q.iter().take(freedoms).chain(states) {
            print!(" {value:12.6}");
        }
        println!();
    }
    println!("{summary}");
    Ok(())
}
"#;
