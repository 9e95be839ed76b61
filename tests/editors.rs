//! The grammar for editors knows exactly the words of the language.

use crate::source::read;
use bricard_codegen::internals::keywords;
use serde_json::Value;
use std::collections::BTreeSet;

/// Every pattern of the grammar, whatever it is nested in.
fn patterns(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            for (key, inside) in map {
                match inside.as_str() {
                    Some(text) if key == "match" => found.push(text.to_string()),
                    _ => patterns(inside, found),
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|inside| patterns(inside, found)),
        _ => {}
    }
}

/// The words that stand between parentheses and bars.
fn words_of(pattern: &str) -> BTreeSet<String> {
    let groups = pattern.split('(').skip(1);
    let groups = groups.filter_map(|rest| rest.split(')').next());
    let words = groups.flat_map(|group| group.split('|'));
    let is_word = |word: &&str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric());
    words.filter(is_word).map(str::to_string).collect()
}

#[test]
fn the_grammar_for_editors_has_the_words_of_the_language_and_no_others() {
    let grammar: Value =
        serde_json::from_str(&read("editors/mech.tmLanguage.json")).expect("the grammar is JSON");
    let mut found = Vec::new();
    patterns(&grammar, &mut found);
    let coloured: BTreeSet<String> = found.iter().flat_map(|text| words_of(text)).collect();
    let all = keywords::statements()
        .chain(keywords::connectives())
        .chain(keywords::shapes())
        .chain(keywords::directions())
        .chain(keywords::functions())
        .chain(keywords::constants())
        .chain(keywords::units());
    let language: BTreeSet<String> = all.map(str::to_string).collect();
    assert!(language.len() > 70, "{} words", language.len());
    assert_eq!(coloured, language);
}

#[test]
fn every_word_of_the_grammar_is_coloured_as_what_it_is() {
    let grammar: Value =
        serde_json::from_str(&read("editors/mech.tmLanguage.json")).expect("the grammar is JSON");
    let part = |name: &str| {
        let text = grammar["repository"][name]["match"].as_str();
        words_of(text.unwrap_or_else(|| panic!("no pattern `{name}`")))
    };
    let set = |words: &mut dyn Iterator<Item = &'static str>| -> BTreeSet<String> {
        words.map(str::to_string).collect()
    };
    assert_eq!(part("functions"), set(&mut keywords::functions()));
    assert_eq!(part("shapes"), set(&mut keywords::shapes()));
    assert_eq!(part("directions"), set(&mut keywords::directions()));
    assert_eq!(part("constants"), set(&mut keywords::constants()));
    let statements = &part("declaration") | &part("statements");
    assert_eq!(statements, set(&mut keywords::statements()));
    let connectives = &part("mechanism") | &part("connectives");
    assert_eq!(connectives, set(&mut keywords::connectives()));
}
