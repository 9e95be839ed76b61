//! Every text that the front end may say is said about some wrong description, and stands
//! on the page of messages with one that brings it about.
//!
//! The texts are the sentences among the literals of its sources; what is said about the
//! descriptions of `tests/wrong` and about those of [`statements`] has to show each of them.

mod build;
mod heard;
mod page;
mod statements;
mod templates;

use bricard_testkit::page::hold_section;
use bricard_testkit::sentences::Sentence;
use heard::{Heard, Hearing};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::LazyLock;
use templates::templates;

/// A text that nothing brings about: the scanner has taken out what the lexer refuses.
const NEVER: &str = "this can't be read";

/// What is said about all wrong descriptions.
static SAID: LazyLock<Vec<Heard>> = LazyLock::new(|| Hearing::all().0);

/// The sentences that the front end may say.
fn sentences() -> Vec<Sentence> {
    let mut sentences = templates();
    sentences.retain(Sentence::is_whole);
    sentences
}

#[test]
fn every_text_of_the_front_end_is_said_about_some_description() {
    let templates = sentences();
    assert!(templates.len() > 400, "only {} texts", templates.len());
    let said: BTreeSet<&String> = SAID.iter().flat_map(Heard::texts).collect();
    let mut silent = Vec::new();
    for template in &templates {
        let heard = said.iter().any(|text| template.is_in(text));
        if heard == template.place.contains(NEVER) {
            silent.push(template.place.as_str());
        }
    }
    assert!(
        silent.is_empty(),
        "never said, or said after all:\n{}",
        silent.join("\n")
    );
}

#[test]
fn the_page_of_messages_shows_what_is_said_about_descriptions() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/messages.md");
    hold_section(&page, "Descriptions", &page::page(&templates(), &SAID));
}
