//! The syntax tree: what is written, with its places.

use crate::diagnostic::Span;
use crate::expr::{Comparison, Number};
use std::rc::Rc;

/// A name and where it stands.
#[derive(Clone, Debug)]
pub struct Name {
    /// The name.
    pub text: String,
    /// Its place.
    pub span: Span,
}

/// A statement.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its doc comment.
    pub docs: String,
    /// Its place, from the first word to the end.
    pub span: Span,
    /// What it says.
    pub kind: ItemKind,
}

/// What a statement says.
#[derive(Clone, Debug)]
pub enum ItemKind {
    /// `const`, `param`, `input` or `output`.
    Declaration(Declaration),
    /// `coord n[size]: unit;` or `state n[size]: unit;`
    Coordinate {
        /// Whether it is a state of the first order.
        state: bool,
        /// Its name.
        name: Name,
        /// The number of coordinates, for an array.
        size: Option<Expr>,
        /// The unit, if it is given.
        unit: Option<UnitExpr>,
    },
    /// `let n[range] = value;`
    Let(Box<Let>),
    /// `fn f(x, y) = value;`
    Function(Rc<Function>),
    /// `part P(x, y) { items }`
    Part(Box<Part>),
    /// `use name;`
    Use(Name),
    /// `kinetic`, `potential` or `dissipation`.
    Energy(Energy, Expr),
    /// `force F on x;`
    Force {
        /// The force.
        force: Expr,
        /// What it works on.
        on: Expr,
    },
    /// `der(n) = value;`, the rate of a state.
    Rate {
        /// The state.
        of: Expr,
        /// Its rate.
        value: Expr,
    },
    /// `constraint left = right;`
    Constraint {
        /// Its name, if it has one.
        name: Option<Name>,
        /// The left side.
        left: Expr,
        /// The right side.
        right: Expr,
        /// The equation as written, on one line.
        text: String,
    },
    /// `start { … }`
    Start(Vec<StartItem>),
    /// `event n: value rising;`
    Event {
        /// Its name.
        name: Name,
        /// The function whose zeros are wanted.
        value: Expr,
        /// The sign change that counts.
        direction: Crossing,
    },
    /// `draw shape(arguments);`
    Draw {
        /// The shape.
        shape: Drawing,
        /// Its arguments.
        arguments: Vec<Expr>,
    },
    /// `for range { items }`
    For(Range, Vec<Item>),
}

/// `const`, `param`, `input` or `output`.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// Which of the four.
    pub kind: Declared,
    /// Its name.
    pub name: Name,
    /// Its elements, for an array.
    pub size: Option<Box<Size>>,
    /// The unit, if it is given.
    pub unit: Option<UnitExpr>,
    /// The value, default or law.
    pub value: Expr,
}

impl Declaration {
    /// The formulas in it.
    pub fn formulas(&self) -> Vec<&Expr> {
        let size = match self.size.as_deref() {
            None => Vec::new(),
            Some(Size::Count(count)) => vec![count],
            Some(Size::Each(range)) => vec![&range.from, &range.to],
        };
        [size, vec![&self.value]].concat()
    }
}

/// The elements of a declared array.
#[derive(Clone, Debug)]
pub enum Size {
    /// `[K]`: so many, counted from 0.
    Count(Expr),
    /// `[i in 0..K]`: one for each index.
    Each(Range),
}

/// The kinds of declaration with a unit and a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declared {
    /// `const`
    Constant,
    /// `param`
    Parameter,
    /// `input`
    Input,
    /// `output`
    Output,
}

/// `let n: unit = value;` or `let n[i in 0..K]: unit = value;`
#[derive(Clone, Debug)]
pub struct Let {
    /// Its name.
    pub name: Name,
    /// The index and its values, for an array.
    pub range: Option<Range>,
    /// Its unit, if one is given.
    pub unit: Option<UnitExpr>,
    /// The value.
    pub value: Expr,
}

/// `fn f(x, y: unit): unit = value;`
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name.
    pub name: Name,
    /// What it is a function of.
    pub arguments: Vec<Argument>,
    /// The unit of its value, if one is given.
    pub unit: Option<UnitExpr>,
    /// The value.
    pub value: Expr,
}

