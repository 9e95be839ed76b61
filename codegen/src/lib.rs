//! Compiles mechanism descriptions to specialised Rust.
