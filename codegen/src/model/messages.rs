//! What several modules of this stage say, in the same words.
//!
//! In:  names, shapes and counts.
//! Out: sentences of messages.

use super::value::Value;
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::ast::Name;
use crate::syntax::messages::RENAME;

/// What is constant because code depends on it.
pub const SIZE: &str = "the size of an array";

/// What to do where two sides have different shapes.
pub const ONE_SIZE: &str = "both sides are numbers, or vectors of one size";

/// What to do where both sides are arrays of vectors or matrices.
pub const BY_ROWS: &str =
    "write an equation for each row: `for i in 0..3 { constraint A[i] = B[i]; }`";

/// Says that two sides are of one shape that has no equations.
pub fn sides_are(of: &str, side: &Value) -> String {
    format!("each side of this {of} is {}", side.shape())
}

/// Says that two sides, of an equation or of a choice, have different shapes.
pub fn sides_differ(of: &str, one: &Value, other: &Value) -> String {
    let (one, other) = (one.shape(), other.shape());
    format!("one side of this {of} is {one}, the other {other}")
}

/// The finding that an array has elements of different shapes.
pub fn elements_differ(span: Span) -> Diagnostic {
    Diagnostic::error(span, "the elements of an array have different shapes")
        .help("write numbers only, or vectors of one size")
}

/// Says that places in a table don't rise.
pub fn not_rising(before: f64, here: f64) -> String {
    format!("{here} stands behind {before}, and these numbers have to rise")
}

/// The finding that a name belongs to a part of the library.
pub fn part_of_library(name: &Name) -> Diagnostic {
    let message = format!("the library has a part `{}`", name.text);
    Diagnostic::error(name.span, message).help(RENAME)
}

/// How many arguments something takes.
pub fn count(arguments: usize) -> String {
    match arguments {
        1 => "one argument".into(),
        2 => "two arguments".into(),
        n => format!("{n} arguments"),
    }
}

/// Says that a function or a part is given another number of arguments.
pub fn takes_others(name: &str, takes: &str, found: usize) -> String {
    format!("`{name}` takes {takes}, here {}", are(found))
}

/// How many there are, behind the word "here".
pub fn are(found: usize) -> String {
    match found {
        0 => "is none".into(),
        1 => "is one".into(),
        n => format!("are {n}"),
    }
}