/// `part P(x, y: unit) { items }`
#[derive(Clone, Debug)]
pub struct Part {
    /// Its name.
    pub name: Name,
    /// What it is given where it is used.
    pub arguments: Vec<Argument>,
    /// What stands between its braces.
    pub items: Vec<Item>,
}

/// An argument of a function or a part.
#[derive(Clone, Debug)]
pub struct Argument {
    /// Its name.
    pub name: Name,
    /// Its unit, if one is given.
    pub unit: Option<UnitExpr>,
}

impl Let {
    /// The formulas in it.
    pub fn formulas(&self) -> Vec<&Expr> {
        let range = self.range.iter();
        let range = range.flat_map(|range| [&range.from, &range.to]);
        range.chain([&self.value]).collect()
    }
}

/// The three scalar functions that forces come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Energy {
    /// `kinetic`
    Kinetic,
    /// `potential`
    Potential,
    /// `dissipation`
    Dissipation,
}

/// The direction of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// `rising`
    Rising,
    /// `falling`
    Falling,
    /// `crossing`
    Crossing,
}

/// The shapes of `draw`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawing {
    /// `line`
    Line,
    /// `circle`
    Circle,
    /// `polygon`
    Polygon,
    /// `trace`
    Trace,
}

/// An entry of `start`.
#[derive(Clone, Debug)]
pub enum StartItem {
    /// `target = value;` or `target ~ value;`
    Entry {
        /// A coordinate, `der(coordinate)`, or any formula.
        target: Expr,
        /// `=` (held) or `~` (a guess).
        held: bool,
        /// The value.
        value: Expr,
    },
    /// `for range { … }`
    For(Range, Vec<StartItem>),
}

/// `index in from..to`
#[derive(Clone, Debug)]
pub struct Range {
    /// The index.
    pub index: Name,
    /// The first value.
    pub from: Expr,
    /// The value behind the last.
    pub to: Expr,
}

/// A formula.
#[derive(Clone, Debug)]
pub struct Expr {
    /// Its place.
    pub span: Span,
    /// What it says.
    pub kind: ExprKind,
}

/// What a formula says. Sums and products are lists, so that long ones are not
/// deep.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// A number.
    Number(Number),
    /// Quoted text: the name of a file or of a column in it.
    Text(String),
    /// A name.
    Name(String),
    /// `-x`
    Negative(Box<Expr>),
    /// `a + b - c`; the flag says that the term is subtracted.
    Sum(Vec<(bool, Expr)>),
    /// `a * b / c`; the flag says that the factor divides.
    Product(Vec<(bool, Expr)>),
    /// `base ^ exponent`
    Power(Box<Expr>, Box<Expr>),
    /// `function(arguments)`
    Call(Name, Vec<Expr>),
    /// `sum(range, term)`
    Repeat(Box<Range>, Box<Expr>),
    /// `[a, b, c]`
    Vector(Vec<Expr>),
    /// `.x`, `.y` or `.z`, by number.
    Component(Box<Expr>, usize),
    /// `part.name`
    Member(Box<Expr>, Name),
    /// `array[index]`
    Index(Box<Expr>, Box<Expr>),
    /// `[a, b, c] unit`
    InUnit(Box<Expr>, UnitExpr),
    /// `if condition then a else b`
    If(Box<Condition>, Box<Expr>, Box<Expr>),
}

/// What a choice depends on.
#[derive(Clone, Debug)]
pub enum Condition {
    /// `left ⋈ right`; `a > b` is kept as `b < a`.
    Compare(Comparison, Box<[Expr; 2]>),
    /// `not a`
    Not(Box<Condition>),
    /// `a and b`
    And(Box<Condition>, Box<Condition>),
    /// `a or b`
    Or(Box<Condition>, Box<Condition>),
}

impl Condition {
    /// The formulas that are compared.
    pub fn sides(&self) -> Vec<&Expr> {
        match self {
            Condition::Compare(_, sides) => sides.iter().collect(),
            Condition::Not(inside) => inside.sides(),
            Condition::And(a, b) | Condition::Or(a, b) => [a.sides(), b.sides()].concat(),
        }
    }
}

/// A unit as it is written.
#[derive(Clone, Debug)]
pub struct UnitExpr {
    /// Its place.
    pub span: Span,
    /// Its text without blanks.
    pub text: String,
    /// The unit names with their exponents; parentheses and quotients multiplied
    /// out.
    pub factors: Vec<(Name, i32)>,
}
