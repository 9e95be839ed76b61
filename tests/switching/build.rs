//! Compiles the mechanisms whose forces jump.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    Builder::new().compile_dir(".")
}
