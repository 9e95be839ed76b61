//! Benchmark problems of multibody dynamics: one module for each description in this
//! folder.
//!
//! They are apart from the library because they are as large, as fast or as badly
//! scaled as their authors could make them.

use bricard_driver::{AnyMechanism, EraseType};

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));

/// A benchmark problem by its name, with its type and sizes forgotten.
pub fn any(name: &str) -> Option<Box<dyn AnyMechanism>> {
    visit(name, EraseType)
}
