//! ZIP archives, as FMUs and wheels are.
//!
//! In:  paths with contents.
//! Out: a file, and what is in one.

use crate::error::CommandError;
use crate::output::replace;
use std::fs::File;
use std::io::{self, Cursor, Read, Write};
use std::path::Path;
use zip::ZipArchive;
use zip::write::{SimpleFileOptions, ZipWriter};

/// The files of an archive: paths with contents.
pub type Files = Vec<(String, Vec<u8>)>;

/// Writes an archive, whole or not at all.
///
/// # Errors
///
/// [`CommandError::Write`].
pub fn write(path: &Path, files: &Files) -> Result<(), CommandError> {
    let bytes = pack(files).map_err(|error| CommandError::write(path, error))?;
    replace(path, &bytes)
}

/// Whether a file is an archive in which one file has a text in it.
pub fn holds(path: &Path, name: &str, text: &str) -> bool {
    let archive = File::open(path)
        .ok()
        .and_then(|file| ZipArchive::new(file).ok());
    archive.is_some_and(|mut archive| {
        let mut held = String::new();
        let read = archive
            .by_name(name)
            .map(|mut file| file.read_to_string(&mut held));
        matches!(read, Ok(Ok(_))) && held.contains(text)
    })
}

/// The bytes of an archive: one on a disk that is full could not be closed.
fn pack(files: &Files) -> io::Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        .unix_permissions(0o755);
    for (name, bytes) in files {
        archive.start_file(name.as_str(), options)?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}
