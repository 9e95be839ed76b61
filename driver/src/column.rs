//! What rows hold besides time, coordinates and velocities.

use bricard_runtime::Structure;

/// A column that is added to time, coordinates and velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Kinetic and potential energy together (J).
    Energy,
    /// Kinetic energy (J).
    Kinetic,
    /// Potential energy (J).
    Potential,
    /// The largest error of a constraint equation, in its unit.
    ConstraintError,
    /// The largest error of a constraint equation's rate, in its unit per second.
    VelocityError,
    /// The number of independent constraint equations.
    Rank,
    /// The generalized reaction force at a coordinate.
    Reaction(usize),
    /// An output.
    Output(usize),
}

/// The columns that one word stands for.
pub const WORDS: [(&str, Column); 6] = [
    ("energy", Column::Energy),
    ("kinetic", Column::Kinetic),
    ("potential", Column::Potential),
    ("constraint_error", Column::ConstraintError),
    ("velocity_error", Column::VelocityError),
    ("rank", Column::Rank),
];

impl Column {
    /// Its name in the header.
    pub fn name(self, structure: &Structure) -> String {
        match self {
            Column::Reaction(i) => {
                format!(
                    "r({})",
                    structure.coordinates.get(i).map_or("?", |c| c.name)
                )
            }
            Column::Output(i) => structure
                .outputs
                .get(i)
                .map_or("?", |output| output.name)
                .to_string(),
            _ => {
                let word = WORDS.iter().find(|(_, column)| *column == self);
                word.map_or("", |(word, _)| word).to_string()
            }
        }
    }

    /// Its unit, empty if it has none or none is known.
    pub fn unit(self, structure: &Structure) -> &'static str {
        match self {
            Column::Energy | Column::Kinetic | Column::Potential => "J",
            Column::Output(i) => structure.outputs.get(i).map_or("", |output| output.unit),
            Column::Reaction(i) => match structure.coordinates.get(i).map_or("", |c| c.unit) {
                "m" => "N",
                "rad" => "N·m",
                _ => "",
            },
            Column::ConstraintError | Column::VelocityError | Column::Rank => "",
        }
    }
}
