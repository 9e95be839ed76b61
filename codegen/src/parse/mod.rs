//! Text to syntax tree, every node with its place.
//!
//! In:  the text of a description.
//! Out: [`Model`]: what is written, nothing resolved.
//!
//! Four steps: `scan` looks at the characters (so that the lexer cannot fail and
//! no nesting is too deep for a recursive reader), `token` has proc-macro2 lex
//! them, `item`, `start` and `unit` read statements, `expression` reads formulas.
//! A mistake inside a statement is reported and reading goes on behind it; the names
//! that such a statement may have declared are remembered, so that nobody complains of
//! them.
//!
//! Not here: the meaning of names, shapes and units.

pub mod ast;
mod choice;
mod cursor;
mod expression;
mod formula;
mod function;
mod item;
mod literal;
mod model;
mod print;
mod scan;
mod start;
mod stray;
mod token;
mod unit;

pub(crate) use cursor::{CONNECTIVES, DIRECTIONS, SHAPES, STATEMENTS};
pub use formula::{Formula, ModelError};
pub use model::Model;
pub(crate) use print::formula as written;

use crate::diagnostic::{Diagnostics, LIBRARY, without_mark};

/// Levels of brackets, of `if`, of powers and of signs inside one another. People
/// need about ten; the recursive reader has room for these.
pub const NESTING: usize = 100;

/// As much of a description as could be read, and everything that breaks the grammar.
pub(crate) type Read = (Option<Model>, Diagnostics);

/// Reads a description.
///
/// # Errors
///
/// Everything that breaks the grammar, with its place.
pub fn parse(source: &str) -> Result<Model, Diagnostics> {
    match read(source) {
        (Some(model), wrong) if wrong.is_empty() => Ok(model),
        (_, wrong) => Err(wrong),
    }
}

/// Reads as much of a description as can be read, and everything that breaks the
/// grammar.
pub(crate) fn read(source: &str) -> Read {
    let source = without_mark(source);
    let scanned = scan::scan(source);
    let mut wrong = scanned.diagnostics;
    if !scanned.readable {
        return (None, wrong);
    }
    let tokens = match token::tokenize(&scanned.text) {
        Ok(tokens) => tokens,
        Err(unreadable) => {
            wrong.append(unreadable);
            return (None, wrong);
        }
    };
    let mut cursor = cursor::Cursor::new(source, tokens);
    cursor.strays = scanned.strays;
    let model = cursor.file().ok().map(|mut model| {
        model.unreadable = std::mem::take(&mut cursor.unreadable);
        model
    });
    wrong.append(cursor.diagnostics);
    (model, wrong)
}

/// Reads the library of parts.
pub(crate) fn library() -> Vec<ast::Item> {
    let Ok(mut tokens) = token::tokenize(LIBRARY) else {
        return Vec::new();
    };
    tokens
        .list
        .iter_mut()
        .for_each(|token| token.span.library = true);
    cursor::Cursor::new(LIBRARY, tokens).statements()
}

/// Reads one formula that stands by itself, as it would stand in a description.
///
/// # Errors
///
/// Everything that breaks the grammar, with its place.
pub fn formula(source: &str) -> Result<ast::Expr, Diagnostics> {
    scan::clean(source)?;
    let tokens = token::tokenize(source)?;
    let mut cursor = cursor::Cursor::new(source, tokens);
    let read = cursor.expression();
    let ended = matches!(cursor.peek().kind, token::TokenKind::End);
    if read.is_ok() && !ended {
        let _reported = cursor.unexpected("the end of the formula", "");
    }
    match read {
        Ok(expression) if cursor.diagnostics.is_empty() => Ok(expression),
        _ => Err(cursor.diagnostics),
    }
}
