//! Functions, `fn f(x, y: m): N = formula;`, and parts, `part P(x, y: m) { … }`.

use super::ast::{Argument, Function, ItemKind, Part};
use super::cursor::{Cursor, Parsed};
use super::messages::RENAME_ONE;
use crate::diagnostic::Diagnostic;
use std::rc::Rc;

const HELP: &str = "a function is written `fn f(x, y: m) = …;`";

const PART: &str = "a part is written `part Rod(foot, m: kg) { coord q: rad; … }`";

impl Cursor<'_> {
    /// Reads what stands behind `fn`.
    pub fn function(&mut self) -> Parsed<ItemKind> {
        let name = self.expect_name("the name of the function", HELP)?;
        let arguments = self.named_arguments(HELP)?;
        if arguments.is_empty() {
            let error = Diagnostic::error(name.span, "a function has an argument or more");
            let help = format!("what has none is written `let {} = …;`", name.text);
            return Err(self.fail(error.help(help)));
        }
        let unit = self.optional_unit()?;
        self.expect_symbol("=", HELP)?;
        let value = self.expression()?;
        Ok(ItemKind::Function(Rc::new(Function {
            name,
            arguments,
            unit,
            value,
        })))
    }

    /// Reads what stands behind `part`.
    pub fn part(&mut self) -> Parsed<ItemKind> {
        let name = self.expect_name("the name of the part", PART)?;
        let arguments = self.named_arguments(PART)?;
        let mut items = Vec::new();
        self.deeper(|cursor| cursor.block(PART, |item| items.push(item)))?;
        Ok(ItemKind::Part(Box::new(Part {
            name,
            arguments,
            items,
        })))
    }

    /// Reads `(x, y: unit)`: names with commas between them, each perhaps with a unit.
    pub fn named_arguments(&mut self, help: &str) -> Parsed<Vec<Argument>> {
        self.expect_symbol("(", help)?;
        let mut arguments: Vec<Argument> = Vec::new();
        while !self.take_symbol(")") {
            let name = self.expect_name("the name of an argument", help)?;
            if let Some(first) = arguments.iter().find(|a| a.name.text == name.text) {
                let message = format!("two arguments are called `{}`", name.text);
                let error = Diagnostic::error(name.span, message);
                let error = error.also(first.name.span, "this is the other one");
                return Err(self.fail(error.help(RENAME_ONE)));
            }
            let unit = self.optional_unit()?;
            arguments.push(Argument { name, unit });
            if !self.at_symbol(")") {
                self.expect_symbol(",", help)?;
            }
        }
        Ok(arguments)
    }
}
