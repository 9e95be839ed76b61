//! Places in a description.

use std::fmt;

/// A place in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position {
    /// The line, from 1.
    pub line: u32,
    /// The character in the line, from 1.
    pub column: u32,
    /// The byte in the file, from 0.
    pub offset: u32,
}

/// A piece of a file: from its start up to, but without, its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// Where it begins.
    pub start: Position,
    /// Where it has ended.
    pub end: Position,
    /// Whether the file is that of the library of parts.
    pub library: bool,
}

impl Span {
    /// The beginning of a file.
    pub const START: Span = {
        let start = Position {
            line: 1,
            column: 1,
            offset: 0,
        };
        Span {
            start,
            end: start,
            library: false,
        }
    };

    /// The piece from the start of this one to the end of another.
    pub fn to(self, other: Span) -> Span {
        Span {
            start: self.start,
            end: other.end.max(self.end),
            library: self.library,
        }
    }

    /// The empty piece behind this one.
    pub fn after(self) -> Span {
        Span {
            start: self.end,
            end: self.end,
            library: self.library,
        }
    }

    /// The bytes of the file that it covers.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start.offset as usize..self.end.offset as usize
    }

    /// Its text.
    pub fn text(self, source: &str) -> &str {
        source.get(self.range()).unwrap_or("")
    }
}

impl fmt::Display for Span {
    /// `line:column` of the start.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.start.line, self.start.column)
    }
}
