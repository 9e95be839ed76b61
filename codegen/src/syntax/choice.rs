//! Choices and the comparisons in them, and operators that there are not.

use super::ast::{Condition, Expr, ExprKind};
use super::cursor::{Cursor, Parsed};
use super::messages::{AND, CHOICE, FORMULA};
use super::token::TokenKind;
use crate::diagnostic::Diagnostic;
use crate::expr::Comparison;

/// Operators of other languages, and what is written instead.
const ELSEWHERE: [(&str, &str); 5] = [
    ("&&", AND),
    (
        "||",
        "conditions are joined with `or`: `if a < b or c < d then x else y`",
    ),
    ("&", AND),
    (
        "|",
        "the size of a number is `abs(x)`, that of a vector `norm(v)`",
    ),
    (
        "%",
        "there is no remainder; angles may grow beyond a turn; comments begin with `//`",
    ),
];

impl Cursor<'_> {
    /// Reads `if condition then a else b`.
    pub fn choice(&mut self) -> Parsed<Expr> {
        let help = CHOICE;
        let start = self.span();
        self.advance();
        let condition = self.condition(help)?;
        if !self.take_word("then") {
            let help = match self.at_symbol("<") || self.at_symbol("<=") {
                true => AND,
                false => help,
            };
            return Err(self.unexpected("`then`", help));
        }
        if self.at_symbol("{") {
            return Err(self.unexpected(FORMULA, help));
        }
        let then = self.expression()?;
        if !self.take_word("else") {
            return Err(self.unexpected("`else`", help));
        }
        let otherwise = self.expression()?;
        let span = start.to(otherwise.span);
        let parts = (Box::new(condition), Box::new(then), Box::new(otherwise));
        Ok(Expr {
            span,
            kind: ExprKind::If(parts.0, parts.1, parts.2),
        })
    }

    /// Reads a condition: from loose to tight `or`, `and`, `not`, a comparison.
    fn condition(&mut self, help: &str) -> Parsed<Condition> {
        let mut condition = self.conjunction(help)?;
        while self.take_word("or") {
            let other = self.conjunction(help)?;
            condition = Condition::Or(Box::new(condition), Box::new(other));
        }
        Ok(condition)
    }

    fn conjunction(&mut self, help: &str) -> Parsed<Condition> {
        let mut condition = self.negation(help)?;
        while self.take_word("and") {
            let other = self.negation(help)?;
            condition = Condition::And(Box::new(condition), Box::new(other));
        }
        Ok(condition)
    }

    /// Reads `not a`, a condition in parentheses, or a comparison. A quantity may be called
    /// `not`: then an operator follows.
    fn negation(&mut self, help: &str) -> Parsed<Condition> {
        let operand = match self.peek_at(1).kind {
            TokenKind::Word(_) | TokenKind::Number(_) => true,
            TokenKind::Symbol(sign) => sign == "(",
            TokenKind::Text(_) | TokenKind::End => false,
        };
        if self.at_word("not") && operand {
            self.advance();
            let inside = self.deeper(|cursor| cursor.negation(help))?;
            return Ok(Condition::Not(Box::new(inside)));
        }
        if !self.parentheses_hold_a_condition() {
            return self.comparison(help);
        }
        self.advance();
        let condition = self.deeper(|cursor| cursor.condition(help))?;
        self.expect_symbol(")", help)?;
        Ok(condition)
    }

    fn comparison(&mut self, help: &str) -> Parsed<Condition> {
        let left = self.expression()?;
        let operator = self.peek().clone();
        let (comparison, exchanged) = match operator.kind {
            TokenKind::Symbol("<") => (Comparison::Less, false),
            TokenKind::Symbol("<=") => (Comparison::LessEqual, false),
            TokenKind::Symbol(">") => (Comparison::Less, true),
            TokenKind::Symbol(">=") => (Comparison::LessEqual, true),
            TokenKind::Symbol("==") => (Comparison::Equal, false),
            TokenKind::Symbol("!=") => (Comparison::NotEqual, false),
            TokenKind::Symbol("=") => {
                let error = Diagnostic::error(operator.span, "`=` does not compare");
                return Err(self.fail(error.help("write `==`")));
            }
            _ => {
                return Err(
                    self.unexpected("a comparison: `<`, `<=`, `>`, `>=`, `==` or `!=`", help)
                );
            }
        };
        self.advance();
        let right = self.expression()?;
        self.no_foreign_operator()?;
        let sides = match exchanged {
            true => [right, left],
            false => [left, right],
        };
        Ok(Condition::Compare(comparison, Box::new(sides)))
    }

    /// Refuses a comparison where a formula has ended.
    pub fn comparison_stands_after_if(&mut self) -> Parsed<()> {
        let there = ["<", "<=", ">", ">=", "==", "!="]
            .iter()
            .any(|sign| self.at_symbol(sign));
        if !there {
            return Ok(());
        }
        let error = Diagnostic::error(self.span(), "a comparison stands only behind `if`");
        Err(self.fail(error.help("write `if a < b then x else y`, or `=` for an equation")))
    }

    /// Refuses an operator of another language where a formula has ended.
    pub fn no_foreign_operator(&mut self) -> Parsed<()> {
        let Some((sign, help)) = ELSEWHERE.iter().find(|(sign, _)| self.at_symbol(sign)) else {
            return Ok(());
        };
        let message = format!("`{sign}` is not an operator");
        Err(self.fail(Diagnostic::error(self.span(), message).help(*help)))
    }
}
