//! What rows hold besides time, coordinates and velocities.

use bricard_runtime::{Quantity, Structure};

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
    /// The acceleration of a coordinate.
    Acceleration(usize),
    /// A multiplier, by its place in [`Structure::multipliers`].
    Multiplier(usize),
    /// An input, held or by its law.
    Input(usize),
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

/// The names of time, coordinates, velocities and states of the first order, which every
/// row begins with.
pub fn heads(structure: &Structure) -> Vec<String> {
    let freedoms = structure.freedoms();
    let states = &structure.coordinates[freedoms.len()..];
    let mut heads = vec!["t".to_string()];
    heads.extend(freedoms.iter().map(|x| x.name.to_string()));
    heads.extend(freedoms.iter().map(|x| format!("der({})", x.name)));
    heads.extend(states.iter().map(|x| x.name.to_string()));
    heads
}

impl Column {
    /// Its name in the header.
    pub fn name(self, structure: &Structure) -> String {
        let of = |list: &[Quantity], i: usize| list.get(i).map_or("?", |x| x.name);
        match self {
            Column::Reaction(i) => format!("r({})", of(structure.coordinates, i)),
            Column::Acceleration(i) => {
                let name = of(structure.coordinates, i);
                match i < structure.freedoms().len() {
                    true => format!("der(der({name}))"),
                    false => format!("der({name})"),
                }
            }
            Column::Output(i) => of(structure.outputs, i).to_string(),
            Column::Input(i) => of(structure.inputs, i).to_string(),
            Column::Multiplier(i) => {
                let found = structure.multipliers.get(i);
                found.map_or("?", |x| x.quantity.name).to_string()
            }
            _ => {
                let word = WORDS.iter().find(|(_, column)| *column == self);
                word.map_or("", |(word, _)| word).to_string()
            }
        }
    }

    /// Its unit, empty if it has none or none is known.
    pub fn unit(self, structure: &Structure) -> &'static str {
        let of = |list: &'static [Quantity], i: usize| list.get(i).map_or("", |x| x.unit);
        match self {
            Column::Energy | Column::Kinetic | Column::Potential => "J",
            Column::Output(i) => of(structure.outputs, i),
            Column::Input(i) => of(structure.inputs, i),
            Column::Multiplier(i) => {
                let found = structure.multipliers.get(i);
                found.map_or("", |x| x.quantity.unit)
            }
            Column::Reaction(i) => match of(structure.coordinates, i) {
                "m" => "N",
                "rad" => "N·m",
                _ => "",
            },
            Column::Acceleration(i) => match of(structure.freedoms(), i) {
                "m" => "m/s²",
                "rad" => "rad/s²",
                _ => "",
            },
            Column::ConstraintError | Column::VelocityError | Column::Rank => "",
        }
    }
}
