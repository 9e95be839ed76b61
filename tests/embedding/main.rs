//! Mechanisms used from C and C++, held against the same in Rust, to the last bit; and what
//! the interface evaluates besides.

mod allocation;
mod header;
mod messages;
mod motion;
mod program;
mod slopes;
mod speed;
mod use_in_c;
