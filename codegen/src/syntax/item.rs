//! Statements: the words that begin them, and the file around them.

use super::ast::{Declaration, Declared, Energy, Item, ItemKind, Let, Name, Size};
use super::cursor::{Cursor, Parsed, Reported};
use super::foreign::{Follows, statement_help};
use super::keyword::{SHAPES, Statement, example};
use super::messages::{FOR, NAMES, REMOVE};
use super::model::Model;
use super::token::TokenKind;
use crate::diagnostic::Diagnostic;

const MATRIX: &str = "the size of a matrix is that of its value, `[[1, 0], [0, 1]]`, without `[…]`";

const FILE: &str = "a description is written `mechanism Name { … }`";

impl Cursor<'_> {
    /// Reads a whole file.
    pub fn file(&mut self) -> Parsed<Model> {
        let docs = self.docs();
        if !self.take_word("mechanism") {
            let help = match self.at_word("use") || self.at_statement() {
                true => format!("{FILE}, and this stands inside the braces"),
                false => FILE.to_string(),
            };
            let reported = self.unexpected("`mechanism`", &help);
            let named = matches!(self.peek_at(1).kind, TokenKind::Word(_));
            if !named || self.peek_at(2).kind != TokenKind::Symbol("{") {
                return Err(reported);
            }
            self.advance();
        }
        let name = match self.expect_name("the name of the mechanism", FILE) {
            Ok(name) => name,
            Err(reported) => self.nameless(reported)?,
        };
        let mut model = Model::named(name, docs);
        if !self.at_symbol("{") && self.at_statement() {
            let _reported = self.unexpected("`{`", FILE);
        } else {
            self.block(FILE, |item| model.add(item))?;
            self.end_of_file();
        }
        // Mistakes in what stands outside are told all the same.
        if self.at_statement() {
            self.statements()
                .into_iter()
                .for_each(|item| model.add(item));
        }
        Ok(model)
    }

    /// Refuses what follows the mechanism.
    fn end_of_file(&mut self) {
        if self.peek().kind == TokenKind::End {
            return;
        }
        let here = Diagnostic::error(self.span(), "nothing can follow the mechanism");
        let error = if self.at_statement() {
            let message = "this stands outside the braces";
            let help = "move it, and what follows, in front of the `}` that closes the mechanism";
            let outside = Diagnostic::error(self.span(), message).help(help);
            outside.also(self.last_span(), "closes the mechanism")
        } else if self.at_symbol(";") {
            here.help(REMOVE)
        } else {
            here.help("a file holds one mechanism; write another file")
        };
        let _reported = self.fail(error);
    }

    /// Goes on at the brace behind what is no name, and gives the mechanism none: mistakes
    /// inside are told all the same.
    fn nameless(&mut self, reported: Reported) -> Parsed<Name> {
        let span = self.span();
        while !self.at_symbol("{") {
            let ends = [";", "}"].iter().any(|sign| self.at_symbol(sign));
            if ends || self.peek().kind == TokenKind::End {
                return Err(reported);
            }
            self.advance();
        }
        let text = String::new();
        Ok(Name { text, span })
    }

    /// Hands over the statements of a block.
    pub fn block(&mut self, help: &str, mut add: impl FnMut(Item)) -> Parsed<()> {
        self.expect_symbol("{", help)?;
        let depth = self.block_depth();
        while self.next_in_block(depth, "a statement", REMOVE) {
            if let Some(item) = self.statement(depth, Self::item, is_block) {
                add(item);
            }
        }
        self.expect_symbol("}", "")
    }

    /// The nesting inside the bracket that was read last.
    pub fn block_depth(&self) -> usize {
        if self.at_symbol("}") {
            self.depth() + 1
        } else {
            self.depth()
        }
    }

    /// Goes on to the next statement of a block; `false` at the bracket that closes it. A `;`
    /// too many does no harm, a `,` is refused where `what` is expected.
    pub fn next_in_block(&mut self, depth: usize, what: &str, help: &str) -> bool {
        loop {
            if self.peek().kind == TokenKind::End || (self.at_symbol("}") && self.depth() < depth) {
                return false;
            }
            if self.at_symbol(",") {
                let _reported = self.unexpected_here(what, help);
                self.advance();
            } else if !self.take_symbol(";") {
                return true;
            }
        }
    }

    /// Reads statements that stand in no mechanism, up to the end of the file.
    pub fn statements(&mut self) -> Vec<Item> {
        let mut items = Vec::new();
        while self.peek().kind != TokenKind::End {
            items.extend(self.statement(0, Self::item, is_block));
        }
        items
    }

    fn item(&mut self) -> Parsed<Item> {
        let docs = self.docs();
        let start = self.span();
        let TokenKind::Word(word) = self.peek().kind.clone() else {
            return Err(self.unexpected_here("a statement", &statement_help("", &Follows::Other)));
        };
        if !self.at_statement() && word != "der" {
            let error = Diagnostic::error(start, format!("`{word}` does not begin a statement"));
            let [next, open] = [1, 2].map(|ahead| &self.peek_at(ahead).kind);
            let follows = match (next, open) {
                (TokenKind::Symbol("="), _) => Follows::Value,
                (TokenKind::Word(name), TokenKind::Symbol("(")) => Follows::Call(name),
                _ => Follows::Other,
            };
            let help = statement_help(&word, &follows);
            return Err(self.fail(error.help(help)));
        }
        self.advance();
        let kind = self.item_kind(&word)?;
        Ok(Item {
            docs,
            span: start.to(self.last_span()),
            kind,
        })
    }

    fn item_kind(&mut self, word: &str) -> Parsed<ItemKind> {
        let kind = match Statement::of(word) {
            None if word == "for" => {
                let range = self.range(FOR)?;
                let mut body = Vec::new();
                self.deeper(|cursor| cursor.block(FOR, |item| body.push(item)))?;
                return Ok(ItemKind::For(range, body));
            }
            None => self.rate()?,
            Some(Statement::Start) => return Ok(ItemKind::Start(self.start_block()?)),
            Some(Statement::Part) => return self.part(),
            Some(Statement::Constant) => self.declaration(Declared::Constant, word)?,
            Some(Statement::Parameter) => self.declaration(Declared::Parameter, word)?,
            Some(Statement::Input) => self.declaration(Declared::Input, word)?,
            Some(Statement::Output) => self.declaration(Declared::Output, word)?,
            Some(Statement::Coordinate) => self.coordinate(false)?,
            Some(Statement::State) => self.coordinate(true)?,
            Some(Statement::Let) => self.let_item()?,
            Some(Statement::Function) => self.function()?,
            Some(Statement::Use) => {
                ItemKind::Use(self.expect_name("the name of a library", &example(word))?)
            }
            Some(Statement::Kinetic) => self.energy(Energy::Kinetic, word)?,
            Some(Statement::Potential) => self.energy(Energy::Potential, word)?,
            Some(Statement::Dissipation) => self.energy(Energy::Dissipation, word)?,
            Some(Statement::Force) => self.force()?,
            Some(Statement::Constraint) => self.constraint()?,
            Some(Statement::Event) => self.event()?,
            Some(Statement::Draw) => self.draw()?,
        };
        self.end_of_statement(word, &kind)?;
        Ok(kind)
    }

    /// Reads the name of something that a statement declares.
    pub fn name(&mut self, what: &str, word: &str) -> Parsed<Name> {
        self.expect_name(&format!("the name of {what}"), &example(word))
    }

    fn declaration(&mut self, kind: Declared, word: &str) -> Parsed<ItemKind> {
        let what = match kind {
            Declared::Constant => "the constant",
            Declared::Parameter => "the parameter",
            Declared::Input => "the input",
            Declared::Output => "the output",
        };
        let name = self.name(what, word)?;
        if kind == Declared::Output && self.at_symbol("[") {
            let error = Diagnostic::error(self.span(), "an output has no size of its own");
            let help = "an output of a vector or an array has a column for each element";
            return Err(self.fail(error.help(help)));
        }
        self.size_in_brackets(&name, word)?;
        let size = self.size(&format!(
            "an array is written `{word} {}[3] = …;`",
            name.text
        ))?;
        self.one_name(&name, word, " = …")?;
        let unit = self.optional_unit()?;
        let help = match &self.peek().kind {
            TokenKind::Symbol("-" | ".") if unit.is_none() => NAMES.to_string(),
            TokenKind::Symbol("[") if size.is_some() => MATRIX.to_string(),
            TokenKind::Word(other) if unit.is_none() && !self.at_next_statement() => {
                format!(
                    "a unit stands behind `:`: `{word} {}: {other} = …;`",
                    name.text
                )
            }
            _ => example(word),
        };
        self.expect_symbol("=", &help)?;
        let value = self.expression()?;
        Ok(ItemKind::Declaration(Declaration {
            kind,
            name,
            size,
            unit,
            value,
        }))
    }

    /// Refuses `y(3)`.
    fn size_in_brackets(&mut self, name: &Name, word: &str) -> Parsed<()> {
        let size = match &self.peek_at(1).kind {
            TokenKind::Number(size) if self.at_symbol("(") => size.clone(),
            _ => return Ok(()),
        };
        let error = Diagnostic::error(self.span(), "the size of an array stands in brackets");
        Err(self.fail(error.help(format!("write `{word} {}[{size}]`", name.text))))
    }

    /// Reads `[K]` or `[i in 0..K]` if it comes next.
    fn size(&mut self, help: &str) -> Parsed<Option<Box<Size>>> {
        if !self.take_symbol("[") {
            return Ok(None);
        }
        let each = matches!(&self.peek_at(1).kind, TokenKind::Word(word) if word == "in");
        let size = match each {
            true => Size::Each(self.range(help)?),
            false => Size::Count(self.expression()?),
        };
        let help = if self.at_symbol(",") { MATRIX } else { help };
        self.expect_symbol("]", help)?;
        Ok(Some(Box::new(size)))
    }

    /// Refuses a list of names.
    fn one_name(&mut self, name: &Name, word: &str, rest: &str) -> Parsed<()> {
        if !self.at_symbol(",") {
            return Ok(());
        }
        let other = match &self.peek_at(1).kind {
            TokenKind::Word(other) => other.clone(),
            _ => "…".to_string(),
        };
        let error = Diagnostic::error(self.span(), format!("`{word}` declares one name"));
        let first = &name.text;
        let help = format!("write `{word} {first}{rest}; {word} {other}{rest};`");
        Err(self.fail(error.help(help)))
    }

    fn coordinate(&mut self, state: bool) -> Parsed<ItemKind> {
        let (word, what) = match state {
            true => ("state", "state"),
            false => ("coord", "coordinate"),
        };
        let name = self.name(&format!("the {what}"), word)?;
        let mut size = None;
        self.size_in_brackets(&name, word)?;
        if self.take_symbol("[") {
            size = Some(self.expression()?);
            let help = format!("an array of {what}s is written `{word} theta[3]: rad;`");
            self.expect_symbol("]", &help)?;
        }
        self.one_name(&name, word, ": …")?;
        let unit = self.optional_unit()?;
        if self.at_symbol("=") {
            let error = Diagnostic::error(self.span(), format!("a {what} has no value of its own"));
            let help = format!(
                "its value at the start is written `start {{ {} = …; }}`",
                name.text
            );
            return Err(self.fail(error.help(help)));
        }
        Ok(ItemKind::Coordinate {
            state,
            name,
            size,
            unit,
        })
    }

    /// `der(state) = formula`. The word begins a statement only where one has to begin:
    /// lines of formulas may begin so, too.
    fn rate(&mut self) -> Parsed<ItemKind> {
        let help = "the rate of a state is written `der(z) = goal - x;`";
        if let TokenKind::Word(state) = &self.peek().kind {
            let help = format!("write `der({state}) = …;`");
            return Err(self.unexpected("`(`", &help));
        }
        self.expect_symbol("(", help)?;
        let of = self.expression()?;
        self.expect_symbol(")", help)?;
        self.expect_symbol("=", help)?;
        let value = self.expression()?;
        Ok(ItemKind::Rate { of, value })
    }

    fn let_item(&mut self) -> Parsed<ItemKind> {
        let name = self.name("the quantity", "let")?;
        let mut range = None;
        if self.take_symbol("[") {
            let help = "an array is written `let n[i in 0..K] = …;`";
            range = Some(self.range(help)?);
            self.expect_symbol("]", help)?;
        }
        let unit = self.optional_unit()?;
        self.expect_symbol("=", &example("let"))?;
        let value = self.expression()?;
        Ok(ItemKind::Let(Box::new(Let {
            name,
            range,
            unit,
            value,
        })))
    }

    fn energy(&mut self, energy: Energy, word: &str) -> Parsed<ItemKind> {
        self.no_sign_behind(word)?;
        Ok(ItemKind::Energy(energy, self.expression()?))
    }

    /// Refuses `kinetic = …` and `force: …`.
    pub fn no_sign_behind(&mut self, word: &str) -> Parsed<()> {
        if !self.at_symbol("=") && !self.at_symbol(":") {
            return Ok(());
        }
        let message = format!("nothing stands between `{word}` and its formula");
        let error = Diagnostic::error(self.span(), message);
        Err(self.fail(error.help(REMOVE)))
    }

    fn force(&mut self) -> Parsed<ItemKind> {
        self.no_sign_behind("force")?;
        let force = self.expression()?;
        if self.at_symbol("=") {
            let error = Diagnostic::error(self.span(), "a force has no name");
            let help =
                "write `force -k*x on x;`; a name for its formula is written `let F = -k*x;`";
            return Err(self.fail(error.help(help)));
        }
        if !self.take_word("on") {
            self.comparison_stands_after_if()?;
            let preposition = match &self.peek_at(1).kind {
                TokenKind::Word(word) => word != "on",
                _ => false,
            };
            let help = self.number_in_front(false).filter(|_| !preposition);
            let help = help.unwrap_or_else(|| example("force"));
            return Err(self.unexpected("`on` and what the force works on", &help));
        }
        let on = self.expression()?;
        Ok(ItemKind::Force { force, on })
    }

    fn draw(&mut self) -> Parsed<ItemKind> {
        let help = "write `draw line(p, q);`, `draw circle(p, r);`, `draw polygon(p, q, s);` or `draw trace(p);`";
        let shape = SHAPES.iter().find(|(word, _)| self.at_word(word));
        let Some((_, shape)) = shape.copied() else {
            return Err(self.unexpected("`line`, `circle`, `polygon` or `trace`", help));
        };
        self.advance();
        self.expect_symbol("(", help)?;
        let arguments = self.arguments(")")?;
        Ok(ItemKind::Draw { shape, arguments })
    }
}

/// Whether a statement has statements or entries inside.
fn is_block(item: &Item) -> bool {
    matches!(
        item.kind,
        ItemKind::For(..) | ItemKind::Start(_) | ItemKind::Part(_)
    )
}
