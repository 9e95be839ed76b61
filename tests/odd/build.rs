//! Compiles the odd descriptions, and some of the library's without the coordinates that
//! constraints give.

use bricard_codegen::{BuildError, Builder};
use std::path::PathBuf;
use std::{env, fs};

/// Descriptions with constraints that give a coordinate.
const EXPLICIT: [&str; 8] = [
    "../../mechanisms/slider_crank",
    "../../mechanisms/slider_crank_driven",
    "../../mechanisms/scotch_yoke",
    "../../mechanisms/quick_return",
    "../../mechanisms/driven_pivot",
    "moving_rail",
    "hanging",
    "towed",
];

fn main() -> Result<(), BuildError> {
    let builder = Builder::new().coriolis_matrix(true);
    builder.compile_dir(".")?;
    let folder = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("eliminated");
    fs::create_dir_all(&folder).map_err(|error| BuildError::File(folder.clone(), error))?;
    let builder = builder.eliminate(true).out_dir(&folder);
    EXPLICIT
        .iter()
        .try_for_each(|name| builder.compile(format!("{name}.mech")))
}
