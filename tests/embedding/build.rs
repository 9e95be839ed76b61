//! Compiles the mechanisms, with what makes them known to C.

use bricard_codegen::{BuildError, Builder};
use std::env;

fn main() -> Result<(), BuildError> {
    // The headers have to be found by the tests.
    println!(
        "cargo::rustc-env=HEADERS={}",
        env::var("OUT_DIR").unwrap_or_default()
    );
    let builder = Builder::new().c_interface(true);
    builder.compile("engine.mech")?;
    builder.compile("motor.mech")?;
    builder.compile("../../mechanisms/double_pendulum.mech")
}
