//! What the documentation shows is right.

use super::accept;

const REFERENCE: &str = include_str!("../../../docs/language.md");
const README: &str = include_str!("../../../README.md");

/// What the examples of statements in the reference leave to the reader, each with
/// the name that it declares.
const LEFT_OUT: [(&str, &str); 20] = [
    ("g", "const g: m/s^2 = 9.81;"),
    ("N", "const N = 3;"),
    ("L", "param L: m = 1;"),
    ("m", "param m: kg = 1;"),
    ("J", "param J: kg*m^2 = 1;"),
    ("J1", "param J1: kg*m^2 = 1;"),
    ("J3", "param J3: kg*m^2 = 1;"),
    ("k", "param k: N/m = 1;"),
    ("l", "param l: m = 1;"),
    ("d", "param d: N*m*s = 1;"),
    ("A", "param A: m = 1;"),
    ("w", "param w: rad/s = 1;"),
    ("q1", "coord q1: rad;"),
    ("q2", "coord q2: rad;"),
    ("x", "coord x: m;"),
    ("y", "coord y: m;"),
    ("theta", "coord theta[N]: rad;"),
    ("pin", "let pin = L*[cos(q1), sin(q1)];"),
    ("stretch", "let stretch = norm(pin - [1, 0]);"),
    ("torque", "input torque: N*m = 0;"),
];

/// The blocks of a text that show descriptions or parts of them.
fn blocks(text: &str) -> impl Iterator<Item = &str> {
    let blocks = text.split("```text\n").skip(1);
    let blocks = blocks.filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| !block.starts_with("error"))
}

fn is_whole(block: &str) -> bool {
    let mut lines = block.lines();
    lines.any(|line| line.starts_with("mechanism ") && line.ends_with('{'))
}

/// Whether a block of statements declares a name itself.
fn declares(block: &str, name: &str) -> bool {
    let is_declared = |line: &str| {
        let mut words = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let first = words.next().unwrap_or("");
        ["const", "param", "coord", "input", "let"].contains(&first) && words.next() == Some(name)
    };
    block.lines().any(is_declared)
}

#[test]
fn every_description_in_the_documentation_is_right() {
    let whole: Vec<&str> = [REFERENCE, README].into_iter().flat_map(blocks).collect();
    let whole: Vec<&str> = whole.into_iter().filter(|block| is_whole(block)).collect();
    assert!(whole.len() >= 3, "{} descriptions", whole.len());
    for description in whole {
        accept(description);
    }
}

#[test]
fn every_example_of_statements_in_the_reference_is_right() {
    for example in blocks(REFERENCE).filter(|block| !is_whole(block)) {
        let missing = LEFT_OUT.iter().filter(|(name, _)| !declares(example, name));
        let missing: String = missing.map(|(_, text)| *text).collect();
        let moving = "coord other; kinetic der(other)^2;";
        accept(&format!(
            "mechanism Test {{ {missing} {moving}\n{example}}}"
        ));
    }
}
