//! Texts to trees: a description, the library of parts, one formula.

use super::ast::{Expr, Item};
use super::cursor::Cursor;
use super::model::Model;
use super::token::TokenKind;
use super::{scan, token};
use crate::diagnostic::{Diagnostics, LIBRARY, without_mark};
use std::rc::Rc;

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
    let mut cursor = Cursor::new(source, tokens);
    cursor.strays = scanned.strays;
    let model = cursor.file().ok().map(|mut model| {
        model.unreadable = std::mem::take(&mut cursor.unreadable);
        model
    });
    wrong.append(cursor.diagnostics);
    (model, wrong)
}

thread_local! {
    static ITEMS: Rc<[Item]> = items().into();
}

/// The library of parts, which a thread reads once.
pub(crate) fn library() -> Rc<[Item]> {
    ITEMS.with(Rc::clone)
}

fn items() -> Vec<Item> {
    let Ok(mut tokens) = token::tokenize(LIBRARY) else {
        return Vec::new();
    };
    tokens
        .list
        .iter_mut()
        .for_each(|token| token.span.library = true);
    Cursor::new(LIBRARY, tokens).statements()
}

/// Reads one formula that stands by itself, as it would stand in a description.
///
/// # Errors
///
/// Everything that breaks the grammar, with its place.
pub fn formula(source: &str) -> Result<Expr, Diagnostics> {
    scan::clean(source)?;
    let tokens = token::tokenize(source)?;
    let mut cursor = Cursor::new(source, tokens);
    let read = cursor.expression();
    let ended = matches!(cursor.peek().kind, TokenKind::End);
    if read.is_ok() && !ended {
        let _reported = cursor.unexpected("the end of the formula", "");
    }
    match read {
        Ok(expression) if cursor.diagnostics.is_empty() => Ok(expression),
        _ => Err(cursor.diagnostics),
    }
}
