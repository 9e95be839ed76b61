//! What the command line changes of a mechanism.
//!
//! In:  assignments by name.
//! Out: [`Changes`] by place, for a mechanism of any scalar.

use crate::error::CommandError;
use crate::formula::Assignment;
use crate::mechanism::{AnyMechanism, Held};
use bricard_runtime::{Quantity, Structure};

/// What is changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Parameters by place, and their values.
    pub parameters: Vec<(usize, f64)>,
    /// Inputs by place, and the values they are held at.
    pub inputs: Vec<(usize, f64)>,
    /// Values held at the start.
    pub held: Vec<Held>,
}

impl Changes {
    /// Finds the places of `--set` and `--start` in a mechanism, which is called
    /// `owner` in messages.
    ///
    /// # Errors
    ///
    /// [`CommandError::UnknownName`].
    pub fn find(
        structure: &Structure,
        owner: &str,
        set: &[Assignment],
        start: &[Assignment],
    ) -> Result<Self, CommandError> {
        let mut changes = Self::default();
        for assignment in set {
            changes.set(structure, owner, assignment)?;
        }
        for assignment in start {
            changes.held.push(held(structure, owner, assignment)?);
        }
        Ok(changes)
    }

    /// Changes a mechanism.
    pub fn apply(&self, mechanism: &mut dyn AnyMechanism) {
        for (index, value) in &self.parameters {
            mechanism.set_parameter(*index, *value);
        }
        for (index, value) in &self.inputs {
            mechanism.hold_input(*index, *value);
        }
        for held in &self.held {
            mechanism.hold(*held);
        }
    }

    fn set(
        &mut self,
        structure: &Structure,
        owner: &str,
        assignment: &Assignment,
    ) -> Result<(), CommandError> {
        let parameter = place(structure.parameters, &assignment.name);
        let input = place(structure.inputs, &assignment.name);
        match (parameter, input) {
            (Some(index), _) => self.parameters.push((index, assignment.value)),
            (None, Some(index)) => self.inputs.push((index, assignment.value)),
            (None, None) => {
                let all = structure.parameters.iter().chain(structure.inputs);
                let known = all.map(|quantity| quantity.name.to_string()).collect();
                return Err(unknown("parameter or input", owner, assignment, known));
            }
        }
        Ok(())
    }
}

fn held(structure: &Structure, owner: &str, assignment: &Assignment) -> Result<Held, CommandError> {
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
    Ok(Held {
        coordinate,
        velocity: inside.is_some(),
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
