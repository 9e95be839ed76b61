//! What the command says of a single value that it can't read, such as `0.5m` for a time.
//!
//! Out: the table of these messages on the page.

use super::{code, command, place, prose, read, row};
use bricard_testkit::sentences::{Sentence, sentences};
use std::path::Path;
use std::sync::LazyLock;

/// Where values are read.
const READERS: [&str; 2] = ["cli/formula.rs", "cli/arguments.rs"];

/// A text that nothing brings about: a formula that can't be read has a message.
const NEVER: &str = "this is no formula";

const INTRODUCTION: &str = "\
### Values that can't be read

Where a word of the command line can't be read, the command ends with status 2 before it does \
anything, and says which option the word was meant for. A formula with a mistake that a \
description could have, too, is told what stands under [Descriptions](#descriptions).
";

/// The words behind `bricard simulate slider_crank`.
const LINES: [&str; 37] = [
    "--until 2s",
    "--until 500ms",
    "--until 60deg",
    "--rtol 1e-9x",
    "--set L1=2x",
    "--until 1/0",
    "--until T",
    "--until [1,2]",
    "--until sine(1)",
    "--until sin(1,2)",
    "--until 2*",
    "--until ten",
    "--set L1",
    "--set L1=",
    "--set =3",
    "--set L1=0.4,,0.5",
    "--set L1=0.4,2/5",
    "--set L1=0.4,x",
    "--set L1=0.5m",
    "--set L1=2t",
    "--start q1",
    "--start ~3",
    "--start 'q1 = 45 deg'",
    "--stabilisation projektion",
    "--stabilisation baumgarte",
    "--stabilisation baumgarte:10:-10",
    "--plot run.svg --width 12",
    "--plot run.svg --width singel",
    "--plot run.svg --width 1m",
    "--plot run.svg --width 5mm",
    "--plot run.svg --width -5mm",
    "--columns energy,,rank",
    "--columns=",
    "--plot run.svg --phase q1",
    "--plot run.svg --phase q1,",
    "--method dop835",
    "--step 0.01 --rtol 1e-6",
];

/// What is said, without what is said of every command line.
struct Said {
    line: &'static str,
    status: Option<i32>,
    text: String,
}

static SAID: LazyLock<Vec<Said>> = LazyLock::new(|| {
    let folder = place("values");
    let said = |line: &'static str| {
        let mut command = command(&folder);
        command.args(["simulate", "slider_crank"]).args(words(line));
        let ran = read(command.output().expect("the command starts"));
        let text = ran.err.split("\n\nUsage").next().unwrap_or_default();
        let text = text.split("\n\nFor more").next().unwrap_or_default();
        Said {
            line,
            status: ran.status,
            text: text.strip_prefix("error: ").unwrap_or(text).to_string(),
        }
    };
    LINES.map(said).into_iter().collect()
});

/// The words of a line: what stands between quotes is one.
fn words(line: &str) -> Vec<&str> {
    let parts = line.split('\'').enumerate();
    parts
        .flat_map(|(place, part)| match place % 2 {
            1 => vec![part],
            _ => part.split_whitespace().collect(),
        })
        .collect()
}

/// The table, in the order of the lines.
pub fn table() -> String {
    let rows: Vec<String> = SAID
        .iter()
        .map(|said| row(&[prose(&said.text), code(said.line)]))
        .collect();
    let head = "\n| message | words behind `bricard simulate slider_crank` |\n|---|---|\n";
    format!("{INTRODUCTION}{head}{}", rows.concat())
}

#[test]
fn a_value_that_cannot_be_read_is_told_with_what_to_write() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for said in SAID.iter() {
        assert_eq!(said.status, Some(2), "{}: {}", said.line, said.text);
        assert!(!said.text.is_empty(), "{}: nothing is said", said.line);
    }
    let is_said = |sentence: &Sentence| SAID.iter().any(|said| sentence.is_in(&said.text));
    let readers = READERS.into_iter().flat_map(|file| sentences(root, file));
    let wrong: Vec<String> = readers
        .filter(Sentence::is_whole)
        .filter(|sentence| is_said(sentence) == sentence.place.contains(NEVER))
        .map(|sentence| sentence.place)
        .collect();
    assert!(
        wrong.is_empty(),
        "never said, or said after all:\n{}",
        wrong.join("\n")
    );
}
