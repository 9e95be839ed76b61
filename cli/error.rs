//! Why a command could not do what it was asked to, in the user's words.
//!
//! Out: [`CommandError`]: a message and an exit status.

use crate::file_error::{
    cache, cut_short, exists, name_of_file, no_checkout, no_file, read_here, same_file, unread,
    unwritten,
};
use crate::interrupt::INTERRUPTED;
use crate::number::exact;
use bricard_codegen::internals::diagnostic::nearest;
use std::fmt::{self, Display, Formatter};
use std::io;
use std::path::{Path, PathBuf};

/// Exit status of a command line that is wrong.
const WRONG_COMMAND_LINE: u8 = 2;
/// Exit status of a run that failed.
const FAILED: u8 = 1;

/// Why a command could not do what it was asked to.
#[derive(Debug)]
pub enum CommandError {
    /// Several mistakes, to be told at once.
    Several(Vec<Self>),
    /// Names that nothing has.
    UnknownName {
        /// What the names should be of: `mechanism`, `parameter`, …
        kind: &'static str,
        /// Whose they should be; empty for the library's own.
        owner: String,
        /// The names as given.
        names: Vec<String>,
        /// What there is.
        known: Vec<String>,
    },
    /// A name that no mechanism of the library has, beside the file that is meant.
    NameOfFile(String, PathBuf),
    /// A name of something that is no column to add.
    NoColumn {
        /// The name.
        name: String,
        /// What it is instead.
        reason: String,
    },
    /// A number that makes no sense.
    OutOfRange {
        /// The option.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What would make sense.
        wanted: String,
    },
    /// A name that an option gives two values.
    Twice {
        /// The option.
        option: &'static str,
        /// The name.
        name: String,
    },
    /// A word that a list has twice.
    Repeated {
        /// The option.
        option: &'static str,
        /// The word.
        word: String,
    },
    /// What a name can't be set to, or at all.
    InvalidSetting {
        /// The name.
        name: String,
        /// Why, and what to write instead.
        reason: String,
    },
    /// A start of what is no part of the state.
    SetInstead {
        /// The parameter or input.
        name: String,
    },
    /// Two options with several values each.
    TwoLists {
        /// The options with their names.
        options: [String; 2],
    },
    /// More runs than something has room for.
    Runs(TooMany),
    /// A file that two options want to write.
    SameFile {
        /// The options.
        options: [&'static str; 2],
        /// The file.
        path: PathBuf,
        /// What to write instead.
        instead: &'static str,
    },
    /// A file to write that the mechanism is read from.
    ReadHere {
        /// The option.
        option: &'static str,
        /// The file.
        path: PathBuf,
    },
    /// An option that the chosen method has no use for.
    UselessOption {
        /// The option.
        option: &'static str,
        /// The method.
        method: &'static str,
        /// What to write instead.
        instead: &'static str,
    },
    /// A kind of file that can't be written.
    FileKind {
        /// The file.
        path: PathBuf,
        /// What to write instead.
        instead: &'static str,
    },
    /// A file that could not be read.
    Read(PathBuf, io::Error),
    /// A folder that doesn't hold the crates to depend on.
    NoCheckout(PathBuf),
    /// A file or folder that could not be written.
    Write(PathBuf, io::Error),
    /// A file of rows that could not be written to its end.
    WriteRows {
        /// The file.
        path: PathBuf,
        /// Rows handed over before.
        rows: usize,
        /// What the system says.
        error: io::Error,
    },
    /// A picture that could not be drawn, with the drawing library's words.
    Draw(PathBuf, String),
    /// A description that is wrong: the rendered messages.
    Description(String),
    /// A run that could not begin or ended early.
    Run {
        /// Why.
        reason: String,
        /// What became of the rows computed before.
        kept: String,
    },
    /// A checkpoint that a run can't go on from.
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A run that Ctrl-C ended.
    Interrupted {
        /// What became of the rows computed before.
        kept: String,
    },
    /// A description that could not be compiled, or whose program could not be started.
    Compile(String),
    /// A name where a file is wanted.
    NoFile(String),
    /// A file that can't be watched, and why.
    Watch(String, String),
    /// A file or folder of the cache that could not be used.
    Cache(PathBuf, io::Error),
    /// A folder that is there already.
    Exists(PathBuf),
    /// A name that a crate can't have.
    Name {
        /// The name.
        name: String,
        /// What a name has to be, or what this one is already.
        why: &'static str,
    },
    /// What is wrong has been written where it was asked for.
    Said,
    /// Bounds that a reproduced experiment does not keep.
    OutOfBounds(Vec<String>),
    /// The reader of standard output has gone.
    NobodyReads,
}

/// More runs than something has room for.
#[derive(Debug)]
pub struct TooMany {
    /// What it has room for.
    pub what: &'static str,
    /// The option that asks for them.
    pub varied: String,
    /// How many.
    pub count: usize,
    /// What to write instead.
    pub instead: &'static str,
}

impl CommandError {
    /// A run that could not begin or ended early, of which no rows are known yet.
    pub fn run(reason: String) -> Self {
        let kept = String::new();
        Self::Run { reason, kept }
    }

