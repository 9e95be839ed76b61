//! The commands on the pages of the documentation do what the pages show.

use crate::command::{Ran, folder, read};
use crate::source;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Pages whose commands are run, each followed by what it prints, in parts.
const RUN: [&str; 4] = ["choosing", "modelling", "theory", "tutorial"];

/// Commands that take long; of these only the flags are held against their help.
const LONG: [&str; 4] = ["reproduce", "validate", "workprecision", "passage"];

/// Commands on the pages, at least.
const COMMANDS: usize = 25;

/// A block of a page between two fences.
struct Block {
    language: String,
    text: String,
    /// Whether a heading follows before the next block.
    ends_section: bool,
}

fn blocks(page: &str) -> Vec<Block> {
    let text = source::read(&format!("docs/{page}.md"));
    let mut parts = text.split("\n```").skip(1);
    let mut blocks = Vec::new();
    while let Some(block) = parts.next() {
        let (language, text) = block.split_once('\n').unwrap_or((block, ""));
        // The text up to the next block.
        let below = parts.next().unwrap_or_default();
        blocks.push(Block {
            language: language.to_string(),
            text: text.to_string(),
            ends_section: below.contains("\n#"),
        });
    }
    blocks
}

/// What a page shows below the commands at a place.
fn shown(blocks: &[Block], place: usize) -> &str {
    let below = blocks
        .get(place + 1)
        .filter(|_| !blocks[place].ends_section);
    let text = below.filter(|below| below.language == "text");
    text.map_or("", |below| &below.text)
}

/// Writes the descriptions of a page into a folder, each under its name.
fn write_descriptions(folder: &Path, blocks: &[Block]) {
    for block in blocks.iter().filter(|block| block.language == "mech") {
        let rest = block.text.split("mechanism ").nth(1).unwrap_or_default();
        let name = rest.split(' ').next().unwrap_or_default();
        let file = folder.join(name.to_lowercase() + ".mech");
        fs::write(file, &block.text).expect("the folder is ours");
    }
}

/// Runs a line as a shell would, with the command of this build.
fn run(folder: &Path, line: &str) -> Ran {
    let command = PathBuf::from(env!("CARGO_BIN_EXE_bricard"));
    let line = match line.strip_prefix("bricard ") {
        Some(rest) => format!("'{}' {rest}", command.display()),
        None => panic!("{line}: pages show this command only"),
    };
    let output = Command::new("sh")
        .args(["-c", &line])
        .current_dir(folder)
        .output();
    read(output.expect("a shell"))
}

/// A line with every number replaced by one sign, and every gap by one space: numbers of
/// steps and times differ from machine to machine.
fn without_numbers(line: &str) -> String {
    let signs: Vec<char> = line.chars().collect();
    let mut text = String::new();
    let mut place = 0;
    while place < signs.len() {
        let sign = signs[place];
        let in_word = text.ends_with(|last: char| last.is_alphanumeric() || last == '_');
        if sign.is_ascii_digit() && !in_word {
            while place < signs.len() && (is_of_number(signs[place]) || is_exponent(&signs, place))
            {
                place += 1;
            }
            while text.ends_with('-') {
                text.pop();
            }
            text.push('#');
            continue;
        }
        if !(sign.is_whitespace() && text.ends_with(' ')) {
            text.push(if sign.is_whitespace() { ' ' } else { sign });
        }
        place += 1;
    }
    text.trim().to_string()
}

fn is_of_number(sign: char) -> bool {
    sign.is_ascii_digit() || sign == '.'
}

/// Whether the sign is an `e` within a number, or the sign of the exponent behind it.
fn is_exponent(signs: &[char], place: usize) -> bool {
    let next = |ahead: usize| signs.get(place + ahead).copied().unwrap_or(' ');
    match signs[place] {
        'e' => next(1).is_ascii_digit() || next(1) == '-' && next(2).is_ascii_digit(),
        '-' => signs[place - 1] == 'e' && next(1).is_ascii_digit(),
        _ => false,
    }
}

