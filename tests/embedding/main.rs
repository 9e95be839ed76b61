//! Mechanisms used from C and C++, held against the same in Rust, to the last bit.

mod allocation;
mod header;
mod motion;
mod program;
mod speed;
mod use_in_c;
