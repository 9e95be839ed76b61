//! Compiles the mechanisms that are recorded.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    Builder::new().compile_dir(".")?;
    Builder::new().compile("../../mechanisms/benchmarks/whipple_bicycle.mech")
}
