//! Words and numbers beside one another, where something is missing between them.
//!
//! In:  the token that was read last, and the one that follows it.
//! Out: what to write instead.

use super::ast::{Declaration, ExprKind, ItemKind};
use super::cursor::{Cursor, Parsed};
use super::keyword::{
    CONNECTIVES, DIRECTIONS, RESERVED, STATEMENTS, Statement, example, takes_one,
};
use super::messages::{CHOICE, FOR, NO_UNIT_BEHIND};
use super::token::{Token, TokenKind};
use crate::diagnostic::Diagnostic;

/// What joins conditions.
const JOINED: &str = "`and`, `or` and `not` stand in conditions: `if a < b and not c < d then x \
                      else y`";

/// The longest unit that is repeated in a message, in bytes.
const LONGEST_UNIT: usize = 40;

/// Whether a word has a meaning between or behind formulas, so that it is probably neither a
/// quantity nor a unit.
pub fn holds_together(word: &str) -> bool {
    RESERVED.contains(&word)
        || CONNECTIVES.contains(&word)
        || DIRECTIONS.iter().any(|(direction, _)| *direction == word)
        || Statement::of(word).is_some()
}

/// Where a word belongs that holds formulas together.
pub fn place_of(word: &str) -> Option<String> {
    if DIRECTIONS.iter().any(|(direction, _)| *direction == word) {
        return Some(format!(
            "`{word}` ends an event: `event top: q1 - pi/2 {word};`"
        ));
    }
    Some(match word {
        "if" | "then" | "else" => CHOICE.to_string(),
        "and" | "or" | "not" => JOINED.to_string(),
        "in" | "for" => FOR.to_string(),
        "on" => "a force is written `force u on q1;`".to_string(),
        _ => return None,
    })
}

