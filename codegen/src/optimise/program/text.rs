//! Programs as text, to be read.
//!
//! In:  a program, names for its symbols.
//! Out: a line for each operation, `%3 = %1*%2`, and one for each output.
//!
//! Numbers and symbols stand where they are used. Results have the sign of percent, which no
//! name of a description has, and are counted from 1.

use super::{Operation, Program, Slot, Value};
use crate::model::Symbol;
use std::fmt::{self, Display, Formatter};

impl Display for Program {
    /// With the symbols as the compiler counts them.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text(&|symbol| format!("{symbol:?}")))
    }
}

impl Program {
    /// The program, operation by operation, with a line feed at the end of each line.
    pub fn text(&self, names: &dyn Fn(Symbol) -> String) -> String {
        let mut lines = Lines {
            program: self,
            names,
            known: Vec::new(),
        };
        let mut text = String::new();
        let mut count = 0;
        for operation in self.list() {
            let known = match lines.atom(operation) {
                Some(atom) => atom,
                None => {
                    count += 1;
                    text.push_str(&format!("%{count} = {}\n", lines.operation(operation)));
                    format!("%{count}")
                }
            };
            lines.known.push(known);
        }
        for (slot, value) in &self.outputs {
            let (place, value) = (lines.place(slot), lines.value(*value));
            text.push_str(&format!("{}{place} = {value}\n", slot.array));
        }
        text
    }
}

/// A program that is being written.
struct Lines<'a> {
    program: &'a Program,
    names: &'a dyn Fn(Symbol) -> String,
    /// How each value so far is called.
    known: Vec<String>,
}

impl Lines<'_> {
    fn value(&self, value: Value) -> &str {
        self.known.get(value.index()).map_or("", String::as_str)
    }

    /// What needs no line of its own.
    fn atom(&self, operation: &Operation) -> Option<String> {
        match operation {
            Operation::Number(number) => {
                let text = number.to_string();
                let alone = !text.contains(['-', '/']);
                Some(if alone { text } else { format!("({text})") })
            }
            Operation::Pi => Some("pi".to_string()),
            Operation::Symbol(symbol) => Some((self.names)(*symbol)),
            _ => None,
        }
    }

    fn operation(&self, operation: &Operation) -> String {
        match operation {
            Operation::Sum(terms) => self.sum(terms),
            Operation::Product(factors) => {
                let factors: Vec<&str> = factors.iter().map(|x| self.value(*x)).collect();
                factors.join("*")
            }
            Operation::Quotient(x, y) => format!("{}/{}", self.value(*x), self.value(*y)),
            Operation::Function(function, x) => format!("{}({})", function.name(), self.value(*x)),
            Operation::Function2(function, x, y) => {
                format!(
                    "{}({}, {})",
                    function.name(),
                    self.value(*x),
                    self.value(*y)
                )
            }
            Operation::Select(test, parts) => {
                let [a, b, then, otherwise] = parts.map(|x| self.value(x));
                format!("if {a} {} {b} then {then} else {otherwise}", test.sign())
            }
            Operation::Input(index, law) => {
                let input = (self.names)(Symbol::Input(*index));
                format!("{input}, else {}", self.value(*law))
            }
            atom => self.atom(atom).unwrap_or_default(),
        }
    }

    fn sum(&self, terms: &[(bool, Value)]) -> String {
        let mut text = String::new();
        for (minus, value) in terms {
            let joint = match (text.is_empty(), minus) {
                (true, true) => "-",
                (true, false) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            text.extend([joint, self.value(*value)]);
        }
        text
    }

    /// Where in its array an output goes, counted from 1.
    fn place(&self, slot: &Slot) -> String {
        let outputs = self.program.outputs.iter();
        let is_matrix = outputs
            .filter(|(other, _)| other.array == slot.array)
            .any(|(other, _)| other.column > 0);
        match is_matrix {
            true => format!("[{},{}]", slot.row + 1, slot.column + 1),
            false => format!("[{}]", slot.row + 1),
        }
    }
}
