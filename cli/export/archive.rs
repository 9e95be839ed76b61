//! ZIP archives, as FMUs and wheels are.
//!
//! In:  paths with contents.
//! Out: a file.

use crate::error::CommandError;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use zip::write::{SimpleFileOptions, ZipWriter};

/// The files of an archive: paths with contents.
pub type Files = Vec<(String, Vec<u8>)>;

/// Writes an archive.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn write(path: &Path, files: &Files) -> Result<(), CommandError> {
    pack(path, files).map_err(|error| CommandError::write(path, error))
}

fn pack(path: &Path, files: &Files) -> io::Result<()> {
    let mut archive = ZipWriter::new(File::create(path)?);
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        .unix_permissions(0o755);
    for (name, bytes) in files {
        archive.start_file(name.as_str(), options)?;
        archive.write_all(bytes)?;
    }
    archive.finish()?;
    Ok(())
}