    /// A run that Ctrl-C ended, of which no rows are known yet.
    pub fn interrupted() -> Self {
        let kept = String::new();
        Self::Interrupted { kept }
    }

    /// A failure to write a file; a reader that has gone is a case of its own.
    pub fn write(path: &Path, error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::NobodyReads,
            _ => Self::Write(path.to_path_buf(), error),
        }
    }

    /// A failure to write rows.
    pub fn write_rows(path: &Path, rows: usize, error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::NobodyReads,
            _ => Self::WriteRows {
                path: path.to_path_buf(),
                rows,
                error,
            },
        }
    }

    /// This error, with what became of the rows of the run.
    pub fn with(self, kept: String) -> Self {
        match self {
            Self::Run { reason, .. } => Self::Run { reason, kept },
            Self::Interrupted { .. } => Self::Interrupted { kept },
            error => error,
        }
    }

    /// Whether nothing more is wanted, of other runs either.
    pub fn ends_all(&self) -> bool {
        matches!(
            self,
            Self::Interrupted { .. } | Self::NobodyReads | Self::Write(..) | Self::WriteRows { .. }
        )
    }

    /// The exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Several(all) => all.first().map_or(FAILED, Self::status),
            Self::UnknownName { .. }
            | Self::NameOfFile(..)
            | Self::NoColumn { .. }
            | Self::OutOfRange { .. }
            | Self::Twice { .. }
            | Self::Repeated { .. }
            | Self::InvalidSetting { .. }
            | Self::SetInstead { .. }
            | Self::TwoLists { .. }
            | Self::Runs(_)
            | Self::SameFile { .. }
            | Self::ReadHere { .. }
            | Self::UselessOption { .. }
            | Self::FileKind { .. }
            | Self::Checkpoint { .. }
            | Self::NoFile(_)
            | Self::NoCheckout(_)
            | Self::Name { .. } => WRONG_COMMAND_LINE,
            Self::NobodyReads => 0,
            Self::Interrupted { .. } => INTERRUPTED,
            _ => FAILED,
        }
    }

    /// Whether there is nobody to tell.
    pub fn is_silent(&self) -> bool {
        matches!(self, Self::NobodyReads | Self::Said)
    }
}

