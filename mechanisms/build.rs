//! Compiles the descriptions of the library.

use bricard_codegen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    Builder::new().coriolis_matrix(true).compile_dir(".")
}
