//! Compiles the descriptions of the benchmark problems.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    Builder::new().compile_dir(".")
}
