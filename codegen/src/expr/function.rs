//! The functions of the language, and their names.

use super::Lookup;

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
    /// Something in a table.
    Table(Lookup),
}

/// A function of two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function2 {
    /// Angle of the point (second, first).
    Atan2,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// A real power that is neither whole nor half.
    Pow,
}

/// A comparison; `a > b` is `b < a`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Comparison {
    Less,
    LessEqual,
    Equal,
    NotEqual,
}

/// What a choice depends on: a comparison, and the switching function whose side decides it
/// while a run holds that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Test {
    /// The comparison.
    pub comparison: Comparison,
    /// The side that a run may hold; none if the comparison always decides.
    pub held: Option<Side>,
    /// Whether what it chooses between has the same value and the same first two
    /// derivatives where it changes.
    pub smooth: bool,
}

/// A side of a switching function, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// The function is positive.
    Above(u32),
    /// It is negative.
    Below(u32),
}

impl From<Comparison> for Test {
    fn from(comparison: Comparison) -> Self {
        Self {
            comparison,
            held: None,
            smooth: false,
        }
    }
}

impl Test {
    /// Whether it holds where nothing is held.
    pub fn holds(self, a: f64, b: f64) -> bool {
        self.comparison.holds(a, b)
    }

    /// The sign of its comparison in a description.
    pub fn sign(self) -> &'static str {
        self.comparison.sign()
    }
}

impl Function {
    /// Every function that is known by its name alone, with the name it has in a description.
    pub const ALL: [(Function, &'static str); 14] = [
        (Function::Sin, "sin"),
        (Function::Cos, "cos"),
        (Function::Tan, "tan"),
        (Function::Asin, "asin"),
        (Function::Acos, "acos"),
        (Function::Atan, "atan"),
        (Function::Sinh, "sinh"),
        (Function::Cosh, "cosh"),
        (Function::Tanh, "tanh"),
        (Function::Exp, "exp"),
        (Function::Ln, "ln"),
        (Function::Sqrt, "sqrt"),
        (Function::Abs, "abs"),
        (Function::Sign, "sign"),
    ];

    /// The name it has in a description.
    pub fn name(self) -> &'static str {
        if let Self::Table(lookup) = self {
            return lookup.name();
        }
        Self::ALL
            .iter()
            .find(|(function, _)| *function == self)
            .map_or("", |(_, name)| name)
    }

    /// Its value.
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Tan => x.tan(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Exp => x.exp(),
            Function::Ln => x.ln(),
            Function::Sqrt => x.sqrt(),
            Function::Abs => x.abs(),
            Function::Sign if x == 0.0 => 0.0,
            Function::Sign => x.signum(),
            Function::Table(lookup) => lookup.apply(x),
        }
    }

    /// Whether it has a derivative on the inside of its domain.
    pub fn is_differentiable(self) -> bool {
        match self {
            Function::Abs | Function::Sign => false,
            Function::Table(lookup) => lookup.is_differentiable(),
            _ => true,
        }
    }
}

impl Function2 {
    /// The name it has in a description.
    pub fn name(self) -> &'static str {
        match self {
            Function2::Atan2 => "atan2",
            Function2::Min => "min",
            Function2::Max => "max",
            Function2::Pow => "pow",
        }
    }

    /// Its value.
    pub fn apply(self, x: f64, y: f64) -> f64 {
        match self {
            Function2::Atan2 => x.atan2(y),
            Function2::Min if x < y || x.is_nan() => x,
            Function2::Max if x > y || x.is_nan() => x,
            Function2::Min | Function2::Max => y,
            Function2::Pow => x.powf(y),
        }
    }
}

impl Comparison {
    /// Whether it holds.
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Comparison::Less => a < b,
            Comparison::LessEqual => a <= b,
            Comparison::Equal => a == b,
            Comparison::NotEqual => a != b,
        }
    }

    /// Its sign in a description.
    pub fn sign(self) -> &'static str {
        match self {
            Comparison::Less => "<",
            Comparison::LessEqual => "<=",
            Comparison::Equal => "==",
            Comparison::NotEqual => "!=",
        }
    }
}
