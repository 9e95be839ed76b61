//! Compiles the driven slider–crank, its parameters folded as the peers' are.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    ["L1", "L2", "m1", "m2", "m3", "J1", "J2"]
        .into_iter()
        .fold(Builder::new(), Builder::freeze)
        .compile("../../mechanisms/slider_crank_driven.mech")
}
