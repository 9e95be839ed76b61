//! The folder in which compiled descriptions are kept.
//!
//! In:  what was built in a folder beside.
//! Out: whole entries, found by what they were built from.
//!
//! An entry is built in a [`Scratch`] folder and gets its name when it is whole. One
//! process builds at a time; the others wait for it, and need no lock for what is there.

use super::compiler::Toolchain;
use super::sources::SOURCES;
use crate::error::CommandError;
use crate::hash::hash;
use crate::output::say;
use std::env;
use std::fs::{self, DirEntry, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Programs that are kept of one version: the oldest go first.
const MOST_PROGRAMS: usize = 100;
/// Letters of a file's name in that of its program.
const LETTERS: usize = 40;
/// Tells programs that make backups to leave the folder out.
const TAG: &str = "Signature: 8a477f597d28d172789f06886806bc55\n\
                   # This folder holds mechanisms that bricard has compiled.\n";
/// The folders of scratch begin like this.
const SCRATCH: &str = "building";

/// The cache.
#[derive(Clone, Debug)]
pub struct Cache {
    /// Its folder.
    pub root: PathBuf,
}

impl Cache {
    /// The user's cache.
    ///
    /// # Errors
    ///
    /// [`CommandError::Compile`] if the system does not say where that is.
    pub fn find() -> Result<Self, CommandError> {
        let variable = |name| env::var_os(name).map(PathBuf::from);
        // What is no absolute path has to be ignored, says the XDG specification.
        let wanted = variable("XDG_CACHE_HOME").filter(|path| path.is_absolute());
        let usual = || match env::consts::OS {
            "windows" => variable("LOCALAPPDATA"),
            "macos" => variable("HOME").map(|home| home.join("Library/Caches")),
            _ => variable("HOME").map(|home| home.join(".cache")),
        };
        let folder = wanted.or_else(usual).filter(|path| path.is_absolute());
        let folder = folder.ok_or_else(|| {
            CommandError::Compile(
                "there is no folder for compiled descriptions; name one with XDG_CACHE_HOME"
                    .to_string(),
            )
        })?;
        Ok(Self {
            root: folder.join("bricard"),
        })
    }

    /// Waits until no other process changes the cache; as long as the file is open, none
    /// does.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn lock(&self) -> Result<File, CommandError> {
        create(&self.root)?;
        let tag = self.root.join("CACHEDIR.TAG");
        fs::write(&tag, TAG).map_err(|error| CommandError::Cache(tag, error))?;
        let path = self.root.join("lock");
        let failed = |error| CommandError::Cache(path.clone(), error);
        let file = File::create(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                say("waiting for another bricard that is compiling");
                file.lock().map_err(failed)?;
            }
            Err(TryLockError::Error(error)) => return Err(failed(error)),
        }
        Ok(file)
    }
}

/// The numbers that a program computes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// `f64`.
    Double,
    /// 106 bits, to compare runs with.
    Many,
}

/// The part of the cache that belongs to one version of the sources and of the toolchain;
/// what computes in it is of one kind of numbers.
#[derive(Clone, Debug)]
pub struct Version {
    cache: Cache,
    folder: PathBuf,
    /// The numbers that its programs compute with.
    pub digits: Digits,
}

impl Version {
    /// The name of a program in its folder.
    pub const EXECUTABLE: &str = if cfg!(windows) {
        "mechanism.exe"
    } else {
        "mechanism"
    };
    /// The name of the description beside it.
    const DESCRIPTION: &str = "description.mech";

    /// The part of a toolchain, and of the sources that this command carries.
    pub fn new(cache: &Cache, toolchain: &Toolchain, digits: Digits) -> Self {
        let key = hash([&*SOURCES.0.to_string(), &*toolchain.identity]);
        let name = format!("{}-{key:016x}", env!("CARGO_PKG_VERSION"));
        Self {
            cache: cache.clone(),
            folder: cache.root.join(name),
            digits,
        }
    }

    /// Where the libraries of a description for other languages are.
    pub fn exported(&self, file: &Path, source: &str) -> PathBuf {
        self.folder.join("exported").join(named(file, source))
    }

    /// Whether an entry is there and of a description.
    pub fn holds(entry: &Path, source: &str) -> bool {
        let known = fs::read_to_string(entry.join(Self::DESCRIPTION));
        known.is_ok_and(|known| known == source)
    }

    /// Where the libraries are that all programs share.
    pub fn libraries(&self) -> PathBuf {
        self.folder.join("libraries")
    }

    /// Where the boundary to C is.
    pub fn boundary(&self) -> PathBuf {
        self.folder.join("boundary")
    }

    /// Where the module of a description for browsers is.
    pub fn module(&self, file: &Path, source: &str) -> PathBuf {
        self.folder.join("browsers").join(named(file, source))
    }

    /// Where the libraries are that all modules for browsers share.
    pub fn browser_libraries(&self) -> PathBuf {
        self.folder.join("browser-libraries")
    }

