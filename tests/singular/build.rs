//! Compiles the mechanisms and their reductions.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    Builder::new().compile_dir("descriptions")
}
