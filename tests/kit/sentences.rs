//! What sources may say: their literals that are sentences, or parts of such.
//!
//! In:  files of Rust.
//! Out: sentences with the places where they stand, to hold against what is really said.

use proc_macro2::{TokenStream, TokenTree};
use std::fs;
use std::path::{Path, PathBuf};

/// Fewer words than this are a part of a sentence that stands elsewhere.
const WORDS: usize = 3;

/// A literal of the sources.
pub struct Sentence {
    /// The file, as it was named.
    pub file: String,
    /// Where it stands, and what it is.
    pub place: String,
    /// What stands between its placeholders.
    fragments: Vec<String>,
}

impl Sentence {
    fn new(file: &str, line: usize, text: &str) -> Self {
        let mut fragments = Vec::new();
        let mut rest = text.replace("{{", "\u{1}").replace("}}", "\u{2}");
        while let Some((before, after)) = rest.split_once('{') {
            let after = after.split_once('}').map_or("", |(_, after)| after);
            fragments.push(before.to_string());
            rest = after.to_string();
        }
        fragments.push(rest);
        let plain = |text: &String| text.replace('\u{1}', "{").replace('\u{2}', "}");
        let fragments = fragments.iter().map(plain).collect();
        Self {
            file: file.to_string(),
            place: format!("{file}:{line}: {text}"),
            fragments,
        }
    }

    fn words(&self) -> usize {
        let words = self
            .fragments
            .iter()
            .flat_map(|text| text.split_whitespace());
        let is_word = |word: &&str| word.chars().any(char::is_alphabetic);
        words.filter(is_word).count()
    }

    /// Whether it says something by itself.
    pub fn is_whole(&self) -> bool {
        self.words() >= WORDS
    }

    /// How much of a text that contains it comes from it.
    pub fn length(&self) -> usize {
        self.fragments.iter().map(String::len).sum()
    }

    /// Whether a text contains it, whatever its placeholders stand for.
    pub fn is_in(&self, text: &str) -> bool {
        let mut rest = text;
        self.fragments.iter().all(|fragment| {
            let found = rest.find(fragment.as_str());
            rest = found.map_or("", |at| &rest[at + fragment.len()..]);
            found.is_some()
        })
    }
}

/// All files below a folder with an ending, in order.
///
/// # Panics
///
/// If there is no such folder.
pub fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{folder:?}: {error}"));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let below = |path: PathBuf| match path.is_dir() {
        true => files(&path, ending),
        false => vec![path],
    };
    let all = paths.into_iter().flat_map(below);
    all.filter(|path| path.extension().is_some_and(|e| e == ending))
        .collect()
}

/// What a file, or all files of Rust below a folder, may say, parts of sentences too; `root`
/// is left out of their names. Tests at the end of a file say nothing.
///
/// # Panics
///
/// If the files can't be read, or are no Rust.
pub fn sentences(root: &Path, name: &str) -> Vec<Sentence> {
    let place = root.join(name);
    let paths = match place.is_dir() {
        true => files(&place, "rs"),
        false => vec![place],
    };
    let mut sentences = Vec::new();
    for path in paths {
        let file = path
            .strip_prefix(root)
            .unwrap_or(&path)
            .display()
            .to_string();
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let tokens: TokenStream = code
            .parse()
            .unwrap_or_else(|error| panic!("{path:?}: {error}"));
        literals(tokens, &mut |line, text| {
            sentences.push(Sentence::new(&file, line, &text))
        });
    }
    sentences.retain(|sentence| sentence.words() > 0);
    sentences
}

/// Shows the literals of tokens, but those of attributes.
fn literals(tokens: TokenStream, show: &mut dyn FnMut(usize, String)) {
    let mut is_attribute = false;
    for token in tokens {
        let follows = std::mem::take(&mut is_attribute);
        match token {
            TokenTree::Punct(sign) => {
                is_attribute = sign.as_char() == '#' || follows && sign.as_char() == '!';
            }
            TokenTree::Group(group) if !follows => literals(group.stream(), show),
            TokenTree::Literal(literal) => {
                if let Some(text) = value(&literal.to_string()) {
                    show(literal.span().start().line, text);
                }
            }
            TokenTree::Group(_) | TokenTree::Ident(_) => {}
        }
    }
}

/// The text of a literal, for Rust or for C.
fn value(literal: &str) -> Option<String> {
    let text = literal.strip_prefix('c').unwrap_or(literal);
    syn::parse_str::<syn::LitStr>(text)
        .ok()
        .map(|text| text.value())
}

#[cfg(test)]
mod tests {
    use super::{Sentence, literals};

    #[test]
    fn literals_are_found_where_they_are_said() {
        let code = r##"/// not this
            #[doc = "nor this"]
            fn f() { say("one {x} two"); g(c"three \
                          four"); }"##;
        let mut found = Vec::new();
        literals(code.parse().expect("tokens"), &mut |_, text| {
            found.push(text)
        });
        assert_eq!(found, ["one {x} two", "three four"]);
    }

    #[test]
    fn a_sentence_is_in_what_is_said_whatever_its_placeholders_stand_for() {
        let sentence = Sentence::new("f.rs", 1, "there is no {word} `{{{name}`");
        assert!(sentence.is_in("at 3: there is no input `{torque`, but others"));
        assert!(!sentence.is_in("there is no `input` {torque"));
        assert!(sentence.is_whole() && !Sentence::new("f.rs", 1, "no {x}").is_whole());
    }
}
