//! A description: what is read, or made by calls.

use super::ast::{Declared, Item, ItemKind, Name};
use super::error::ModelError;
use crate::diagnostic::Span;

/// A description: a name and statements.
///
/// ```
/// use bricard_codegen::{Formula, Model};
/// let speed = Formula::from("x").der();
/// let model = Model::new("Oscillator")
///     .docs("A mass on a spring.")
///     .parameter("m", "kg", 1)
///     .parameter("k", "N/m", 20)
///     .coordinate("x", "m")
///     .kinetic(Formula::from("1/2*m") * speed.powi(2))
///     .potential("1/2*k*x^2")
///     .held("x", 0.1);
/// assert!(model.text()?.contains("kinetic 1/2*m*der(x)^2;"));
/// # Ok::<(), bricard_codegen::ModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    /// The name after `mechanism`.
    pub(crate) name: Name,
    /// Its doc comment.
    pub(crate) docs: String,
    /// What stands between its braces.
    pub(crate) items: Vec<Item>,
    /// Names that unreadable statements may have declared.
    pub(crate) unreadable: Vec<String>,
    /// What was no formula, no unit or no name.
    pub(super) faults: ModelError,
}

impl Model {
    /// Where the law of an input of the mechanism itself stands.
    #[doc(hidden)]
    pub fn law_of(&self, input: &str) -> Option<Span> {
        self.items.iter().find_map(|item| match &item.kind {
            ItemKind::Declaration(d) if d.kind == Declared::Input && d.name.text == input => {
                Some(d.value.span)
            }
            _ => None,
        })
    }

    /// The parameters of the mechanism itself that are no arrays, and where their values
    /// stand.
    #[doc(hidden)]
    pub fn values(&self) -> impl Iterator<Item = (&str, Span)> {
        self.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Declaration(d) if d.kind == Declared::Parameter && d.size.is_none() => {
                Some((d.name.text.as_str(), d.value.span))
            }
            _ => None,
        })
    }

    /// Whether a name is that of a constant of the mechanism itself.
    #[doc(hidden)]
    pub fn is_constant(&self, name: &str) -> bool {
        self.items.iter().any(|item| match &item.kind {
            ItemKind::Declaration(d) => d.kind == Declared::Constant && d.name.text == name,
            _ => false,
        })
    }

    /// As the parser begins one.
    pub(crate) fn named(name: Name, docs: String) -> Self {
        Self {
            name,
            docs,
            items: Vec::new(),
            unreadable: Vec::new(),
            faults: ModelError::default(),
        }
    }

    /// Adds a statement as the parser has read it.
    pub(crate) fn add(&mut self, item: Item) {
        self.items.push(item);
    }
}
