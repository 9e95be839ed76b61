//! How descriptions are compiled that are run by their path or exported.

use bricard_codegen::CompileSettings;
use std::path::Path;

/// The most operations of a function without loops: on what all processors of a kind can do, loops
/// are faster from here on, and are compiled in a fraction of the time.
const UNROLLED: usize = 3_000;

/// The settings for a description in a file.
pub fn settings(file: &Path) -> CompileSettings {
    let mut settings = CompileSettings::beside(file);
    settings.options.unrolled = Some(UNROLLED);
    settings
}
