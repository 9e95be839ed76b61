//! What comes before a run.
//!
//! In:  the options of `simulate`, a case.
//! Out: the mechanism of the case, the columns to record, and what is said about them.

use super::cases::Case;
use crate::arguments::Simulate;
use crate::changes;
use crate::column::{Column, columns};
use crate::error::CommandError;
use crate::law::find_with;
use crate::mistakes::both;
use crate::output::say;
use bricard_driver::{AnyMechanism, Changes};
use bricard_runtime::{Stabilisation, Structure};

/// What a run begins with.
pub struct Prepared {
    /// The mechanism, with the changes of the case.
    pub mechanism: Box<dyn AnyMechanism>,
    /// The changes.
    pub changes: Changes,
    /// The columns that the command line asks for.
    pub columns: Vec<Column>,
}

/// Refuses what only constraints have a use for, where there are none.
fn useful(arguments: &Simulate, structure: &Structure) -> Result<(), CommandError> {
    let stabilised = arguments.stabilisation != Stabilisation::Projection;
    let given = [
        ("--published", arguments.published),
        ("--stabilisation", stabilised),
    ];
    let mut given = given.into_iter().filter(|(_, is_given)| *is_given);
    match given.next() {
        Some((option, _)) if structure.constraints.is_empty() => Err(CommandError::UselessOption {
            option,
            method: "a mechanism without constraints",
            instead: "leave it out",
        }),
        _ => Ok(()),
    }
}

/// Finds what the command line names for a case.
///
/// # Errors
///
/// As [`find_with`], [`useful`], [`changes::find`] and [`columns`].
pub fn prepared(arguments: &Simulate, case: &Case) -> Result<Prepared, CommandError> {
    let (mut mechanism, set) = find_with(&arguments.name, &case.set)?;
    let structure = mechanism.structure();
    let changes = changes::find(structure, &arguments.name, &set, &case.start);
    let columns = columns(&arguments.columns, structure, &arguments.name);
    let (((), changes), columns) = both(both(useful(arguments, structure), changes), columns)?;
    for name in changes::negative_inertia(&changes, structure) {
        say(&format!("warning: `{name}` is an inertia, and negative"));
    }
    changes::apply(&changes, mechanism.as_mut());
    Ok(Prepared {
        mechanism,
        changes,
        columns,
    })
}