/// Stands on a page for lines that are left out.
const LEFT_OUT: &str = "…";

/// Holds the lines that a page shows against what was printed, all of it but what is left out.
fn shows(page: &str, shown: &str, printed: &str) {
    let lines = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| !line.trim().is_empty());
        lines.map(without_numbers).collect()
    };
    let mut printed_lines = lines(printed);
    // Whether a description is compiled anew depends on what ran before, and how long that takes
    // on the machine.
    let is_compiled = |line: &String| line.starts_with("compiling ") || line.starts_with("still ");
    printed_lines.retain(|line| !is_compiled(line));
    let (mut place, mut leaves_out) = (0, false);
    for line in lines(shown) {
        if line == LEFT_OUT {
            leaves_out = true;
            continue;
        }
        let mut rest = printed_lines[place..].iter();
        let found = match leaves_out {
            true => rest.position(|printed| *printed == line),
            false => rest.next().filter(|printed| **printed == line).map(|_| 0),
        };
        let Some(ahead) = found else {
            panic!("{page}.md shows\n{line}\nwhich is not so, or not there, in\n{printed}");
        };
        assert!(
            !leaves_out || ahead > 0,
            "{page}.md leaves out nothing above\n{line}"
        );
        (place, leaves_out) = (place + ahead + 1, false);
    }
    assert!(
        leaves_out || place == printed_lines.len() || shown.is_empty(),
        "{page}.md shows less than\n{printed}"
    );
}

/// Holds the flags of a command that takes long against its help.
fn has_flags(folder: &Path, line: &str) {
    let name = line.split(' ').nth(1).unwrap_or_default();
    let help = run(folder, &format!("bricard {name} --help"));
    assert_eq!(help.status, Some(0), "{line}: {}", help.err);
    for flag in line.split(' ').filter(|word| word.starts_with("--")) {
        assert!(
            help.out.contains(flag),
            "{line}: no {flag} in\n{}",
            help.out
        );
    }
}

/// Runs the commands of a block, each of which has to end with a status, and gives what
/// they print.
fn print(folder: &Path, commands: &str, status: i32) -> String {
    let mut printed = String::new();
    for line in commands.lines() {
        let name = line.split(' ').nth(1).unwrap_or_default();
        if LONG.contains(&name) {
            has_flags(folder, line);
            continue;
        }
        let ran = run(folder, line);
        assert_eq!(ran.status, Some(status), "{line}\n{}", ran.err);
        printed += &ran.out;
        printed += &ran.err;
    }
    printed
}

#[test]
fn commands_on_the_pages_print_what_the_pages_show() {
    let mut seen = 0;
    for page in RUN {
        let folder = folder(&format!("pages_{page}"));
        let blocks = blocks(page);
        write_descriptions(&folder, &blocks);
        for (place, block) in blocks.iter().enumerate() {
            if block.language != "sh" {
                continue;
            }
            let shown = shown(&blocks, place);
            let fails = shown.lines().any(|line| line.starts_with("error: "));
            let printed = print(&folder, &block.text, i32::from(fails));
            shows(page, shown, &printed);
            seen += block.text.lines().count();
        }
    }
    assert!(seen >= COMMANDS, "only {seen} commands");
}

#[test]
fn lines_that_differ_in_more_than_numbers_are_told_apart() {
    let same = |a: &str, b: &str| without_numbers(a) == without_numbers(b);
    assert!(same("steps    12", "steps 1400"));
    assert!(same("0,-1.5e-9,2", "3,4,-0.1"));
    assert!(same("drift  1.9e-9 J", "drift 0 J"));
    assert!(!same("der(q1)", "der(q2)"));
    assert!(!same("1.9e-9 J", "1.9e-9 W"));
    assert!(!same("1,2", "1,2,3"));
    assert!(!same("none", "1"));
}