impl Cursor<'_> {
    /// Reads the `;`. What is missing is rather an operator if a formula goes on.
    pub fn end_of_statement(&mut self, word: &str, kind: &ItemKind) -> Parsed<()> {
        if self.take_symbol(";") {
            return Ok(());
        }
        if let ItemKind::Declaration(declaration) = kind {
            self.no_unit_behind(word, declaration)?;
        }
        self.comparison_stands_after_if()?;
        self.no_decimal_comma()?;
        if !self.at_next_statement()
            && !matches!(word, "coord" | "state")
            && let Some(help) = self.operator_missing()
        {
            let number = matches!(self.behind(1).kind, TokenKind::Number(_));
            let word_alone = number
                && self.peek_at(1).kind == TokenKind::Symbol(";")
                && !holds_together(self.span().text(self.source));
            let help = match kind {
                ItemKind::Declaration(d) if d.unit.is_none() && word_alone => {
                    let name = &d.name.text;
                    format!("{help}; a unit goes behind the name: `{word} {name}: m = …;`")
                }
                _ => help,
            };
            return Err(self.unexpected("an operator or `;`", &help));
        }
        self.no_foreign_operator()?;
        if word == "constraint" && self.at_symbol("=") {
            return Err(self.unexpected("`;`", "an equation has two sides; write two equations"));
        }
        Err(self.unexpected("`;`", &example(word)))
    }

    /// Whether what comes next stands on a line of its own, or begins a statement.
    pub fn at_next_statement(&self) -> bool {
        let below = self.span().start.line > self.last_span().end.line;
        below || STATEMENTS.iter().any(|(word, ..)| self.at_word(word))
    }

    /// Refuses a unit behind a number: `param m = 1 kg;`.
    fn no_unit_behind(&mut self, word: &str, declaration: &Declaration) -> Parsed<()> {
        let number = matches!(declaration.value.kind, ExprKind::Number(_));
        let TokenKind::Word(first) = self.peek().kind.clone() else {
            return Ok(());
        };
        let unit = Some(self.rest_of_statement()).filter(|unit| unit.len() <= LONGEST_UNIT);
        let unit = unit.unwrap_or_else(|| first.clone());
        let declared = declaration.unit.as_ref();
        let called = self.peek_at(1).kind == TokenKind::Symbol("(");
        let other = self.at_next_statement() || holds_together(&first) || called;
        if !number || other || declared.is_some_and(|declared| declared.text != unit) {
            return Ok(());
        }
        let error = Diagnostic::error(self.span(), NO_UNIT_BEHIND);
        let (name, value) = (&declaration.name.text, declaration.value.span);
        let value = value.text(self.source);
        let help = match first.as_str() {
            "deg" => format!("write `{value}*{unit}`"),
            _ => format!(
                "the unit goes behind `:`: `{word} {name}: {unit} = {value};`; a product is \
                 written `{value}*{unit}`"
            ),
        };
        Err(self.fail(error.help(help)))
    }

    /// The text on this line up to the end of the statement, without blanks.
    fn rest_of_statement(&self) -> String {
        let line = self.span().start.line;
        let tokens = (0..).map(|ahead| self.peek_at(ahead));
        let tokens = tokens.take_while(|token| {
            let end = token.kind == TokenKind::End || token.kind == TokenKind::Symbol(";");
            !end && token.span.start.line == line
        });
        tokens.map(|token| token.span.text(self.source)).collect()
    }

    /// Refuses `1,5`.
    pub fn no_decimal_comma(&mut self) -> Parsed<()> {
        let (before, behind) = (self.behind(1), self.peek_at(1));
        let number = |token: &Token| matches!(token.kind, TokenKind::Number(_));
        if !self.at_symbol(",") || !number(before) || !number(behind) {
            return Ok(());
        }
        let [whole, part] = [before, behind].map(|token| token.span.text(self.source));
        let help = format!("write `{}.{part}`", whole.replace('.', ""));
        let place = before.span.to(behind.span);
        let error = Diagnostic::error(place, "a number has a point, no comma");
        Err(self.fail(error.help(help)))
    }

    /// What to write where a word, a number or a parenthesis follows another on the same
    /// line; nothing where something else follows.
    pub fn operator_missing(&self) -> Option<String> {
        let (before, next) = (self.behind(1), self.peek());
        let opens = match &next.kind {
            TokenKind::Word(_) | TokenKind::Number(_) => false,
            TokenKind::Symbol("(") => true,
            _ => return None,
        };
        if next.span.start.line > before.span.end.line {
            return None;
        }
        let [left, right] = [before, next].map(|token| token.span.text(self.source));
        let direction = |word: &str| DIRECTIONS.iter().any(|(known, _)| *known == word);
        if direction(left) {
            return Some(match direction(right) {
                true => "an event has one direction: `crossing` is both".to_string(),
                false => example("event"),
            });
        }
        if let Some(help) = [right, left].into_iter().find_map(place_of) {
            return Some(help);
        }
        if takes_one(left) {
            let whole = self.peek_at(1);
            let goes_on = ["*", "/", "^", ".", "["];
            let goes_on = goes_on
                .iter()
                .any(|sign| whole.kind == TokenKind::Symbol(sign));
            return Some(match (opens, goes_on) {
                (true, _) => format!("nothing stands in front of a function: write `{left}(…)`"),
                (_, true) => format!("what a function is of stands in parentheses: `{left}(…)`"),
                (_, false) => format!("write `{left}({right})`"),
            });
        }
        let left = if left == ")" { "(…)" } else { left };
        let called = self.peek_at(1).kind == TokenKind::Symbol("(");
        let right = match (opens, called) {
            (true, _) => "(…)".to_string(),
            (false, true) => format!("{right}(…)"),
            (false, false) => right.to_string(),
        };
        Some(format!("a product is written with `*`: `{left}*{right}`"))
    }

    /// What to write where a word on the same line follows a number, instead of what was
    /// expected: in a vector, or elsewhere.
    pub fn number_in_front(&self, in_vector: bool) -> Option<String> {
        let TokenKind::Word(word) = &self.peek().kind else {
            return None;
        };
        let number = self.behind(1);
        let here = number.span.end.line == self.span().start.line;
        if !matches!(number.kind, TokenKind::Number(_)) || !here {
            return None;
        }
        if let Some(help) = place_of(word) {
            return Some(help);
        }
        // What has arguments is no unit.
        if self.peek_at(1).kind == TokenKind::Symbol("(") {
            return self.operator_missing();
        }
        let number = number.span.text(self.source);
        let unit = match in_vector {
            true => format!("stands behind the whole vector, `[…] {word}`"),
            false => format!("stands in a declaration, `const a: {word} = {number};`"),
        };
        let product = format!("a product is written `{number}*{word}`");
        Some(format!("{product}; a unit {unit}"))
    }
}
