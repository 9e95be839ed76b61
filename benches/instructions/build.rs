//! Compiles what is counted: the paper's mechanisms with their parameters folded and
//! open, rows of parallelograms, and spatial mechanisms.

use bricard_codegen::{BuildError, Builder};
use std::path::PathBuf;
use std::{env, fs, io};

const LIBRARY: &str = "../../mechanisms";
const OWN: &str = "mechanisms";
/// Mechanisms with constraints that give a coordinate.
const EXPLICIT: [&str; 3] = ["slider_crank", "scotch_yoke", "quick_return"];
const ROWS: [u32; 2] = [10, 40];
/// Rows that the long form counts besides.
const MORE_ROWS: [u32; 4] = [2, 5, 20, 80];
/// Chains with several degrees of freedom, with the numbers of loops in both forms.
const CHAINS: [&str; 2] = ["swings", "hung_row"];
const LOOPS: [u32; 1] = [10];
const MORE_LOOPS: [u32; 2] = [20, 40];
/// Numbers of rods in joint angles.
const JOINTS: [u32; 3] = [10, 20, 50];

fn main() -> Result<(), BuildError> {
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    let folder = |name: &str| {
        let folder = out.join(name);
        fs::create_dir_all(&folder)
            .map_err(|error: io::Error| BuildError::File(folder.clone(), error))?;
        Ok::<_, BuildError>(folder)
    };
    for name in ["slider_crank", "double_four_bar"] {
        let path = format!("{LIBRARY}/{name}.mech");
        Builder::new().out_dir(folder("open")?).compile(&path)?;
        frozen(Builder::new(), &path)?
            .out_dir(folder("folded")?)
            .compile(&path)?;
    }
    for name in EXPLICIT {
        let path = format!("{LIBRARY}/{name}.mech");
        for (way, wanted) in [("folded", false), ("eliminated", true)] {
            frozen(Builder::new(), &path)?
                .eliminate(wanted)
                .out_dir(folder(way)?)
                .compile(&path)?;
        }
    }
    let path = format!("{LIBRARY}/benchmarks/andrews.mech");
    frozen(Builder::new(), &path)?
        .out_dir(folder("folded")?)
        .compile(&path)?;
    for name in ["spatial_double_pendulum", "spatial_chain"] {
        let path = format!("{OWN}/{name}.mech");
        Builder::new().out_dir(folder("folded")?).compile(&path)?;
    }
    let long = env::var_os("CARGO_FEATURE_LONG").is_some();
    let more = if long { &MORE_ROWS[..] } else { &[] };
    for n in ROWS.iter().chain(more).copied() {
        let path = format!("{LIBRARY}/n_four_bar.mech");
        let builder = Builder::new()
            .constant("N", n)
            .out_dir(folder(&format!("row_{n}"))?);
        frozen(builder, &path)?.compile(&path)?;
    }
    let more = if long { &MORE_LOOPS[..] } else { &[] };
    for n in LOOPS.iter().chain(more).copied() {
        for name in CHAINS {
            Builder::new()
                .constant("N", n)
                .out_dir(folder(&format!("chain_{n}"))?)
                .compile(format!("{OWN}/{name}.mech"))?;
        }
    }
    for n in JOINTS {
        Builder::new()
            .constant("N", n)
            .out_dir(folder(&format!("joint_{n}"))?)
            .compile(format!("{OWN}/joint_chain.mech"))?;
    }
    Ok(())
}

/// Folds every parameter of a description.
fn frozen(mut builder: Builder, path: &str) -> Result<Builder, BuildError> {
    let text = fs::read_to_string(path).map_err(|error| BuildError::File(path.into(), error))?;
    for line in text.lines() {
        if let Some(rest) = line.trim_start().strip_prefix("param ") {
            let name = rest.split([':', '=', ' ']).next().unwrap_or_default();
            builder = builder.freeze(name);
        }
    }
    Ok(builder)
}
