//! What is said of files and folders that a command can't read or write.
//!
//! In:  a path, and what the system says.
//! Out: a message with what to do.

use crate::place::{folder, place};
use bricard_codegen::internals::diagnostic::nearest;
use std::fmt::{self, Formatter};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file that could not be read.
pub fn unread(f: &mut Formatter<'_>, path: &Path, error: &io::Error) -> fmt::Result {
    write!(f, "could not read {}: {error}", path.display())?;
    if let Some(meant) = similar(path).filter(|_| error.kind() == io::ErrorKind::NotFound) {
        write!(f, "; did you mean `{}`?", meant.display())?;
    }
    f.write_str(remedy(error))
}

/// A file or folder that could not be written.
pub fn unwritten(f: &mut Formatter<'_>, path: &Path, error: &io::Error) -> fmt::Result {
    write!(f, "could not write {}: ", path.display())?;
    let place = place(path);
    let folder = folder(&place);
    if error.kind() != io::ErrorKind::NotFound || folder.exists() {
        return write!(f, "{error}{}", remedy(error));
    }
    if path.is_symlink() {
        write!(f, "it is a link to {}, and ", place.display())?;
    }
    write!(
        f,
        "there is no folder {}; make it, or name another file",
        folder.display()
    )
}

/// What to do where something else has a name, or may not be touched.
fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::IsADirectory => "; name a file in it",
        io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
            "; a file stands where a folder is needed: choose another name"
        }
        io::ErrorKind::PermissionDenied => "; choose another place, or ask for the right",
        _ => "",
    }
}

/// The file of the same kind in a folder whose name is most like that of one that is not
/// there, or the description of that name.
fn similar(path: &Path) -> Option<PathBuf> {
    let description = path.with_extension("mech");
    if path.extension().is_none() && description.is_file() {
        return Some(description);
    }
    let names = fs::read_dir(folder(path))
        .ok()?
        .flatten()
        .map(|entry| entry.file_name());
    let names: Vec<String> = names
        .filter(|name| Path::new(name).extension() == path.extension())
        .filter_map(|name| name.into_string().ok())
        .collect();
    let name = path.file_name()?.to_str()?;
    let meant = nearest(name, names.iter().map(String::as_str))?;
    Some(path.with_file_name(meant))
}

/// A name where a file belongs.
pub fn no_file(f: &mut Formatter<'_>, name: &str) -> fmt::Result {
    write!(
        f,
        "`{name}` is a name, and this takes the file of a description, such as `./{name}.mech`"
    )
}

/// A name that is one of a file here.
pub fn name_of_file(f: &mut Formatter<'_>, name: &str, file: &Path) -> fmt::Result {
    write!(
        f,
        "there is no mechanism `{name}` in the library; for the description here write its file, \
         `{}`",
        file.display()
    )
}

/// A folder that is in the way.
pub fn exists(f: &mut Formatter<'_>, path: &Path) -> fmt::Result {
    write!(
        f,
        "{} is there already, and nothing in it was changed; choose another name",
        path.display()
    )
}

/// A file of rows that ends early.
pub fn cut_short(
    f: &mut Formatter<'_>,
    path: &Path,
    rows: usize,
    error: &io::Error,
) -> fmt::Result {
    write!(
        f,
        "could not write {} to its end: {error}; it holds at most the first {rows} rows",
        path.display()
    )
}

/// A file that two options want to write.
pub fn same_file(
    f: &mut Formatter<'_>,
    [one, other]: &[&str; 2],
    path: &Path,
    instead: &str,
) -> fmt::Result {
    let path = path.display();
    write!(
        f,
        "{one} and {other} can't both be written to {path}; {instead}"
    )
}

/// A file to write that the mechanism is read from.
pub fn read_here(f: &mut Formatter<'_>, option: &str, path: &Path) -> fmt::Result {
    write!(
        f,
        "{option} would replace {}, which the mechanism is read from; give it another name",
        path.display()
    )
}

/// A folder that is not fit to keep what is compiled.
pub fn cache(f: &mut Formatter<'_>, path: &Path, error: &io::Error) -> fmt::Result {
    write!(
        f,
        "could not keep what was compiled in {}: {error}; ",
        path.display()
    )?;
    if let io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded = error.kind() {
        f.write_str("make room there (`bricard cache --clear` does), or ")?;
    }
    f.write_str("name another folder with XDG_CACHE_HOME")
}

/// A folder that doesn't hold the crates to depend on.
pub fn no_checkout(f: &mut Formatter<'_>, path: &Path) -> fmt::Result {
    write!(
        f,
        "{} is no checkout of bricard: one has codegen/Cargo.toml and runtime/Cargo.toml in it; \
         name another folder, or leave --path out",
        path.display()
    )
}
