//! What the command line changes of a mechanism.
//!
//! In:  assignments by name.
//! Out: [`Changes`] by place, for a mechanism of any scalar.

use crate::error::CommandError;
use crate::formula::{Assignment, Setting};
use crate::mechanism::description;
use crate::mistakes::{all, both};
use bricard_codegen::internals::syntax::parse;
use bricard_driver::{AnyMechanism, Changes, Given};
use bricard_runtime::{Quantity, Structure};

/// Finds the places of `--set` and `--start` in a mechanism, which is called
/// `owner` in messages.
///
/// # Errors
///
/// [`CommandError::UnknownName`], [`CommandError::Twice`], [`CommandError::InvalidSetting`].
pub fn find(
    structure: &Structure,
    owner: &str,
    set: &[Setting],
    start: &[Assignment],
) -> Result<Changes, CommandError> {
    let names: Vec<&str> = set.iter().map(Setting::name).collect();
    let started: Vec<&str> = start.iter().map(|given| given.name.as_str()).collect();
    let each_once = both(once("--set", &names), once("--start", &started));
    let mut changes = Changes::default();
    let set = all(set.iter().map(|setting| match setting {
        Setting::Number(assignment) => put(&mut changes, structure, owner, assignment),
        Setting::Law { name, why, .. } => no_law(structure, owner, name, why),
    }));
    let given = all(start.iter().map(|one| given(structure, owner, one)));
    let (_, (_, given)) = both(each_once, both(set, given))?;
    Ok(Changes { given, ..changes })
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
            return Err(not_there(structure, owner, &assignment.name));
        }
    }
    Ok(())
}

/// Refuses a formula for what is a number, or nothing.
fn no_law(structure: &Structure, owner: &str, name: &str, why: &str) -> Result<(), CommandError> {
    if place(structure.parameters, name).is_some() {
        let (name, reason) = (name.to_string(), format!("{why}; a parameter is a number"));
        return Err(CommandError::InvalidSetting { name, reason });
    }
    Err(not_there(structure, owner, name))
}

/// A name that is no parameter and no input.
fn not_there(structure: &Structure, owner: &str, name: &str) -> CommandError {
    let inside = velocity(name).unwrap_or(name);
    if place(structure.coordinates, inside).is_some() {
        let reason =
            format!("it is a part of the state; write `--start {name}=…` for where it begins");
        let name = name.to_string();
        return CommandError::InvalidSetting { name, reason };
    }
    // What the description says of it is worth a look, if it is still there.
    let parsed = description(owner).ok().and_then(|d| parse(&d.source).ok());
    if parsed.is_some_and(|model| model.is_constant(name)) {
        let reason = format!(
            "it is a constant, which is a number in the code; where the description says `const \
             {name}`, write `param {name}`"
        );
        let name = name.to_string();
        return CommandError::InvalidSetting { name, reason };
    }
    let all = structure.parameters.iter().chain(structure.inputs);
    let inside = |quantity: &&Quantity| {
        let rest = quantity.name.strip_prefix(name);
        rest.is_some_and(|rest| rest.starts_with(['[', '.']))
    };
    if let Some(Quantity { name: element, .. }) = all.clone().find(inside) {
        let reason = format!("what it consists of is set one by one: `{element}=…`");
        let name = name.to_string();
        return CommandError::InvalidSetting { name, reason };
    }
    let known = all.map(|quantity| quantity.name.to_string()).collect();
    unknown("parameter or input", owner, name, known)
}

/// Refuses a name that is given two values, of which the last would win silently.
fn once(option: &'static str, names: &[&str]) -> Result<(), CommandError> {
    for (i, name) in names.iter().enumerate() {
        if names[..i].contains(name) {
            let name = name.to_string();
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
    let inside = velocity(&assignment.name);
    let name = inside.unwrap_or(&assignment.name);
    let freedoms = structure.freedoms();
    let found = match inside {
        Some(_) => place(freedoms, name),
        None => place(structure.coordinates, name),
    };
    let Some(coordinate) = found else {
        let mut set = structure.parameters.iter().chain(structure.inputs);
        if set.any(|quantity| quantity.name == assignment.name) {
            let name = assignment.name.clone();
            return Err(CommandError::SetInstead { name });
        }
        let known = match inside {
            Some(_) => freedoms
                .iter()
                .map(|x| format!("der({})", x.name))
                .collect(),
            None => structure
                .coordinates
                .iter()
                .map(|x| x.name.to_string())
                .collect(),
        };
        return Err(unknown("coordinate", owner, &assignment.name, known));
    };
    Ok(Given {
        coordinate,
        // A state is the velocity of its integral.
        velocity: inside.is_some() || coordinate >= freedoms.len(),
        held: assignment.held,
        value: assignment.value,
    })
}

/// The coordinate of a velocity, `der(NAME)`.
fn velocity(name: &str) -> Option<&str> {
    name.strip_prefix("der(")?.strip_suffix(')')
}

fn place(list: &[Quantity], name: &str) -> Option<usize> {
    list.iter().position(|x| x.name == name)
}

fn unknown(kind: &'static str, owner: &str, name: &str, known: Vec<String>) -> CommandError {
    CommandError::UnknownName {
        kind,
        owner: owner.to_string(),
        names: vec![name.to_string()],
        known,
    }
}
