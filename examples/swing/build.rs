//! Compiles the pendulum of the tutorial.

fn main() -> Result<(), bricard_codegen::BuildError> {
    bricard_codegen::compile("mechanisms/swing.mech")
}
