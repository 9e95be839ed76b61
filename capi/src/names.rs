//! What a mechanism has, by name.
//!
//! In:  a [`Structure`].
//! Out: texts that C can read, made once when a handle is made.

use bricard_runtime::{ConstraintRow, Event, Quantity, Structure};
use core::fmt::{self, Display, Formatter};
use std::ffi::{CStr, CString};

/// What can be asked for by name or by place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum List {
    /// The mechanism itself, the only one of its kind.
    Mechanism,
    /// Coordinates.
    Coordinates,
    /// Parameters.
    Parameters,
    /// Inputs.
    Inputs,
    /// Outputs.
    Outputs,
    /// Events.
    Events,
    /// Constraint equations.
    Constraints,
    /// States of the first order.
    States,
}

impl List {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::Mechanism,
        Self::Coordinates,
        Self::Parameters,
        Self::Inputs,
        Self::Outputs,
        Self::Events,
        Self::Constraints,
        Self::States,
    ];

    /// The list of a number.
    pub fn of(number: i32) -> Option<Self> {
        usize::try_from(number)
            .ok()
            .and_then(|number| Self::ALL.get(number).copied())
    }

    /// What one entry is called.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mechanism => "mechanism",
            Self::Coordinates => "coordinate",
            Self::Parameters => "parameter",
            Self::Inputs => "input",
            Self::Outputs => "output",
            Self::Events => "event",
            Self::Constraints => "constraint equation",
            Self::States => "state",
        }
    }
}

/// One entry of a list.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) name: CString,
    pub(crate) unit: CString,
    pub(crate) docs: CString,
}

/// All lists of a mechanism.
#[derive(Clone, Debug)]
pub(crate) struct Names([Box<[Entry]>; 8]);

impl Names {
    pub(crate) fn of(structure: &Structure) -> Self {
        let quantities = |list: &[Quantity]| list.iter().map(quantity).collect();
        let freedoms = structure.freedoms();
        Self([
            Box::new([entry(structure.name, structure.file, structure.docs)]),
            quantities(freedoms),
            quantities(structure.parameters),
            quantities(structure.inputs),
            quantities(structure.outputs),
            structure.events.iter().map(event).collect(),
            structure.constraints.iter().map(constraint).collect(),
            quantities(&structure.coordinates[freedoms.len()..]),
        ])
    }

    /// The entries of a list.
    pub(crate) fn list(&self, list: List) -> &[Entry] {
        &self.0[list as usize]
    }

    /// The place of a name in a list.
    pub(crate) fn find(&self, list: List, name: &CStr) -> Option<usize> {
        let mut entries = self.list(list).iter();
        entries.position(|entry| entry.name.as_c_str() == name)
    }
}

/// The names that there are, for a message.
pub(crate) struct Known<'a>(pub(crate) &'a [Entry]);

impl Display for Known<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (i, entry) in self.0.iter().enumerate() {
            let before = if i == 0 { "; there are " } else { ", " };
            write!(f, "{before}`{}`", entry.name.to_string_lossy())?;
        }
        Ok(())
    }
}

fn entry(name: &str, unit: &str, docs: &str) -> Entry {
    Entry {
        name: text(name),
        unit: text(unit),
        docs: text(docs),
    }
}

fn quantity(quantity: &Quantity) -> Entry {
    entry(quantity.name, quantity.unit, quantity.docs)
}

fn event(event: &Event) -> Entry {
    entry(event.name, "", "")
}

fn constraint(row: &ConstraintRow) -> Entry {
    let level = match row.holonomic {
        true => "positions",
        false => "velocities",
    };
    entry(row.text, "", &format!("line {}, of {level}", row.line))
}

/// A text without zeros, which C would take for its end.
fn text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}
