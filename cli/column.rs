//! The columns of a recording.
//!
//! In:  the words of `--columns`.
//! Out: [`Column`]s with names and units.

use crate::error::CommandError;
pub use bricard_driver::Column;
use bricard_driver::WORDS;
use bricard_runtime::Structure;

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
