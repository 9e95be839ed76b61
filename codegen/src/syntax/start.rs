//! The `start` block: values that are held, guesses, and `for` over them.

use super::ast::{Expr, ExprKind, StartItem};
use super::beside::holds_together;
use super::cursor::{Cursor, Parsed};
use super::keyword::example;
use super::messages::{FOR, NO_ASSIGNMENT, NO_UNIT_BEHIND};
use super::token::TokenKind;
use crate::diagnostic::Diagnostic;

const HELP: &str = "an entry is written `q1 = 45*deg;` (held) or `q2 ~ 0.7;` (a guess)";

impl Cursor<'_> {
    /// Reads `{ entries }`.
    pub fn start_block(&mut self) -> Parsed<Vec<StartItem>> {
        let is_entry = matches!(self.peek().kind, TokenKind::Word(_));
        if is_entry && !self.at_next_statement() {
            let _reported = self.unexpected("`{`", &example("start"));
            return Ok(self.unopened());
        }
        self.expect_symbol("{", &example("start"))?;
        let depth = self.block_depth();
        let mut items = Vec::new();
        while self.next_in_block(depth, "an entry", HELP) {
            let is_block = |item: &StartItem| matches!(item, StartItem::For(..));
            items.extend(self.statement(depth, Self::start_item, is_block));
        }
        self.expect_symbol("}", "")?;
        Ok(items)
    }

    /// Reads the entries of a block without its braces, so that they are not taken for
    /// statements.
    fn unopened(&mut self) -> Vec<StartItem> {
        let (depth, mut items) = (self.depth(), Vec::new());
        let ends = |cursor: &Self| {
            cursor.at_statement() || cursor.at_symbol("}") || cursor.peek().kind == TokenKind::End
        };
        while !ends(self) {
            items.extend(self.statement(depth, Self::start_item, |_| false));
        }
        items
    }

    fn start_item(&mut self) -> Parsed<StartItem> {
        if self.take_word("for") {
            let range = self.range(FOR)?;
            let items = self.deeper(Self::start_block)?;
            return Ok(StartItem::For(range, items));
        }
        let target = self.expression()?;
        let held = self.at_symbol("=");
        if !held && !self.at_symbol("~") {
            if self.at_symbol(":") && self.peek_at(1).kind == TokenKind::Symbol("=") {
                let error = Diagnostic::error(self.span(), NO_ASSIGNMENT);
                return Err(self.fail(error.help(HELP)));
            }
            let help = match self.at_symbol("(") {
                true => "all these values are at the beginning: `der(q1) = 2;`",
                false => HELP,
            };
            return Err(self.unexpected("`=` or `~`", help));
        }
        self.advance();
        let value = self.expression()?;
        if !self.at_symbol("}") {
            self.no_unit_behind_value(&value)?;
            self.no_decimal_comma()?;
            self.expect_symbol(";", HELP)?;
        }
        Ok(StartItem::Entry {
            target,
            held,
            value,
        })
    }

    /// Refuses a unit behind the number that a start value is.
    fn no_unit_behind_value(&mut self, value: &Expr) -> Parsed<()> {
        let next = self.peek();
        // What begins the next entry is no unit.
        let next_entry = ["=", "~", "(", "[", "."]
            .iter()
            .any(|sign| self.peek_at(1).kind == TokenKind::Symbol(sign));
        let same_line = next.span.start.line == value.span.end.line && !next_entry;
        let same_line = same_line && !holds_together(next.span.text(self.source));
        let (TokenKind::Word(unit), ExprKind::Number(_), true) =
            (next.kind.clone(), &value.kind, same_line)
        else {
            return Ok(());
        };
        let number = value.span.text(self.source);
        let help = match unit.as_str() {
            "deg" => format!("write `{number}*deg`"),
            _ => format!("values are in SI units and have none behind them: write `{number}`"),
        };
        let error = Diagnostic::error(self.span(), NO_UNIT_BEHIND);
        Err(self.fail(error.help(help)))
    }
}
