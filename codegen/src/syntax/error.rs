//! What is wrong with the texts that a program gives.

use crate::diagnostic::{Diagnostic, Diagnostics, Position, Span};
use std::fmt::{self, Display, Formatter};

/// Texts that were given as formulas, units or names and can't be read as such.
///
/// Displayed, and shown by `Debug`, as messages with the text underlined.
#[derive(Clone, Default)]
pub struct ModelError {
    pub(super) parts: Vec<(String, Diagnostics)>,
}

impl ModelError {
    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    pub(super) fn push(&mut self, text: &str, diagnostics: Diagnostics) {
        self.parts.push((text.to_string(), diagnostics));
    }

    /// Keeps a complaint unless the text can be a name.
    pub(super) fn check_name(&mut self, name: &str) {
        let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let first = name.chars().next();
        if first.is_some_and(|c| !c.is_ascii_digit()) && name.chars().all(letters) {
            return;
        }
        let size = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let at = |column: usize, offset: usize| Position {
            line: 1,
            column: size(column + 1),
            offset: size(offset),
        };
        let span = Span {
            library: false,
            start: at(0, 0),
            end: at(name.chars().count(), name.len()),
        };
        let error = Diagnostic::error(span, format!("`{name}` is no name"));
        let mut diagnostics = Diagnostics::new();
        diagnostics.push(error.help("names are made of the letters a–z and A–Z, digits and `_`"));
        self.push(name, diagnostics);
    }
}

impl Display for ModelError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let parts = self.parts.iter();
        let rendered = parts.map(|(text, diagnostics)| diagnostics.render("model", text));
        f.write_str(rendered.collect::<Vec<_>>().join("\n").trim_end())
    }
}

impl fmt::Debug for ModelError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}

impl std::error::Error for ModelError {}
