//! The columns of a recording.
//!
//! In:  the words of `--columns`.
//! Out: [`Column`]s with names and units.

use crate::error::CommandError;
use crate::mistakes::all;
pub use bricard_driver::Column;
use bricard_driver::{WORDS, heads};
use bricard_runtime::{Quantity, Structure};

/// A word for columns of one kind, and the columns.
type Kind = (&'static str, fn(&Structure) -> Vec<Column>);

/// The words that stand for all columns of a kind.
const KINDS: [Kind; 3] = [
    ("reactions", |structure| {
        every(structure.freedoms().len(), Column::Reaction)
    }),
    ("accelerations", |structure| {
        every(structure.coordinates.len(), Column::Acceleration)
    }),
    ("inputs", |structure| {
        every(structure.inputs.len(), Column::Input)
    }),
];

fn every(count: usize, column: fn(usize) -> Column) -> Vec<Column> {
    (0..count).map(column).collect()
}

/// The columns that words ask for, each once. An output or an input that is called like a
/// word is what the word means, and so is a coordinate or a state, which is in every row.
///
/// # Errors
///
/// [`CommandError::UnknownName`], [`CommandError::NoColumn`].
pub fn columns(
    words: &[String],
    structure: &Structure,
    mechanism: &str,
) -> Result<Vec<Column>, CommandError> {
    let words = words.iter().map(|word| word.trim());
    let found = words.filter(|word| !word.is_empty()).map(|word| {
        let found = named(word, structure);
        match found.is_empty() {
            true => Err(unknown(word, structure, mechanism)),
            false => Ok(found),
        }
    });
    let mut once = Vec::new();
    for column in all(found)?.concat() {
        if !once.contains(&column) {
            once.push(column);
        }
    }
    let names: Vec<String> = once.iter().map(|column| column.name(structure)).collect();
    let twice = (1..names.len()).find(|&i| names[..i].contains(&names[i]));
    twice.map_or(Ok(once), |i| Err(of_one_name(&names[i])))
}

/// The columns that one word stands for: an output or an input, else a word that is known,
/// else the column of that name, else the components of what is a vector.
fn named(word: &str, structure: &Structure) -> Vec<Column> {
    let mut own = every(structure.outputs.len(), Column::Output);
    own.extend(every(structure.inputs.len(), Column::Input));
    let spelt: String = word.split_whitespace().collect();
    let is_it = |column: &Column| column.name(structure) == spelt;
    if let Some(column) = own.into_iter().find(is_it) {
        return vec![column];
    }
    let known = WORDS.iter().map(|(_, column)| *column);
    if let Some(column) = known.into_iter().find(is_it) {
        let taken = heads(structure).contains(&spelt);
        return if taken { Vec::new() } else { vec![column] };
    }
    if let Some((_, columns)) = KINDS.iter().find(|(kind, _)| *kind == word) {
        return columns(structure);
    }
    let all = singles(structure);
    match all.iter().find(|column| is_it(column)) {
        Some(column) => vec![*column],
        None => components(&spelt, &all, structure),
    }
}

/// The columns that have names of their own in a mechanism.
fn singles(structure: &Structure) -> Vec<Column> {
    let mut all = every(structure.outputs.len(), Column::Output);
    all.extend(every(structure.inputs.len(), Column::Input));
    all.extend(every(structure.multipliers.len(), Column::Multiplier));
    all.extend(every(structure.coordinates.len(), Column::Acceleration));
    all.extend(every(structure.freedoms().len(), Column::Reaction));
    all
}

/// The components of an output that is a vector, a matrix or an array.
fn components(word: &str, all: &[Column], structure: &Structure) -> Vec<Column> {
    let of_word = |column: &&Column| {
        let name = column.name(structure);
        let rest = name.strip_prefix(word);
        rest.is_some_and(|rest| rest.starts_with(['.', '[']))
    };
    all.iter().filter(of_word).copied().collect()
}

/// What a word names that is no column, in words that say what to do instead.
fn no_column(word: &str, structure: &Structure) -> Option<String> {
    let has = |list: &[Quantity]| list.iter().any(|x| x.name == word);
    let is_head = heads(structure).iter().any(|head| head == word);
    if is_head && WORDS.iter().any(|(known, _)| *known == word) {
        return Some(
            "is a coordinate or a state of the description, and in every row; for the column that \
             is called so otherwise, choose another name there"
                .to_string(),
        );
    }
    if is_head {
        return Some("is in every row; `--columns` adds others".to_string());
    }
    if KINDS.iter().any(|(kind, _)| *kind == word) {
        return Some(format!("stands for all {word}, and there are none"));
    }
    if has(structure.parameters) {
        return Some("is a parameter, which stays as it is; leave it out".to_string());
    }
    let event = structure.events.iter().any(|event| event.name == word);
    event.then(|| "is an event: the summary says when it happens".to_string())
}

/// Two columns of one name: an output and an input.
fn of_one_name(name: &str) -> CommandError {
    CommandError::NoColumn {
        name: name.to_string(),
        reason: "is an output and an input of the description, and columns have names of their \
                 own; ask for one of them, or choose another name for the output"
            .to_string(),
    }
}

fn unknown(word: &str, structure: &Structure, mechanism: &str) -> CommandError {
    let spelt: String = word.split_whitespace().collect();
    if let Some(reason) = no_column(&spelt, structure) {
        return CommandError::NoColumn {
            name: spelt,
            reason,
        };
    }
    let words = WORDS.iter().map(|(word, _)| word.to_string());
    let kinds = KINDS.iter().filter(|(_, all)| !all(structure).is_empty());
    let kinds = kinds.map(|(word, _)| word.to_string());
    let known = words.chain(kinds);
    // Those of coordinates are clear from the words for all of them.
    let of_coordinate =
        |column: &Column| matches!(column, Column::Acceleration(_) | Column::Reaction(_));
    let named = singles(structure)
        .into_iter()
        .filter(|column| !of_coordinate(column))
        .map(|column| column.name(structure));
    CommandError::UnknownName {
        kind: "column or output",
        owner: mechanism.to_string(),
        names: vec![word.to_string()],
        known: known.chain(named).collect(),
    }
}

/// The header: what every row begins with, and added columns.
pub fn header(structure: &Structure, columns: &[Column]) -> Vec<String> {
    let mut header = heads(structure);
    header.extend(columns.iter().map(|column| column.name(structure)));
    header
}

#[cfg(test)]
mod tests {
    use super::{columns, header};
    use bricard_runtime::{Quantity, Structure};

    const fn quantity(name: &'static str) -> Quantity {
        Quantity {
            name,
            unit: "",
            docs: "",
        }
    }

    /// What is called like words that stand for columns, and like one another.
    const STRUCTURE: Structure = Structure {
        coordinates: &[quantity("energy"), quantity("q"), quantity("rank")],
        states: 1,
        inputs: &[quantity("potential"), quantity("push")],
        outputs: &[quantity("kinetic"), quantity("push")],
        ..Structure::PLAIN
    };

    /// The columns that words ask for besides those of every row, or what is said instead.
    fn asked(words: &[&str]) -> Result<Vec<String>, String> {
        let words: Vec<String> = words.iter().map(ToString::to_string).collect();
        let found = columns(&words, &STRUCTURE, "clash").map_err(|error| error.to_string())?;
        Ok(header(&STRUCTURE, &found).split_off(6))
    }

    #[test]
    fn what_is_called_like_a_word_is_meant_by_it() {
        let words = ["kinetic", "potential", "constraint_error"];
        assert_eq!(asked(&words), Ok(words.map(String::from).to_vec()));
        assert_eq!(asked(&["push"]), Ok(vec!["push".to_string()]));
        let inputs = ["potential", "push"].map(String::from).to_vec();
        assert_eq!(asked(&["inputs", "potential"]), Ok(inputs));
    }

    #[test]
    fn no_two_columns_have_one_name() {
        let row = header(&STRUCTURE, &[]);
        assert_eq!(row, ["t", "energy", "q", "der(energy)", "der(q)", "rank"]);
        for (words, said) in [
            (&["energy"][..], "`energy` is a coordinate or a state"),
            (&["rank"], "`rank` is a coordinate or a state"),
            (&["q"], "`q` is in every row"),
            (&["push", "inputs"], "`push` is an output and an input"),
        ] {
            let found = asked(words);
            assert!(
                found.as_ref().is_err_and(|text| text.contains(said)),
                "{found:?}"
            );
        }
    }
}
