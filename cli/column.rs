//! The columns of a recording.
//!
//! In:  the words of `--columns`.
//! Out: [`Column`]s with names and units.

use crate::error::CommandError;
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

/// What each word but `reactions` and the outputs' names stands for.
const WORDS: [(&str, Column); 6] = [
    ("energy", Column::Energy),
    ("kinetic", Column::Kinetic),
    ("potential", Column::Potential),
    ("constraint_error", Column::ConstraintError),
    ("velocity_error", Column::VelocityError),
    ("rank", Column::Rank),
];
/// The word for the reactions at all coordinates.
const REACTIONS: &str = "reactions";

/// The columns that words ask for. An output that is called like a word is
/// what the word means.
///
/// # Errors
///
/// [`CommandError::UnknownName`].
pub fn columns(
    words: &[String],
    structure: &Structure,
    mechanism: &str,
) -> Result<Vec<Column>, CommandError> {
    let mut columns = Vec::new();
    for word in words
        .iter()
        .map(|word| word.trim())
        .filter(|word| !word.is_empty())
    {
        let output = structure
            .outputs
            .iter()
            .position(|output| output.name == word);
        let known = WORDS.iter().find(|(known, _)| *known == word);
        match (output, known) {
            (Some(output), _) => columns.push(Column::Output(output)),
            (None, Some((_, column))) => columns.push(*column),
            (None, None) if word == REACTIONS => {
                columns.extend((0..structure.coordinates.len()).map(Column::Reaction));
            }
            (None, None) => match components(word, structure) {
                found if found.is_empty() => return Err(unknown(word, structure, mechanism)),
                found => columns.extend(found),
            },
        }
    }
    Ok(columns)
}

/// The components of an output that is a vector, a matrix or an array.
fn components(word: &str, structure: &Structure) -> Vec<Column> {
    let outputs = structure.outputs.iter().enumerate();
    let of_word = |name: &str| {
        let rest = name.strip_prefix(word);
        rest.is_some_and(|rest| rest.starts_with(['.', '[']))
    };
    let found = outputs.filter(|(_, output)| of_word(output.name));
    found.map(|(i, _)| Column::Output(i)).collect()
}

fn unknown(word: &str, structure: &Structure, mechanism: &str) -> CommandError {
    let words = WORDS.iter().map(|(word, _)| *word).chain([REACTIONS]);
    let outputs = structure.outputs.iter().map(|output| output.name);
    CommandError::UnknownName {
        kind: "column or output",
        owner: mechanism.to_string(),
        name: word.to_string(),
        known: words.chain(outputs).map(String::from).collect(),
    }
}

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

/// The header: time, coordinates, velocities, added columns.
pub fn header(structure: &Structure, columns: &[Column]) -> Vec<String> {
    let names = structure
        .coordinates
        .iter()
        .map(|coordinate| coordinate.name);
    let mut header = vec!["t".to_string()];
    header.extend(names.clone().map(String::from));
    header.extend(names.map(|name| format!("der({name})")));
    header.extend(columns.iter().map(|column| column.name(structure)));
    header
}
