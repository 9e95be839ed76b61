//! Compiles chains of several lengths.

use bricard_codegen::{BuildError, Builder};
use std::path::PathBuf;
use std::{env, fs};

const LENGTHS: [u32; 2] = [10, 50];
/// Lengths that the long form compiles besides.
const MORE_LENGTHS: [u32; 2] = [100, 200];

fn main() -> Result<(), BuildError> {
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    let long = env::var_os("CARGO_FEATURE_LONG").is_some();
    let more = if long { &MORE_LENGTHS[..] } else { &[] };
    for n in LENGTHS.iter().chain(more).copied() {
        let folder = out.join(format!("bodies_{n}"));
        fs::create_dir_all(&folder).map_err(|error| BuildError::File(folder.clone(), error))?;
        for name in ["open_chain", "closed_chain"] {
            Builder::new()
                .constant("N", n)
                .out_dir(&folder)
                .compile(format!("mechanisms/{name}.mech"))?;
        }
    }
    Ok(())
}
