//! The words of the language, in one table for the reader, the printer and other tools.

use super::ast::{Crossing, Drawing};
use crate::expr::Function;

/// The statements that a word of their own begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statement {
    Constant,
    Parameter,
    Coordinate,
    State,
    Input,
    Let,
    Function,
    Kinetic,
    Potential,
    Dissipation,
    Force,
    Constraint,
    Start,
    Output,
    Event,
    Draw,
    Part,
    Use,
}

impl Statement {
    /// The statement that a word begins.
    pub fn of(word: &str) -> Option<Self> {
        let found = STATEMENTS.iter().find(|(known, ..)| *known == word);
        found.map(|(_, statement, _)| *statement)
    }
}

/// Words that begin a statement, with an example of each.
pub const STATEMENTS: [(&str, Statement, &str); 18] = [
    ("const", Statement::Constant, "const g: m/s^2 = 9.81;"),
    ("param", Statement::Parameter, "param L1: m = 0.5;"),
    ("coord", Statement::Coordinate, "coord q1: rad;"),
    ("state", Statement::State, "state z: m; der(z) = goal - x;"),
    ("input", Statement::Input, "input u: N*m = 0;"),
    ("let", Statement::Let, "let c = [L1*cos(q1), L1*sin(q1)];"),
    ("fn", Statement::Function, "fn spring(d: m): N = -k*d;"),
    (
        "kinetic",
        Statement::Kinetic,
        "kinetic 1/2*m1*norm2(der(c));",
    ),
    ("potential", Statement::Potential, "potential m1*g*c.y;"),
    (
        "dissipation",
        Statement::Dissipation,
        "dissipation 1/2*d*der(q1)^2;",
    ),
    ("force", Statement::Force, "force u on q1;"),
    (
        "constraint",
        Statement::Constraint,
        "constraint L1*sin(q1) = L2*sin(q2);",
    ),
    (
        "start",
        Statement::Start,
        "start { q1 = 45*deg; q2 ~ 0.7; }",
    ),
    ("output", Statement::Output, "output x: m = c.x;"),
    ("event", Statement::Event, "event top: q1 - pi/2 rising;"),
    ("draw", Statement::Draw, "draw line([0, 0], c);"),
    (
        "part",
        Statement::Part,
        "part Rod(foot, m: kg) { coord q: rad; … }",
    ),
    ("use", Statement::Use, "use parts;"),
];

/// Words that hold statements and formulas together.
pub const CONNECTIVES: [&str; 10] = [
    "mechanism",
    "for",
    "in",
    "on",
    "if",
    "then",
    "else",
    "and",
    "or",
    "not",
];

/// What `draw` draws.
pub const SHAPES: [(&str, Drawing); 4] = [
    ("line", Drawing::Line),
    ("circle", Drawing::Circle),
    ("polygon", Drawing::Polygon),
    ("trace", Drawing::Trace),
];

/// Which sign changes of an event count.
pub const DIRECTIONS: [(&str, Crossing); 3] = [
    ("rising", Crossing::Rising),
    ("falling", Crossing::Falling),
    ("crossing", Crossing::Crossing),
];

/// Words that can't be names of quantities: they are part of formulas and
/// statements, or have no raw form in Rust.
pub const RESERVED: [&str; 11] = [
    "if", "then", "else", "in", "on", "for", "_", "self", "Self", "super", "crate",
];

/// Whether a word is a function of one formula.
pub fn takes_one(word: &str) -> bool {
    const OTHERS: [&str; 9] = [
        "der",
        "norm",
        "norm2",
        "transpose",
        "rot",
        "rotx",
        "roty",
        "rotz",
        "omega",
    ];
    OTHERS.contains(&word) || Function::ALL.iter().any(|(_, known)| *known == word)
}

/// How a statement is written.
pub fn example(word: &str) -> String {
    let example = STATEMENTS.iter().find(|(known, ..)| *known == word);
    example.map_or(String::new(), |(_, _, text)| {
        format!("write for example `{text}`")
    })
}
