//! Statements: the words that begin them, and the file around them.

use super::ast::{Declaration, Declared, Energy, Expr, ExprKind, Item, ItemKind, Let, Name, Size};
use super::cursor::{Cursor, Parsed};
use super::keyword::{DIRECTIONS, SHAPES, STATEMENTS, Statement};
use super::messages::{CHOICE, FOR, NO_ASSIGNMENT, NO_UNIT_BEHIND, REMOVE, did_you_mean};
use super::model::Model;
use super::token::TokenKind;
use crate::diagnostic::{Diagnostic, nearest};
use crate::expr::Function;

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
            return Err(self.unexpected("`mechanism`", &help));
        }
        let name = self.expect_name("the name of the mechanism", FILE)?;
        let mut model = Model::named(name, docs);
        self.block(FILE, |item| model.add(item))?;
        if self.peek().kind != TokenKind::End {
            let message = "nothing can follow the mechanism";
            let error = Diagnostic::error(self.span(), message);
            let help = match self.at_symbol(";") {
                true => REMOVE,
                false => "a file holds one mechanism; write another file",
            };
            let _reported = self.fail(error.help(help));
        }
        Ok(model)
    }

    /// Hands over the statements of a block.
    pub fn block(&mut self, help: &str, mut add: impl FnMut(Item)) -> Parsed<()> {
        self.expect_symbol("{", help)?;
        let depth = self.block_depth();
        while !self.at_block_end(depth) {
            if self.take_symbol(";") {
                continue;
            }
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

    /// Whether the bracket that closes a block comes next.
    pub fn at_block_end(&self, depth: usize) -> bool {
        self.peek().kind == TokenKind::End || (self.at_symbol("}") && self.depth() < depth)
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
            return Err(self.unexpected("a statement", &statement_help("")));
        };
        if !self.at_statement() && !self.at_rate() {
            let error = Diagnostic::error(start, format!("`{word}` does not begin a statement"));
            let help = match self.peek_at(1).kind {
                TokenKind::Symbol("=") => {
                    format!(
                        "a quantity is written `let {word} = …;`, an equation `constraint {word} = …;`"
                    )
                }
                _ => statement_help(&word),
            };
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
            Some(Statement::Kinetic) => ItemKind::Energy(Energy::Kinetic, self.expression()?),
            Some(Statement::Potential) => ItemKind::Energy(Energy::Potential, self.expression()?),
            Some(Statement::Dissipation) => {
                ItemKind::Energy(Energy::Dissipation, self.expression()?)
            }
            Some(Statement::Force) => self.force()?,
            Some(Statement::Constraint) => self.constraint()?,
            Some(Statement::Event) => self.event()?,
            Some(Statement::Draw) => self.draw()?,
        };
        self.end_of_statement(word, &kind)?;
        Ok(kind)
    }

    /// Reads the `;`. What is missing is rather an operator if a formula goes on.
    fn end_of_statement(&mut self, word: &str, kind: &ItemKind) -> Parsed<()> {
        if self.take_symbol(";") {
            return Ok(());
        }
        if let ItemKind::Declaration(declaration) = kind {
            self.no_unit_behind(word, declaration)?;
        }
        self.comparison_stands_after_if()?;
        let next = self.peek();
        let goes_on = match &next.kind {
            TokenKind::Word(_) | TokenKind::Number(_) => true,
            TokenKind::Symbol(symbol) => *symbol == "(",
            TokenKind::Text(_) | TokenKind::End => false,
        };
        if goes_on && !self.at_next_statement() && !matches!(word, "coord" | "state") {
            let [left, right] = [self.last_span(), next.span].map(|span| span.text(self.source));
            let left = if left == ")" { "(…)" } else { left };
            let right = if right == "(" { "(…)" } else { right };
            let help = match right {
                "if" => CHOICE.to_string(),
                _ if Function::ALL.iter().any(|(_, name)| *name == left) => {
                    format!("write `{left}({right})`")
                }
                _ => format!("a product is written with `*`: `{left}*{right}`"),
            };
            return Err(self.unexpected("an operator or `;`", &help));
        }
        self.no_foreign_operator()?;
        Err(self.unexpected("`;`", &example(word)))
    }

    /// Whether what comes next stands on a line of its own, or begins a statement.
    fn at_next_statement(&self) -> bool {
        let below = self.span().start.line > self.last_span().end.line;
        below || STATEMENTS.iter().any(|(word, ..)| self.at_word(word))
    }

    /// Refuses a unit behind a number: `param m = 1 kg;`.
    fn no_unit_behind(&mut self, word: &str, declaration: &Declaration) -> Parsed<()> {
        let number = matches!(declaration.value.kind, ExprKind::Number(_));
        let TokenKind::Word(unit) = self.peek().kind.clone() else {
            return Ok(());
        };
        let declared = declaration.unit.as_ref();
        let other = self.at_next_statement();
        if !number || other || declared.is_some_and(|declared| declared.text != unit) {
            return Ok(());
        }
        let error = Diagnostic::error(self.span(), NO_UNIT_BEHIND);
        let (name, value) = (&declaration.name.text, declaration.value.span);
        let value = value.text(self.source);
        let help = format!(
            "the unit goes behind `:`: `{word} {name}: {unit} = {value};`; a product is written \
             `{value}*{unit}`"
        );
        Err(self.fail(error.help(help)))
    }

    fn name(&mut self, what: &str, word: &str) -> Parsed<Name> {
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
        let size = self.size(&format!(
            "an array is written `{word} {}[3] = …;`",
            name.text
        ))?;
        self.one_name(&name, word, " = …")?;
        let unit = self.optional_unit()?;
        self.expect_symbol("=", &example(word))?;
        let value = self.expression()?;
        Ok(ItemKind::Declaration(Declaration {
            kind,
            name,
            size,
            unit,
            value,
        }))
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

    /// Whether `der(` comes next, which begins a statement only where one has to begin:
    /// lines of formulas may begin so, too.
    fn at_rate(&self) -> bool {
        self.at_word("der") && self.peek_at(1).kind == TokenKind::Symbol("(")
    }

    /// `der(state) = formula`
    fn rate(&mut self) -> Parsed<ItemKind> {
        let help = "the rate of a state is written `der(z) = goal - x;`";
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

    fn force(&mut self) -> Parsed<ItemKind> {
        let force = self.expression()?;
        if !self.take_word("on") {
            let help = self.number_in_front(false);
            let help = help.unwrap_or_else(|| example("force"));
            return Err(self.unexpected("`on` and what the force works on", &help));
        }
        let on = self.expression()?;
        Ok(ItemKind::Force { force, on })
    }

    fn constraint(&mut self) -> Parsed<ItemKind> {
        let named = self.peek_at(1).kind == TokenKind::Symbol(":");
        let name = match named {
            true => Some(self.name("the constraint", "constraint")?),
            false => None,
        };
        if named {
            self.expect_symbol(":", "")?;
            if self.at_symbol("=") {
                let error = Diagnostic::error(self.span(), NO_ASSIGNMENT);
                let help = "write `constraint a = b;`; in front of `:` stands a name";
                return Err(self.fail(error.help(help)));
            }
        }
        let left = self.expression()?;
        if self.at_symbol("==") {
            let error = Diagnostic::error(self.span(), "an equation is written with one `=`");
            return Err(self.fail(error.help(example("constraint"))));
        }
        self.no_inequality(&left)?;
        self.comparison_stands_after_if()?;
        self.expect_symbol("=", &example("constraint"))?;
        let right = self.expression()?;
        let equation = one_line(left.span.to(right.span).text(self.source));
        let text = match &name {
            Some(name) => format!("{}: {equation}", name.text),
            None => equation,
        };
        Ok(ItemKind::Constraint {
            name,
            left,
            right,
            text,
        })
    }

    /// Refuses an inequality, which no constraint is.
    fn no_inequality(&mut self, left: &Expr) -> Parsed<()> {
        let upper = self.at_symbol("<") || self.at_symbol("<=");
        if !upper && !self.at_symbol(">") && !self.at_symbol(">=") {
            return Ok(());
        }
        let place = self.span();
        self.advance();
        let right = self.expression()?;
        let x = one_line(left.span.text(self.source));
        let bound = one_line(right.span.text(self.source));
        let less = match right.kind {
            ExprKind::Sum(_) | ExprKind::Negative(_) => format!("{x} - ({bound})"),
            _ => format!("{x} - {bound}"),
        };
        let beyond = if upper { ">" } else { "<" };
        let error = Diagnostic::error(place, "a constraint is an equation");
        let help = format!(
            "what stops a motion is a force, such as \
             `force if {x} {beyond} {bound} then -k*({less}) else 0 on {x};`; \
             `event e: {less} crossing;` finds the instant"
        );
        Err(self.fail(error.help(help)))
    }

    fn event(&mut self) -> Parsed<ItemKind> {
        let name = self.name("the event", "event")?;
        self.expect_symbol(":", &example("event"))?;
        let value = self.expression()?;
        let direction = DIRECTIONS.iter().find(|(word, _)| self.at_word(word));
        let Some((_, direction)) = direction.copied() else {
            if self.at_symbol("=") {
                let message = "an event is a formula that passes zero, not an equation";
                let error = Diagnostic::error(self.span(), message);
                let name = &name.text;
                let help = format!("write `event {name}: a - b crossing;` for `a = b`");
                return Err(self.fail(error.help(help)));
            }
            return Err(self.unexpected("`rising`, `falling` or `crossing`", &example("event")));
        };
        self.advance();
        Ok(ItemKind::Event {
            name,
            value,
            direction,
        })
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

/// How a statement is written.
fn example(word: &str) -> String {
    let example = STATEMENTS.iter().find(|(known, ..)| *known == word);
    example.map_or(String::new(), |(_, _, text)| {
        format!("write for example `{text}`")
    })
}

/// What may begin a statement, or the word that was probably meant.
fn statement_help(word: &str) -> String {
    let words = STATEMENTS.iter().map(|(word, ..)| *word).chain(["for"]);
    match nearest(word, words.clone()) {
        Some(near) => did_you_mean(near),
        None => {
            let list: Vec<_> = words.collect();
            format!("a statement begins with one of: {}", list.join(", "))
        }
    }
}

/// A piece of source without comments and line breaks.
fn one_line(text: &str) -> String {
    let lines = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(""));
    lines
        .flat_map(str::split_whitespace)
        .collect::<Vec<_>>()
        .join(" ")
}
