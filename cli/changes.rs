//! What the command line changes of a mechanism.
//!
//! In:  assignments by name.
//! Out: [`Changes`] by place, for a mechanism of any scalar.

use crate::error::CommandError;
use crate::formula::Assignment;
use bricard_driver::{AnyMechanism, Changes, Given};
use bricard_runtime::{Quantity, Structure};

/// Finds the places of `--set` and `--start` in a mechanism, which is called
/// `owner` in messages.
///
/// # Errors
///
/// [`CommandError::UnknownName`], [`CommandError::Twice`].
pub fn find(
    structure: &Structure,
    owner: &str,
    set: &[Assignment],
    start: &[Assignment],
) -> Result<Changes, CommandError> {
    once("--set", set)?;
    once("--start", start)?;
    let mut changes = Changes::default();
    for assignment in set {
        put(&mut changes, structure, owner, assignment)?;
    }
    for assignment in start {
        changes.given.push(given(structure, owner, assignment)?);
    }
    Ok(changes)
}

/// What is set to a negative mass or moment of inertia. The kinetic energy may be
/// positive all the same, by what else moves.
pub fn negative_inertia<'a>(changes: &Changes, structure: &'a Structure) -> Vec<&'a str> {
    let quantity = |(index, value): &(usize, f64)| {
        let quantity = structure.parameters.get(*index)?;
        let inertia = ["kg", "kg*m^2"].contains(&quantity.unit);
        (inertia && *value < 0.0).then_some(quantity.name)
    };
    changes.parameters.iter().filter_map(quantity).collect()
}

/// Changes a mechanism.
pub fn apply(changes: &Changes, mechanism: &mut dyn AnyMechanism) {
    for (index, value) in &changes.parameters {
        mechanism.set_parameter(*index, *value);
    }
    for (index, value) in &changes.inputs {
        mechanism.hold_input(*index, *value);
    }
    for given in &changes.given {
        mechanism.begin(*given);
    }
}

fn put(
    changes: &mut Changes,
    structure: &Structure,
    owner: &str,
    assignment: &Assignment,
) -> Result<(), CommandError> {
    let parameter = place(structure.parameters, &assignment.name);
    let input = place(structure.inputs, &assignment.name);
    match (parameter, input) {
        (Some(index), _) => changes.parameters.push((index, assignment.value)),
        (None, Some(index)) => changes.inputs.push((index, assignment.value)),
        (None, None) => {
            let all = structure.parameters.iter().chain(structure.inputs);
            let known = all.map(|quantity| quantity.name.to_string()).collect();
            return Err(unknown("parameter or input", owner, assignment, known));
        }
    }
    Ok(())
}

/// Refuses a name that is given two values, of which the last would win silently.
fn once(option: &'static str, assignments: &[Assignment]) -> Result<(), CommandError> {
    for (i, assignment) in assignments.iter().enumerate() {
        let name = &assignment.name;
        if assignments[..i].iter().any(|before| before.name == *name) {
            let name = name.clone();
            return Err(CommandError::Twice { option, name });
        }
    }
    Ok(())
}

fn given(
    structure: &Structure,
    owner: &str,
    assignment: &Assignment,
) -> Result<Given, CommandError> {
    let inside = assignment
        .name
        .strip_prefix("der(")
        .and_then(|name| name.strip_suffix(')'));
    let name = inside.unwrap_or(&assignment.name);
    let Some(coordinate) = place(structure.coordinates, name) else {
        let names = structure
            .coordinates
            .iter()
            .map(|coordinate| coordinate.name);
        let known = match inside {
            Some(_) => names.map(|name| format!("der({name})")).collect(),
            None => names.map(String::from).collect(),
        };
        return Err(unknown("coordinate", owner, assignment, known));
    };
    Ok(Given {
        coordinate,
        velocity: inside.is_some(),
        held: assignment.held,
        value: assignment.value,
    })
}

fn place(list: &[Quantity], name: &str) -> Option<usize> {
    list.iter().position(|x| x.name == name)
}

fn unknown(
    kind: &'static str,
    owner: &str,
    assignment: &Assignment,
    known: Vec<String>,
) -> CommandError {
    CommandError::UnknownName {
        kind,
        owner: owner.to_string(),
        name: assignment.name.clone(),
        known,
    }
}
