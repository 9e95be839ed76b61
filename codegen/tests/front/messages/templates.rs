//! What the sources of the front end may say.
//!
//! Out: the literals of its stages that are sentences or parts of such, with the places
//!      where they stand.

use bricard_testkit::sentences::{Sentence, sentences};
use std::path::Path;

/// The stages that find mistakes.
pub const STAGES: [&str; 4] = ["syntax", "model", "derive", "lint"];

/// Writes descriptions; says nothing.
const SILENT: &str = "syntax/print.rs";

/// The stage that says a sentence.
pub fn stage(sentence: &Sentence) -> &'static str {
    let is_of = |stage: &&&str| Path::new(&sentence.file).starts_with(stage);
    STAGES.iter().find(is_of).copied().unwrap_or(STAGES[0])
}

/// What the front end may say, parts of sentences too.
pub fn templates() -> Vec<Sentence> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let of_stage = |stage: &str| sentences(&sources, stage);
    let all = STAGES.into_iter().flat_map(of_stage);
    all.filter(|sentence| sentence.file != SILENT).collect()
}
