//! Compiles the mechanism.

fn main() -> Result<(), bricard_codegen::BuildError> {
    bricard_codegen::compile("../mechanisms/engine.mech")
}
