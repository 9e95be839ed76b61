//! What comes before a run.
//!
//! In:  the options of `simulate`, a case.
//! Out: the mechanism of the case, and what is said about it.

use super::cases::Case;
use crate::arguments::Simulate;
use crate::changes;
use crate::error::CommandError;
use crate::law::find_with;
use crate::output::say;
use bricard_driver::{AnyMechanism, Changes};

/// Tells the user something who has not asked for silence.
pub fn tell(arguments: &Simulate, text: &str) {
    if !arguments.quiet {
        say(text);
    }
}

/// A mechanism with the changes of a case.
///
/// # Errors
///
/// As [`find_with`] and [`changes::find`].
pub fn prepared(
    arguments: &Simulate,
    case: &Case,
) -> Result<(Box<dyn AnyMechanism>, Changes), CommandError> {
    let (mut mechanism, set) = find_with(&arguments.name, &case.set)?;
    let structure = mechanism.structure();
    let changes = changes::find(structure, &arguments.name, &set, &case.start)?;
    for name in changes::negative_inertia(&changes, structure) {
        let text = format!("warning: `{name}` is an inertia, and negative");
        tell(arguments, &text);
    }
    changes::apply(&changes, mechanism.as_mut());
    Ok((mechanism, changes))
}
