//! All mistakes of a command line at once.
//!
//! In:  results that don't depend on one another.
//! Out: what they hold, or everything that is wrong.

use crate::error::CommandError;
use clap::ValueEnum;
use std::slice;

/// What all results hold, or all that is wrong.
///
/// # Errors
///
/// The only error, or [`CommandError::Several`].
pub fn all<T>(
    results: impl IntoIterator<Item = Result<T, CommandError>>,
) -> Result<Vec<T>, CommandError> {
    let mut so_far = Ok(Vec::new());
    for result in results {
        so_far = both(so_far, result).map(|(mut values, value)| {
            values.push(value);
            values
        });
    }
    so_far
}

/// What two results hold, or all that is wrong.
///
/// # Errors
///
/// As [`all`].
pub fn both<A, B>(
    one: Result<A, CommandError>,
    other: Result<B, CommandError>,
) -> Result<(A, B), CommandError> {
    match (one, other) {
        (Ok(one), Ok(other)) => Ok((one, other)),
        (Err(one), Err(other)) => Err(joined(one, other)),
        (Err(error), _) | (_, Err(error)) => Err(error),
    }
}

/// Refuses a list that has a word twice.
///
/// # Errors
///
/// [`CommandError::Repeated`].
pub fn once<T: ValueEnum + PartialEq>(
    option: &'static str,
    values: &[T],
) -> Result<(), CommandError> {
    let mut all = values.iter().enumerate();
    match all.find(|(i, value)| values[..*i].contains(value)) {
        None => Ok(()),
        Some((_, value)) => Err(CommandError::Repeated {
            option,
            word: word(value),
        }),
    }
}

/// A value as it is written.
pub fn word(value: &impl ValueEnum) -> String {
    value
        .to_possible_value()
        .map_or_else(String::new, |value| value.get_name().to_string())
}

/// The mistakes, each of which is told by itself.
pub fn each(error: &CommandError) -> &[CommandError] {
    match error {
        CommandError::Several(all) => all,
        one => slice::from_ref(one),
    }
}

/// Two mistakes, or more; names that are missing from one list are told together.
fn joined(one: CommandError, other: CommandError) -> CommandError {
    let mut all = separate(one);
    for error in separate(other) {
        if !all.iter_mut().any(|known| takes_names(known, &error)) {
            all.push(error);
        }
    }
    match all.len() {
        1 => all.remove(0),
        _ => CommandError::Several(all),
    }
}

fn separate(error: CommandError) -> Vec<CommandError> {
    match error {
        CommandError::Several(all) => all,
        one => vec![one],
    }
}

/// Whether a mistake takes over the names of another, which are missing from the same list.
fn takes_names(error: &mut CommandError, other: &CommandError) -> bool {
    match (error, other) {
        (
            CommandError::UnknownName { names, known, .. },
            CommandError::UnknownName {
                names: more,
                known: same,
                ..
            },
        ) if known == same => {
            names.extend(more.iter().cloned());
            true
        }
        _ => false,
    }
}
