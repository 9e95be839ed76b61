//! What the command line changes of a mechanism.

use crate::arguments::Simulate;
use crate::error::CommandError;
use crate::mechanism::{AnyMechanism, Held};
use bricard_runtime::Quantity;

/// Sets parameters and inputs, holds values of the start.
///
/// # Errors
///
/// [`CommandError::UnknownName`].
pub fn apply(mechanism: &mut dyn AnyMechanism, arguments: &Simulate) -> Result<(), CommandError> {
    let structure = mechanism.structure();
    let place = |list: &[Quantity], name: &str| list.iter().position(|x| x.name == name);
    let unknown = |kind, name: &str, known: Vec<String>| CommandError::UnknownName {
        kind,
        owner: arguments.name.clone(),
        name: name.to_string(),
        known,
    };
    for change in &arguments.set {
        let parameter = place(structure.parameters, &change.name);
        let input = place(structure.inputs, &change.name);
        match (parameter, input) {
            (Some(index), _) => mechanism.set_parameter(index, change.value),
            (None, Some(index)) => mechanism.hold_input(index, change.value),
            (None, None) => {
                let all = structure.parameters.iter().chain(structure.inputs);
                let known = all.map(|quantity| quantity.name.to_string()).collect();
                return Err(unknown("parameter or input", &change.name, known));
            }
        }
    }
    for held in &arguments.start {
        let inside = held
            .name
            .strip_prefix("der(")
            .and_then(|name| name.strip_suffix(')'));
        let name = inside.unwrap_or(&held.name);
        let Some(coordinate) = place(structure.coordinates, name) else {
            let names = structure
                .coordinates
                .iter()
                .map(|coordinate| coordinate.name);
            let known = match inside {
                Some(_) => names.map(|name| format!("der({name})")).collect(),
                None => names.map(String::from).collect(),
            };
            return Err(unknown("coordinate", &held.name, known));
        };
        let (velocity, value) = (inside.is_some(), held.value);
        mechanism.hold(Held {
            coordinate,
            velocity,
            value,
        });
    }
    Ok(())
}