impl Display for CommandError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Several(all) => several(f, all),
            Self::UnknownName {
                kind,
                owner,
                names,
                known,
            } => unknown_names(f, kind, owner, names, known),
            Self::NameOfFile(name, file) => name_of_file(f, name, file),
            Self::NoColumn { name, reason } => write!(f, "`{name}` {reason}"),
            Self::OutOfRange {
                option,
                value,
                wanted,
            } => write!(f, "{option} must be {wanted}, not {}", exact(*value)),
            Self::Twice { option, name } => {
                write!(f, "{option} gives `{name}` two values; leave one out")
            }
            Self::Repeated { option, word } => repeated(f, option, word),
            Self::InvalidSetting { name, reason } => write!(f, "`--set {name}=…`: {reason}"),
            Self::SetInstead { name } => set_instead(f, name),
            Self::TwoLists { options } => two_lists(f, options),
            Self::Runs(runs) => write!(f, "{runs}"),
            Self::SameFile {
                options,
                path,
                instead,
            } => same_file(f, options, path, instead),
            Self::ReadHere { option, path } => read_here(f, option, path),
            Self::UselessOption {
                option,
                method,
                instead,
            } => write!(f, "{method} has no use for {option}; {instead}"),
            Self::FileKind { path, instead } => {
                write!(f, "{} can't be written: {instead}", path.display())
            }
            Self::Read(path, error) => unread(f, path, error),
            Self::NoCheckout(path) => no_checkout(f, path),
            Self::Write(path, error) => unwritten(f, path, error),
            Self::WriteRows { path, rows, error } => cut_short(f, path, *rows, error),
            Self::Draw(path, error) => write!(f, "could not draw {}: {error}", path.display()),
            Self::Description(rendered) => write!(f, "the description is wrong\n\n{rendered}"),
            Self::Run { reason, kept } => write!(f, "{reason}{kept}"),
            Self::Checkpoint { path, reason } => {
                write!(f, "can't go on from {}: {reason}", path.display())
            }
            Self::Interrupted { kept } => write!(f, "interrupted{kept}"),
            Self::NoFile(name) => no_file(f, name),
            Self::Watch(name, reason) => write!(f, "can't watch {name}: {reason}"),
            Self::Compile(reason) => f.write_str(reason),
            Self::Cache(path, error) => cache(f, path, error),
            Self::Exists(path) => exists(f, path),
            Self::Name { name, why } => write!(f, "a crate can't be called `{name}`: {why}"),
            Self::Said => Ok(()),
            Self::OutOfBounds(broken) => out_of_bounds(f, broken),
            Self::NobodyReads => f.write_str("nobody reads standard output any more"),
        }
    }
}

fn repeated(f: &mut Formatter<'_>, option: &str, word: &str) -> fmt::Result {
    write!(f, "{option} has `{word}` twice; leave one out")
}

fn out_of_bounds(f: &mut Formatter<'_>, broken: &[String]) -> fmt::Result {
    f.write_str("these bounds are not kept:")?;
    broken.iter().try_for_each(|bound| write!(f, "\n  {bound}"))
}

fn set_instead(f: &mut Formatter<'_>, name: &str) -> fmt::Result {
    write!(
        f,
        "`--start {name}=…`: it is a parameter or an input; write `--set {name}=…`"
    )
}

fn two_lists(f: &mut Formatter<'_>, [one, other]: &[String; 2]) -> fmt::Result {
    write!(
        f,
        "`{one}` and `{other}` have several values each, and runs are compared by one of them; \
         give the other a single value"
    )
}

impl Display for TooMany {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self {
            what,
            varied,
            count,
            instead,
        } = self;
        write!(f, "{what}, and `{varied}` asks for {count}; {instead}")
    }
}

fn several(f: &mut Formatter<'_>, all: &[CommandError]) -> fmt::Result {
    for (i, error) in all.iter().enumerate() {
        let between = if i == 0 { "" } else { "\n" };
        write!(f, "{between}{error}")?;
    }
    Ok(())
}

fn unknown_names(
    f: &mut Formatter<'_>,
    kind: &str,
    owner: &str,
    names: &[String],
    known: &[String],
) -> fmt::Result {
    let of = if owner.is_empty() {
        String::new()
    } else {
        format!(" in `{owner}`")
    };
    for name in names {
        write!(f, "there is no {kind} `{name}`{of}")?;
        if let Some(meant) = nearest(name, known.iter().map(String::as_str)) {
            write!(f, "; did you mean `{meant}`?")?;
        }
        writeln!(f)?;
    }
    match known {
        [] => write!(f, "there are none"),
        _ => write!(f, "there are: {}", known.join(", ")),
    }
}

impl std::error::Error for CommandError {}
