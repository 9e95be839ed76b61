//! Descriptions with what no mechanism of the library has: moving frames, velocity
//! constraints, every function, names that Rust reserves.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
