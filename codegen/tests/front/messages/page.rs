//! The page of all messages: what is said about descriptions.
//!
//! Out: a table for each stage, in which each message stands with what to write instead
//!      and the shortest input that brings it about.

use super::heard::Heard;
use super::templates::{STAGES, stage};
use bricard_testkit::page::{prose, row};
use bricard_testkit::sentences::Sentence;
use std::collections::{BTreeMap, BTreeSet};

/// The longest input that a reader is shown, in characters.
const LONGEST: usize = 120;

/// What the reader is told about each stage.
const ABOUT: [(&str, &str); 4] = [
    ("syntax", "How a description is written"),
    ("model", "What it means"),
    ("derive", "What follows from it"),
    ("lint", "What is probably not meant"),
];

const INTRODUCTION: &str = "\
What stands as an input belongs, if it is no `mechanism` and not told to stand alone, into \
this description, in place of `…`:

```text
mechanism Test { coord q; coord w; kinetic der(q)^2 + der(w)^2; … }
```

Behind a message stands in brackets what is said of places in the description. \
`⏎` is the end of a line.
";

/// The template that says most of a text.
fn source<'a>(templates: &'a [Sentence], text: &str) -> Option<&'a Sentence> {
    let found = templates.iter().filter(|template| template.is_in(text));
    // Of equal ones the first.
    found.rev().max_by_key(|template| template.length())
}

/// Which of two is shown: the one about whose input nothing else is said, then the one with
/// the shorter input.
fn rank(heard: &Heard) -> (bool, usize, usize, &str, &str) {
    let length = heard.input.chars().count();
    (
        length > LONGEST,
        heard.n_findings,
        length,
        &heard.input,
        &heard.message,
    )
}

/// One of all that is said for each message with each help, and for each text that stands
/// in none of these.
fn examples<'a>(templates: &[Sentence], said: &'a [Heard]) -> Vec<(&'static str, &'a Heard)> {
    let mut best: BTreeMap<_, (&'static str, &Heard)> = BTreeMap::new();
    for heard in said {
        let message = source(templates, &heard.message);
        let stage = message.map_or(STAGES[0], stage);
        let help = heard
            .help
            .as_deref()
            .and_then(|text| source(templates, text));
        let place = |template: Option<&Sentence>| template.map(|found| found.place.clone());
        let key = (place(message), place(help));
        let entry = best.entry(key).or_insert((stage, heard));
        if rank(heard) < rank(entry.1) {
            *entry = (stage, heard);
        }
    }
    let mut examples: Vec<_> = best.into_values().collect();
    for template in templates.iter().filter(|template| template.is_whole()) {
        let has = |heard: &Heard| heard.texts().any(|text| template.is_in(text));
        if examples.iter().any(|(_, heard)| has(heard)) {
            continue;
        }
        let shortest = said
            .iter()
            .filter(|heard| has(heard))
            .min_by_key(|heard| rank(heard));
        examples.extend(shortest.map(|heard| (stage(template), heard)));
    }
    examples
}

/// What is printed of something but its help.
fn printed(heard: &Heard) -> String {
    let mark = if heard.is_warning { "warning: " } else { "" };
    let labels: BTreeSet<&String> = heard.labels.iter().collect();
    let labels: Vec<String> = labels.into_iter().map(|text| prose(text)).collect();
    match labels.is_empty() {
        true => format!("{mark}{}", prose(&heard.message)),
        false => format!("{mark}{} ({})", prose(&heard.message), labels.join("; ")),
    }
}

/// The section of the page.
pub fn page(templates: &[Sentence], said: &[Heard]) -> String {
    let examples = examples(templates, said);
    let long = examples
        .iter()
        .filter(|(_, heard)| heard.input.chars().count() > LONGEST);
    let long: Vec<String> = long
        .map(|(_, heard)| format!("{}\n  help: {:?}", heard.message, heard.help))
        .collect();
    assert!(
        long.is_empty(),
        "these want shorter descriptions that bring them about:\n{}",
        long.join("\n")
    );
    let mut text = INTRODUCTION.to_string();
    for (stage, about) in ABOUT {
        text += &format!("\n### {about}\n\n| message | what to write | input |\n|---|---|---|\n");
        let of_stage = examples.iter().filter(|(of, _)| *of == stage);
        let rows: BTreeSet<String> = of_stage
            .map(|(_, heard)| {
                let help = heard.help.as_deref().map(prose).unwrap_or_default();
                row(&[printed(heard), help, heard.input.clone()])
            })
            .collect();
        text.extend(rows);
    }
    text
}
