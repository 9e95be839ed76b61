//! Deterministic printing: text in the notation of the description, and LaTeX.
//!
//! In:  an expression and names for its symbols.
//! Out: a string that reads back (text) or typesets (LaTeX) as the expression.

use super::{ExprId, Function, Function2, Graph, Node, Number, Symbolic};

/// How tightly a printed piece holds together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Choice,
    Sum,
    Product,
    Power,
    Atom,
}

/// The notation to print in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// The notation of the description.
    Text,
    /// LaTeX mathematics.
    Latex,
}

struct Printer<'a, S> {
    graph: &'a Graph<S>,
    notation: Notation,
    names: &'a dyn Fn(S) -> String,
}

impl<S: Symbolic> Graph<S> {
    /// Prints an expression.
    pub fn print(&self, e: ExprId, notation: Notation, names: &dyn Fn(S) -> String) -> String {
        Printer {
            graph: self,
            notation,
            names,
        }
        .piece(e)
        .0
    }

    /// Prints an expression in the notation of the description.
    pub fn text(&self, e: ExprId, names: &dyn Fn(S) -> String) -> String {
        self.print(e, Notation::Text, names)
    }
}

impl<S: Symbolic> Printer<'_, S> {
    fn latex(&self) -> bool {
        self.notation == Notation::Latex
    }

    fn piece(&self, e: ExprId) -> (String, Binding) {
        match self.graph.node(e) {
            Node::Number(value) => self.number(*value),
            Node::Pi if self.latex() => ("\\pi".into(), Binding::Atom),
            Node::Pi => ("pi".into(), Binding::Atom),
            Node::Symbol(symbol) => ((self.names)(*symbol), Binding::Atom),
            Node::Sum(constant, terms) => self.sum(*constant, terms),
            Node::Product(factors) => self.product(factors),
            Node::Function(function, x) => self.function(*function, *x),
            Node::Function2(function, x, y) => self.function2(*function, *x, *y),
            Node::Select(comparison, [a, b, then, otherwise]) => {
                let [a, b, then, otherwise] =
                    [a, b, then, otherwise].map(|x| self.within(*x, Binding::Sum));
                let sign = comparison.sign();
                let text = if self.latex() {
                    format!("\\begin{{cases}}{then} & {a} {sign} {b}\\\\ {otherwise}\\end{{cases}}")
                } else {
                    format!("if {a} {sign} {b} then {then} else {otherwise}")
                };
                (text, Binding::Choice)
            }
        }
    }

    /// Prints with parentheses where the context binds more tightly.
    fn within(&self, e: ExprId, context: Binding) -> String {
        let (text, binding) = self.piece(e);
        if binding >= context {
            text
        } else if self.latex() {
            format!("\\left({text}\\right)")
        } else {
            format!("({text})")
        }
    }

    fn number(&self, value: Number) -> (String, Binding) {
        let text = value.to_string();
        let binding = match text.contains('/') {
            _ if value.is_negative() => Binding::Sum,
            true => Binding::Product,
            false => Binding::Atom,
        };
        match text.split_once('/') {
            Some((n, d)) if self.latex() => {
                let (sign, n) = n.strip_prefix('-').map_or(("", n), |n| ("-", n));
                (format!("{sign}\\tfrac{{{n}}}{{{d}}}"), binding)
            }
            _ => (text, binding),
        }
    }

    fn sum(&self, constant: Number, terms: &[(ExprId, Number)]) -> (String, Binding) {
        let negative = |weight: Number| weight.is_negative();
        let mut text = String::new();
        // A positive constant goes first where the terms would begin with a minus.
        let first = !constant.is_zero() && !negative(constant) && negative(terms[0].1);
        if first {
            text.push_str(&self.number(constant).0);
        }
        for (x, weight) in terms {
            text.push_str(joint(text.is_empty(), negative(*weight)));
            text.push_str(&self.scaled(size(*weight), *x));
        }
        if !first && !constant.is_zero() {
            text.push_str(joint(false, negative(constant)));
            text.push_str(&self.number(size(constant)).0);
        }
        let single = terms.len() == 1 && constant.is_zero() && !terms[0].1.is_negative();
        (
            text,
            if single {
                Binding::Product
            } else {
                Binding::Sum
            },
        )
    }

    fn scaled(&self, weight: Number, x: ExprId) -> String {
        if weight.is_one() {
            return self.within(x, Binding::Product);
        }
        let dot = if self.latex() { "\\," } else { "*" };
        format!(
            "{}{dot}{}",
            self.number(weight).0,
            self.within(x, Binding::Product)
        )
    }

    fn product(&self, factors: &[(ExprId, i32)]) -> (String, Binding) {
        let side = |below: bool| -> Vec<String> {
            let chosen = factors
                .iter()
                .filter(|(_, exponent)| (*exponent < 0) == below);
            chosen
                .map(|(base, exponent)| self.power(*base, exponent.unsigned_abs()))
                .collect()
        };
        let dot = if self.latex() { "\\," } else { "*" };
        let (above, below) = (side(false), side(true));
        let numerator = if above.is_empty() {
            "1".to_string()
        } else {
            above.join(dot)
        };
        let text = match (below.len(), self.latex()) {
            (0, _) => numerator,
            (_, true) => format!("\\frac{{{numerator}}}{{{}}}", below.join(dot)),
            (1, false) => format!("{numerator}/{}", below[0]),
            (_, false) => format!("{numerator}/({})", below.join(dot)),
        };
        let power = factors.len() == 1 && factors[0].1 > 0;
        (
            text,
            if power {
                Binding::Power
            } else {
                Binding::Product
            },
        )
    }

    fn power(&self, base: ExprId, exponent: u32) -> String {
        match (exponent, self.latex()) {
            (1, false) => self.within(base, Binding::Power),
            (1, true) => self.within(base, Binding::Product),
            (_, false) => format!("{}^{exponent}", self.within(base, Binding::Atom)),
            (_, true) => match self.graph.node(base) {
                Node::Function(function @ (Function::Sin | Function::Cos), x) => {
                    // In braces, as MathML takes one base and no blank with it; the blank that
                    // is lost before a name is written.
                    let argument = self.argument(*x);
                    let blank = match argument.starts_with("\\left") {
                        true => " ",
                        false => "\\,",
                    };
                    format!("{{\\{}}}^{{{exponent}}}{blank}{argument}", function.name())
                }
                Node::Symbol(symbol) if symbol.has_accent() => {
                    format!("{}^{{{exponent}}}", self.within(base, Binding::Atom))
                }
                _ => format!("{{{}}}^{{{exponent}}}", self.within(base, Binding::Atom)),
            },
        }
    }

    fn function(&self, function: Function, x: ExprId) -> (String, Binding) {
        if !self.latex() {
            return (
                format!("{}({})", function.name(), self.piece(x).0),
                Binding::Atom,
            );
        }
        let text = match function {
            Function::Sqrt => format!("\\sqrt{{{}}}", self.piece(x).0),
            Function::Abs => format!("\\left|{}\\right|", self.piece(x).0),
            Function::Asin => format!("\\arcsin {}", self.argument(x)),
            Function::Acos => format!("\\arccos {}", self.argument(x)),
            Function::Atan => format!("\\arctan {}", self.argument(x)),
            Function::Sign | Function::Table(_) => {
                format!("\\operatorname{{{}}} {}", function.name(), self.argument(x))
            }
            _ => format!("\\{} {}", function.name(), self.argument(x)),
        };
        (text, Binding::Power)
    }

    /// The argument of a function in LaTeX: in parentheses unless it is a name.
    fn argument(&self, x: ExprId) -> String {
        match self.graph.node(x) {
            Node::Symbol(_) | Node::Pi => self.piece(x).0,
            _ => format!("\\left({}\\right)", self.piece(x).0),
        }
    }

    fn function2(&self, function: Function2, x: ExprId, y: ExprId) -> (String, Binding) {
        if function == Function2::Pow {
            let base = self.within(x, Binding::Atom);
            let text = if self.latex() {
                format!("{base}^{{{}}}", self.piece(y).0)
            } else {
                format!("{base}^{}", self.within(y, Binding::Atom))
            };
            return (text, Binding::Power);
        }
        let (x, y, name) = (self.piece(x).0, self.piece(y).0, function.name());
        let text = if self.latex() {
            format!("\\operatorname{{{name}}}\\left({x}, {y}\\right)")
        } else {
            format!("{name}({x}, {y})")
        };
        (text, Binding::Atom)
    }
}

/// What stands before a term of a sum.
fn joint(first: bool, negative: bool) -> &'static str {
    match (first, negative) {
        (true, true) => "-",
        (true, false) => "",
        (false, true) => " - ",
        (false, false) => " + ",
    }
}

fn size(value: Number) -> Number {
    if value.is_negative() { -value } else { value }
}
