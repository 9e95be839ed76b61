//! Says how the program is laid out in the microcontroller's memory.

use std::path::Path;

fn main() {
    let here = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    // `link.x` is that of cortex-m-rt; it includes the `memory.x` from here.
    println!("cargo::rustc-link-search={here}");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!(
        "cargo::rerun-if-changed={}",
        Path::new(&here).join("memory.x").display()
    );
}
