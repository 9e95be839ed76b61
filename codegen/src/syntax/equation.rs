//! Equations that hold always, and formulas that pass zero at an instant.

use super::ast::{Expr, ExprKind, ItemKind, Name};
use super::cursor::{Cursor, Parsed};
use super::keyword::{DIRECTIONS, example};
use super::messages::NO_ASSIGNMENT;
use super::token::TokenKind;
use crate::diagnostic::{Diagnostic, Span};

impl Cursor<'_> {
    /// Reads what stands behind `constraint`.
    pub fn constraint(&mut self) -> Parsed<ItemKind> {
        let named = self.peek_at(1).kind == TokenKind::Symbol(":");
        let name = match named {
            true => Some(self.name("the constraint", "constraint")?),
            false => None,
        };
        if !named {
            self.no_sign_behind("constraint")?;
        } else {
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
        if self.at_symbol(";") {
            let equation = one_line(left.span.text(self.source));
            let help = format!("an equation has two sides: `constraint {equation} = 0;`");
            return Err(self.unexpected("`=`", &help));
        }
        let help = self.operator_missing();
        self.expect_symbol("=", &help.unwrap_or_else(|| example("constraint")))?;
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

    /// Reads the sign of an inequality, if one comes next: where it is, and whether what
    /// stands behind it is an upper bound.
    fn take_inequality(&mut self) -> Option<(Span, bool)> {
        let signs = [("<", true), ("<=", true), (">", false), (">=", false)];
        let (_, upper) = signs.into_iter().find(|(sign, _)| self.at_symbol(sign))?;
        let place = self.span();
        self.advance();
        Some((place, upper))
    }

    /// Refuses an inequality, which no constraint is.
    fn no_inequality(&mut self, left: &Expr) -> Parsed<()> {
        let Some((place, upper)) = self.take_inequality() else {
            return Ok(());
        };
        let right = self.expression()?;
        // `0 < x` is `x > 0`.
        let number = matches!(left.kind, ExprKind::Number(_));
        let (left, right, upper) = match number {
            true => (&right, left, !upper),
            false => (left, &right, upper),
        };
        let x = one_line(left.span.text(self.source));
        let bound = one_line(right.span.text(self.source));
        let less = self.difference(left, right);
        let beyond = if upper { ">" } else { "<" };
        let error = Diagnostic::error(place, "a constraint is an equation");
        let help = format!(
            "what stops a motion is a force, such as \
             `force if {x} {beyond} {bound} then -k*({less}) else 0 on {x};`; \
             `event e: {less} crossing;` finds the instant"
        );
        Err(self.fail(error.help(help)))
    }

    /// Reads what stands behind `event`.
    pub fn event(&mut self) -> Parsed<ItemKind> {
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
            self.no_comparison(&name, &value)?;
            return Err(self.unexpected("`rising`, `falling` or `crossing`", &example("event")));
        };
        self.advance();
        Ok(ItemKind::Event {
            name,
            value,
            direction,
        })
    }

    /// Refuses a comparison, which no event is.
    fn no_comparison(&mut self, name: &Name, value: &Expr) -> Parsed<()> {
        let Some((place, upper)) = self.take_inequality() else {
            return Ok(());
        };
        let bound = self.expression()?;
        let error = Diagnostic::error(
            place,
            "an event is a formula that passes zero, no comparison",
        );
        let (name, less) = (&name.text, self.difference(value, &bound));
        let direction = if upper { "falling" } else { "rising" };
        Err(self.fail(error.help(format!("write `event {name}: {less} {direction};`"))))
    }

    /// What one formula is more than another, as text.
    fn difference(&self, one: &Expr, other: &Expr) -> String {
        let [x, bound] = [one, other].map(|e| one_line(e.span.text(self.source)));
        match other.kind {
            ExprKind::Number(number) if number.is_zero() => x,
            ExprKind::Sum(_) | ExprKind::Negative(_) => format!("{x} - ({bound})"),
            _ => format!("{x} - {bound}"),
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
