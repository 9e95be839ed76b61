//! Statements as other languages write them.
//!
//! In:  a word that begins no statement.
//! Out: what to write instead.

use super::keyword::STATEMENTS;
use super::messages::{FOR, did_you_mean};
use crate::diagnostic::nearest;

/// Words that begin statements elsewhere, and the one of the same meaning.
const WORDS: [(&[&str], &str); 12] = [
    (
        &["parameter", "parameters", "real", "Real", "float", "double"],
        "param",
    ),
    (&["constant"], "const"),
    (
        &["coordinate", "coordinates", "variable", "var", "dof"],
        "coord",
    ),
    (&["def", "function", "func"], "fn"),
    (&["initial", "init"], "start"),
    (&["equation", "eq", "joint"], "constraint"),
    (&["import", "include", "using"], "use"),
    (&["signal", "control"], "input"),
    (&["print", "plot", "record", "measure"], "output"),
    (&["friction", "damping"], "dissipation"),
    (&["body", "class", "model", "block"], "part"),
    (&["torque"], "force"),
];

/// What stands behind a word that begins no statement.
pub enum Follows<'a> {
    /// `=`.
    Value,
    /// A name and arguments.
    Call(&'a str),
    /// Something else.
    Other,
}

/// What may begin a statement, or what was probably meant by a word.
pub fn statement_help(word: &str, follows: &Follows) -> String {
    if let Follows::Value = follows {
        let quantity = format!("a quantity is written `let {word} = …;`");
        return match word {
            "T" | "V" | "U" => {
                format!("an energy is written `kinetic …;` or `potential …;`, {quantity}")
            }
            _ => format!("{quantity}, an equation `constraint {word} = …;`"),
        };
    }
    if word == "if" {
        return "a choice stands in a formula: `force if x < 0 then -k*x else 0 on x;`".to_string();
    }
    if ["while", "repeat", "loop"].contains(&word) {
        return FOR.to_string();
    }
    if let Some((_, ours)) = WORDS.iter().find(|(theirs, _)| theirs.contains(&word)) {
        let example = STATEMENTS.iter().find(|(known, ..)| known == ours);
        let example = example.map_or("", |(.., example)| example);
        return format!("the word is `{ours}`: `{example}`");
    }
    let words = STATEMENTS.iter().map(|(word, ..)| *word).chain(["for"]);
    match (nearest(word, words.clone()), follows) {
        (Some(near), _) => did_you_mean(near),
        (None, Follows::Call(name)) => format!("a part is used by `let {name} = {word}(…);`"),
        (None, _) => {
            let list: Vec<_> = words.collect();
            format!("a statement begins with one of: {}", list.join(", "))
        }
    }
}