    /// Where the library for a pair of sizes is.
    pub fn sized(&self, [coordinates, constraints]: [usize; 2]) -> PathBuf {
        let name = format!("{coordinates}-{constraints}");
        self.folder.join(self.kind("sizes")).join(name)
    }

    /// The program of a description, if it is there.
    pub fn program(&self, file: &Path, source: &str) -> Option<PathBuf> {
        let entry = self.entry(file, source);
        Self::holds(&entry, source).then(|| entry.join(Self::EXECUTABLE))
    }

    /// Where the program of a description belongs.
    fn entry(&self, file: &Path, source: &str) -> PathBuf {
        self.folder
            .join(self.kind("programs"))
            .join(named(file, source))
    }

    /// The name of a folder for what computes with numbers of this kind.
    fn kind(&self, name: &str) -> String {
        match self.digits {
            Digits::Double => name.to_string(),
            Digits::Many => format!("precise-{name}"),
        }
    }

    /// As [`Cache::lock`].
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn lock(&self) -> Result<File, CommandError> {
        let lock = self.cache.lock()?;
        // Nobody else builds now: what looks like it was left behind.
        for entry in entries(&self.folder) {
            if entry.file_name().to_string_lossy().starts_with(SCRATCH) {
                let _stays = fs::remove_dir_all(entry.path());
            }
        }
        Ok(lock)
    }

    /// Adds a program that was built, and makes room for it.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn add(
        &self,
        scratch: Scratch,
        built: &Path,
        file: &Path,
        source: &str,
    ) -> Result<PathBuf, CommandError> {
        let entry = self.entry(file, source);
        self.shelve(scratch, built, &entry, source)?;
        Ok(entry.join(Self::EXECUTABLE))
    }

    /// Adds what was built of a description as an entry, and makes room for it.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn shelve(
        &self,
        scratch: Scratch,
        built: &Path,
        entry: &Path,
        source: &str,
    ) -> Result<(), CommandError> {
        let description = built.join(Self::DESCRIPTION);
        fs::write(&description, source).map_err(|error| CommandError::Cache(description, error))?;
        scratch.keep(built, entry)?;
        let shelf = entry.parent().unwrap_or(&self.folder);
        let mut programs = entries(shelf);
        let age = |entry: &DirEntry| entry.metadata().and_then(|data| data.modified()).ok();
        programs.sort_by_key(|entry| std::cmp::Reverse(age(entry)));
        for old in programs.iter().skip(MOST_PROGRAMS) {
            let _stays = fs::remove_dir_all(old.path());
        }
        Ok(())
    }
}

/// The name of the entry of a description. The name of the file is part of what was built,
/// which tells it.
fn named(file: &Path, source: &str) -> String {
    let name = name(file);
    let key = hash([&*name, source]);
    let begin: String = name
        .trim_end_matches(".mech")
        .chars()
        .take(LETTERS)
        .collect();
    format!("{begin}-{key:016x}")
}

/// The entries of a folder; none if there is no such folder.
pub fn entries(folder: &Path) -> Vec<DirEntry> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    entries.filter_map(Result::ok).collect()
}

/// A folder in which something is built. It goes with its owner.
#[derive(Debug)]
pub struct Scratch(PathBuf);

impl Scratch {
    /// An empty folder in the part of a version, so that what was built in it can be moved
    /// to its place.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn new(version: &Version) -> Result<Self, CommandError> {
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        let nanos = now.map_or(0, |now| now.as_nanos());
        let name = format!("{SCRATCH}-{}-{nanos}", std::process::id());
        let folder = version.folder.join(name);
        create(&folder)?;
        Ok(Self(folder))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// A folder in it.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn folder(&self, name: &str) -> Result<PathBuf, CommandError> {
        let folder = self.0.join(name);
        create(&folder)?;
        Ok(folder)
    }

    /// Writes a file in it.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn write(&self, name: &Path, text: &str) -> Result<(), CommandError> {
        let path = self.0.join(name);
        if let Some(folder) = path.parent() {
            create(folder)?;
        }
        fs::write(&path, text).map_err(|error| CommandError::Cache(path, error))
    }

    /// Gives what was built in a folder of it its name, all at once.
    ///
    /// # Errors
    ///
    /// [`CommandError::Cache`].
    pub fn keep(&self, built: &Path, name: &Path) -> Result<(), CommandError> {
        if let Some(folder) = name.parent() {
            create(folder)?;
        }
        // What bears the name was not whole, or not what it should be.
        let _nothing_there = fs::remove_dir_all(name);
        fs::rename(built, name).map_err(|error| CommandError::Cache(name.to_path_buf(), error))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _stays = fs::remove_dir_all(&self.0);
    }
}

/// Creates a folder and all above it.
///
/// # Errors
///
/// What the system says.
fn create(folder: &Path) -> Result<(), CommandError> {
    let failed = |error: io::Error| CommandError::Cache(folder.to_path_buf(), error);
    fs::create_dir_all(folder).map_err(failed)
}

/// The name of a file without its folder: a program is the same wherever the file lies.
pub fn name(file: &Path) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    name.to_string_lossy().into_owned()
}
