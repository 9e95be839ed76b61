//! Benchmark problems of multibody dynamics: one module for each description in this
//! folder.
//!
//! They are apart from the library because they are as large, as fast or as badly
//! scaled as their authors could make them.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
