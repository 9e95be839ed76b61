//! Compiles both descriptions of each pair.

use bricard_codegen::{BuildError, Builder};
use std::path::PathBuf;
use std::{env, fs};

#[expect(dead_code, reason = "words for the table")]
#[path = "src/pairs.rs"]
mod pairs;

fn main() -> Result<(), BuildError> {
    println!("cargo::rerun-if-changed=src/pairs.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    for pair in pairs::PAIRS {
        for (way, adds) in ["with", "without"].iter().zip(pair.adds) {
            let name = format!("{}_{way}", pair.name);
            let path = out.join(format!("{name}.mech"));
            let text = format!("mechanism Pair {{ {} {adds} }}\n", pair.common);
            fs::write(&path, text).map_err(|error| BuildError::File(path.clone(), error))?;
            Builder::new().out_dir(&out).compile(&path)?;
        }
    }
    Ok(())
}
