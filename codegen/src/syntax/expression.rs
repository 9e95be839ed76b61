//! Formulas, by climbing the precedence of operators.
//!
//! From loose to tight: `if … then … else …`; `+ -`; `* /`; the sign; `^`, from
//! right to left; `.x`, `[i]`. A sign binds less tightly than a power and more
//! tightly than a product: `-x^2 = -(x^2)`, `2^-1 = 1/2`.

use super::ast::{Expr, ExprKind, Name, Range};
use super::beside::place_of;
use super::cursor::{Cursor, Parsed};
use super::keyword::{CONNECTIVES, DIRECTIONS, takes_one};
use super::literal::read_number;
use super::messages::{
    AXIS, COMPONENT, FORMULA, NAME_INSIDE, NO_DOUBLE_STAR, NO_ELEMENTS, NUMBERS, POINT,
};
use super::scan::NESTING;
use super::token::TokenKind;
use crate::diagnostic::{Diagnostic, Span};

impl Cursor<'_> {
    /// Reads a formula.
    pub fn expression(&mut self) -> Parsed<Expr> {
        self.deeper(Self::sum)
    }

    fn sum(&mut self) -> Parsed<Expr> {
        let first = self.product()?;
        let mut terms = vec![(false, first)];
        while self.at_symbol("+") || self.at_symbol("-") {
            let minus = self.advance().kind == TokenKind::Symbol("-");
            terms.push((minus, self.product()?));
        }
        Ok(list(terms, ExprKind::Sum))
    }

    fn product(&mut self) -> Parsed<Expr> {
        let first = self.signed()?;
        let mut factors = vec![(false, first)];
        loop {
            if self.at_symbol("**") {
                let error = Diagnostic::error(self.span(), NO_DOUBLE_STAR);
                return Err(self.fail(error.help("a power is written `x^2`")));
            }
            if !self.at_symbol("*") && !self.at_symbol("/") {
                return Ok(list(factors, ExprKind::Product));
            }
            let over = self.advance().kind == TokenKind::Symbol("/");
            factors.push((over, self.signed()?));
        }
    }

    fn signed(&mut self) -> Parsed<Expr> {
        let start = self.span();
        if self.take_symbol("-") {
            let inside = self.deeper(Self::signed)?;
            let span = start.to(inside.span);
            return Ok(Expr {
                span,
                kind: ExprKind::Negative(Box::new(inside)),
            });
        }
        if self.take_symbol("+") {
            return self.deeper(Self::signed);
        }
        self.power()
    }

    fn power(&mut self) -> Parsed<Expr> {
        let base = self.postfix()?;
        if !self.take_symbol("^") {
            return Ok(base);
        }
        self.no_power_of_a_function(&base)?;
        let exponent = self.deeper(Self::signed)?;
        let span = base.span.to(exponent.span);
        Ok(Expr {
            span,
            kind: ExprKind::Power(Box::new(base), Box::new(exponent)),
        })
    }

    /// Refuses `sin^2(q)`.
    fn no_power_of_a_function(&mut self, base: &Expr) -> Parsed<()> {
        let ExprKind::Name(name) = &base.kind else {
            return Ok(());
        };
        let known = takes_one(name);
        let open = TokenKind::Symbol("(");
        let [exponent, next] = [self.peek(), self.peek_at(1)];
        if !known || next.kind != open || !matches!(exponent.kind, TokenKind::Number(_)) {
            return Ok(());
        }
        let span = base.span.to(exponent.span);
        let power = exponent.span.text(self.source).to_string();
        self.advance();
        let argument = self
            .parenthesis()
            .map(|e| e.span.text(self.source).to_string())?;
        let error = Diagnostic::error(
            span,
            "a power can't stand between a function and its argument",
        );
        let help = match name.as_str() {
            "norm" if power == "2" => format!("write `norm2{argument}`"),
            _ => format!("write `{name}{argument}^{power}`"),
        };
        Err(self.fail(error.help(help)))
    }

    /// Reads a formula without operators: a name, a component, a call.
    pub fn postfix(&mut self) -> Parsed<Expr> {
        let mut value = self.atom()?;
        for _ in 0..NESTING {
            if self.at_symbol(".") && self.at_member(&value) {
                self.advance();
                let name = self.expect_name("a name", "")?;
                let span = value.span.to(name.span);
                value = Expr {
                    span,
                    kind: ExprKind::Member(Box::new(value), name),
                };
            } else if self.take_symbol(".") {
                let axis = self.axis()?;
                let span = value.span.to(self.last_span());
                value = Expr {
                    span,
                    kind: ExprKind::Component(Box::new(value), axis),
                };
            } else if self.at_symbol("[") && matches!(value.kind, ExprKind::Number(_)) {
                let error = Diagnostic::error(self.span(), NO_ELEMENTS);
                let help = "a unit goes behind `:`, for example `param m: kg = 1;`";
                return Err(self.fail(error.help(help)));
            } else if self.take_symbol("[") {
                let index = self.expression()?;
                let help = match self.at_symbol(",") {
                    true => {
                        "an index is written `R[0][1]`; a vector stands behind `,` or an operator"
                    }
                    false => "an index is written `theta[0]` or `R[0][1]`",
                };
                self.expect_symbol("]", help)?;
                let span = value.span.to(self.last_span());
                value = Expr {
                    span,
                    kind: ExprKind::Index(Box::new(value), Box::new(index)),
                };
            } else {
                return Ok(value);
            }
        }
        let error = Diagnostic::error(self.span(), "too many components and indices in a row");
        Err(self.fail(error.help(NAME_INSIDE)))
    }

    /// Whether behind the dot that comes next stands a name in a part.
    fn at_member(&self, inside: &Expr) -> bool {
        let of_a_name = matches!(
            inside.kind,
            ExprKind::Name(_) | ExprKind::Index(..) | ExprKind::Member(..)
        );
        match &self.peek_at(1).kind {
            TokenKind::Word(word) => of_a_name && !["x", "y", "z"].contains(&word.as_str()),
            _ => false,
        }
    }

    fn axis(&mut self) -> Parsed<usize> {
        let axis = ["x", "y", "z"].iter().position(|axis| self.at_word(axis));
        let Some(axis) = axis else {
            if let Some(error) = self.broken_number() {
                return Err(self.fail(error));
            }
            if ["*", "/", "^"].iter().any(|sign| self.at_symbol(sign)) {
                let dotted = self.last_span().to(self.span());
                let message = format!("`{}` is not an operator", dotted.text(self.source));
                let help = "operators stand without a dot, between numbers: `x^2`, `x*y`";
                return Err(self.fail(Diagnostic::error(dotted, message).help(help)));
            }
            return Err(self.unexpected(AXIS, COMPONENT));
        };
        self.advance();
        Ok(axis)
    }

    /// `2.e3` and `1.5.2`, in which the dot belongs to a number.
    fn broken_number(&self) -> Option<Diagnostic> {
        let before = self.behind(2);
        let digits = matches!(before.kind, TokenKind::Number(_));
        let next = self.peek();
        let touching =
            before.span.end == self.last_span().start && next.span.start == self.last_span().end;
        let goes_on = match &next.kind {
            TokenKind::Number(_) => true,
            TokenKind::Word(word) => word.starts_with(['e', 'E']),
            _ => false,
        };
        (digits && touching && goes_on).then(|| {
            let span = before.span.to(next.span);
            let message = format!("`{}` is not a number", span.text(self.source));
            Diagnostic::error(span, message).help(NUMBERS)
        })
    }

    fn atom(&mut self) -> Parsed<Expr> {
        let token = self.peek().clone();
        match token.kind {
            TokenKind::Number(text) => self.number(&text, token.span),
            TokenKind::Text(text) => {
                self.advance();
                Ok(Expr {
                    span: token.span,
                    kind: ExprKind::Text(text),
                })
            }
            TokenKind::Word(word) if word == "if" => self.deeper(Self::choice),
            TokenKind::Word(word)
                if ["then", "else", "in", "on", "for"].contains(&word.as_str()) =>
            {
                let place = place_of(&word).unwrap_or_default();
                Err(self.unexpected(FORMULA, &format!("`{word}` is no name: {place}")))
            }
            TokenKind::Word(word) => self.name_or_call(word, token.span),
            TokenKind::Symbol("(") => self.parenthesis(),
            TokenKind::Symbol("[") => self.vector(),
            TokenKind::Symbol(".") => self.dot(token.span),
            TokenKind::Symbol("{") => Err(self.unexpected(FORMULA, POINT)),
            TokenKind::Symbol("|") => {
                Err(self.unexpected(FORMULA, "a size is written `abs(x)` or `norm(v)`"))
            }
            _ => Err(self.unexpected(FORMULA, "")),
        }
    }

    fn dot(&mut self, span: Span) -> Parsed<Expr> {
        let TokenKind::Number(digits) = &self.peek_at(1).kind else {
            return Err(self.unexpected(FORMULA, ""));
        };
        let help = format!("write `0.{digits}`");
        let error = Diagnostic::error(span, "a number can't begin with a dot");
        Err(self.fail(error.help(help)))
    }

    fn number(&mut self, text: &str, span: Span) -> Parsed<Expr> {
        match read_number(text, span) {
            Ok(number) => {
                self.advance();
                Ok(Expr {
                    span,
                    kind: ExprKind::Number(number),
                })
            }
            Err(diagnostic) => Err(self.fail(*diagnostic)),
        }
    }

    fn name_or_call(&mut self, word: String, span: Span) -> Parsed<Expr> {
        self.advance();
        if !self.take_symbol("(") {
            return Ok(Expr {
                span,
                kind: ExprKind::Name(word),
            });
        }
        if word == "sum" {
            return self.repeated_sum(span);
        }
        let arguments = self.arguments(")")?;
        let name = Name { text: word, span };
        Ok(Expr {
            span: span.to(self.last_span()),
            kind: ExprKind::Call(name, arguments),
        })
    }

    fn repeated_sum(&mut self, start: Span) -> Parsed<Expr> {
        let help = "a sum is written `sum(i in 0..K, x[i])`";
        let range = self.range(help)?;
        self.expect_symbol(",", help)?;
        let term = self.expression()?;
        self.expect_symbol(")", help)?;
        let span = start.to(self.last_span());
        Ok(Expr {
            span,
            kind: ExprKind::Repeat(Box::new(range), Box::new(term)),
        })
    }

    /// Reads `index in from..to`.
    pub fn range(&mut self, help: &str) -> Parsed<Range> {
        let index = self.expect_name("the name of an index", help)?;
        if !self.take_word("in") {
            return Err(self.unexpected("`in`", help));
        }
        let from = self.expression()?;
        self.expect_symbol("..", help)?;
        if self.at_symbol("=") {
            let error = Diagnostic::error(self.span(), "`..=` is not used here");
            let help = "a range `0..K` ends before K; write `0..K+1` to include it";
            return Err(self.fail(error.help(help)));
        }
        if self.at_symbol(".") {
            return Err(self.unexpected("a bound", "a range is written with two dots: `0..K`"));
        }
        let to = self.expression()?;
        Ok(Range { index, from, to })
    }

    /// Reads formulas with commas between them, up to a closing bracket.
    pub fn arguments(&mut self, close: &'static str) -> Parsed<Vec<Expr>> {
        let mut arguments = Vec::new();
        while !self.take_symbol(close) {
            arguments.push(self.expression()?);
            if !self.at_symbol(close) {
                self.comparison_stands_after_if()?;
                let help = self.number_in_front(close == "]");
                let separated =
                    format!("formulas are separated by `,`, at the end stands `{close}`");
                let product = || Some(format!("{}; {separated}", self.operator_missing()?));
                let help = help.or_else(product).unwrap_or(separated);
                self.expect_symbol(",", &help)?;
            }
        }
        Ok(arguments)
    }

    fn parenthesis(&mut self) -> Parsed<Expr> {
        let start = self.span();
        self.advance();
        let inside = self.expression()?;
        if self.at_symbol(",") {
            let error = Diagnostic::error(self.span(), "parentheses hold one formula");
            return Err(self.fail(error.help(POINT)));
        }
        self.comparison_stands_after_if()?;
        let help = self.number_in_front(false);
        let help = help.or_else(|| self.operator_missing()).unwrap_or_default();
        self.expect_symbol(")", &help)?;
        Ok(Expr {
            span: start.to(self.last_span()),
            kind: inside.kind,
        })
    }

    fn vector(&mut self) -> Parsed<Expr> {
        let start = self.span();
        self.advance();
        let parts = self.arguments("]")?;
        let vector = Expr {
            span: start.to(self.last_span()),
            kind: ExprKind::Vector(parts),
        };
        if !self.at_unit_behind() {
            return Ok(vector);
        }
        let unit = self.unit()?;
        Ok(Expr {
            span: start.to(self.last_span()),
            kind: ExprKind::InUnit(Box::new(vector), unit),
        })
    }

    /// Whether a unit stands behind the vector that was read last: a word on its line
    /// that holds no statement together.
    fn at_unit_behind(&self) -> bool {
        let TokenKind::Word(word) = &self.peek().kind else {
            return false;
        };
        let here = self.span().start.line == self.last_span().end.line;
        let directs = DIRECTIONS.iter().any(|(direction, _)| direction == word);
        let connects = CONNECTIVES.contains(&word.as_str());
        here && !directs && !connects && !self.at_statement()
    }
}

/// Makes a sum or product, unless it has one part.
fn list(mut parts: Vec<(bool, Expr)>, kind: fn(Vec<(bool, Expr)>) -> ExprKind) -> Expr {
    if parts.len() == 1
        && let Some((_, only)) = parts.pop()
    {
        return only;
    }
    let first = parts.first().map(|(_, part)| part.span).unwrap_or_default();
    let last = parts.last().map(|(_, part)| part.span).unwrap_or_default();
    Expr {
        span: first.to(last),
        kind: kind(parts),
    }
}
