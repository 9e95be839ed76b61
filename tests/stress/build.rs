//! Compiles the mechanisms under stress.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    Builder::new().compile_dir(".")
}
