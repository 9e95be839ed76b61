//! The words of the language, for editors and other tools.
//!
//! Out: every word that means something, by what it is.

use crate::expr::Function;
use crate::{model, syntax};

/// Words that begin a statement, `for` aside.
pub fn statements() -> impl Iterator<Item = &'static str> {
    syntax::STATEMENTS.iter().map(|(word, ..)| *word)
}

/// Words that hold statements and formulas together.
pub fn connectives() -> impl Iterator<Item = &'static str> {
    syntax::CONNECTIVES.into_iter()
}

/// What can be drawn.
pub fn shapes() -> impl Iterator<Item = &'static str> {
    syntax::SHAPES.iter().map(|(word, _)| *word)
}

/// The directions of events.
pub fn directions() -> impl Iterator<Item = &'static str> {
    syntax::DIRECTIONS.iter().map(|(word, _)| *word)
}

/// Functions.
pub fn functions() -> impl Iterator<Item = &'static str> {
    let unary = Function::ALL.iter().map(|(_, name)| *name);
    unary.chain(model::other_functions())
}

/// Names that mean something everywhere.
pub fn constants() -> impl Iterator<Item = &'static str> {
    model::built_in()
}

/// Units that hide a factor, and the factor that turns a number in them into SI.
pub fn scaled_units() -> impl Iterator<Item = (&'static str, &'static str)> {
    model::scaled_units()
}

/// Units.
pub fn units() -> impl Iterator<Item = &'static str> {
    model::units()
}
