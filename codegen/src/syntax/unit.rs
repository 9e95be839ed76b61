//! Units: products and quotients of names with whole exponents.

use super::ast::{Name, UnitExpr};
use super::beside::holds_together;
use super::cursor::{Cursor, Parsed};
use super::messages::{NO_ASSIGNMENT, NO_DOUBLE_STAR};
use super::scan;
use super::token::{TokenKind, tokenize};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// The largest exponent of a unit.
const LARGEST: i32 = 30;

const HELP: &str = "a unit is written like `m`, `rad`, `kg*m^2/s^2` or `1/s`";

type Factors = Vec<(Name, i32)>;

/// Reads a unit that stands by itself.
pub fn read(text: &str) -> Result<UnitExpr, Diagnostics> {
    scan::clean(text)?;
    let mut cursor = Cursor::new(text, tokenize(text)?);
    let unit = cursor.unit();
    if unit.is_ok() && cursor.peek().kind != TokenKind::End {
        let _reported = cursor.unexpected("the end of the unit", HELP);
    }
    match unit {
        Ok(unit) if cursor.diagnostics.is_empty() => Ok(unit),
        _ => Err(cursor.diagnostics),
    }
}

impl Cursor<'_> {
    /// Reads `: unit` if it comes next.
    pub fn optional_unit(&mut self) -> Parsed<Option<UnitExpr>> {
        if !self.take_symbol(":") {
            return Ok(None);
        }
        if self.at_symbol("=") && self.span().start == self.last_span().end {
            let error = Diagnostic::error(self.last_span().to(self.span()), NO_ASSIGNMENT);
            return Err(self.fail(error.help("write `=`; behind `:` stands a unit")));
        }
        let unit = self.unit()?;
        self.unit_goes_on(&unit)?;
        Ok(Some(unit))
    }

    /// Refuses `kg m^2` and `m/s-2`.
    fn unit_goes_on(&mut self, unit: &UnitExpr) -> Parsed<()> {
        let here = self.span().start.line == self.last_span().end.line;
        let next = self.peek_at(1).kind.clone();
        let unit = &unit.text;
        match (self.peek().kind.clone(), next) {
            (TokenKind::Word(other), next)
                if here
                    && !holds_together(&other)
                    && ![TokenKind::Symbol(":"), TokenKind::Symbol("(")].contains(&next) =>
            {
                let help = format!("a product of units is written `{unit}*{other}`");
                Err(self.unexpected("`*` or the end of the unit", &help))
            }
            (TokenKind::Symbol("-"), TokenKind::Number(power)) => {
                let help = format!("a power of a unit is written `{unit}^-{power}`");
                Err(self.unexpected("`^` or the end of the unit", &help))
            }
            (TokenKind::Symbol("."), TokenKind::Word(other)) => {
                let help = format!("a product of units is written `{unit}*{other}`");
                Err(self.unexpected("`*` or the end of the unit", &help))
            }
            (TokenKind::Symbol("**"), _) => {
                let error = Diagnostic::error(self.span(), NO_DOUBLE_STAR);
                Err(self.fail(error.help("a power of a unit is written `m^2`")))
            }
            _ => Ok(()),
        }
    }

    /// Reads a unit.
    pub fn unit(&mut self) -> Parsed<UnitExpr> {
        let start = self.span();
        let factors = self.unit_product()?;
        let span = start.to(self.last_span());
        let text = span
            .text(self.source)
            .chars()
            .filter(|c| !c.is_whitespace())
            .collect();
        Ok(UnitExpr {
            span,
            text,
            factors,
        })
    }

    fn unit_product(&mut self) -> Parsed<Factors> {
        let mut factors = self.unit_power()?;
        loop {
            let over = self.at_symbol("/");
            if !over && !self.at_symbol("*") {
                return Ok(factors);
            }
            self.advance();
            let sign = if over { -1 } else { 1 };
            let more = self.unit_power()?;
            factors.extend(
                more.into_iter()
                    .map(|(name, exponent)| (name, sign * exponent)),
            );
        }
    }

    fn unit_power(&mut self) -> Parsed<Factors> {
        let factors = self.deeper(Self::unit_atom)?;
        if !self.take_symbol("^") {
            return Ok(factors);
        }
        let start = self.span();
        let exponent = self.unit_exponent()?;
        let raised: Option<Factors> = factors
            .into_iter()
            .map(|(name, e)| {
                Some((
                    name,
                    e.checked_mul(exponent).filter(|e| e.abs() <= LARGEST)?,
                ))
            })
            .collect();
        raised.ok_or_else(|| {
            let span = start.to(self.last_span());
            let message = format!("the exponent of a unit lies between -{LARGEST} and {LARGEST}");
            self.fail(Diagnostic::error(span, message))
        })
    }

    fn unit_exponent(&mut self) -> Parsed<i32> {
        let parenthesis = self.take_symbol("(");
        let sign = if self.take_symbol("-") { -1 } else { 1 };
        let exponent = match &self.peek().kind {
            TokenKind::Number(text) => text.parse::<i32>().ok(),
            _ => None,
        };
        let Some(exponent) = exponent else {
            return Err(self.unexpected("a whole exponent", HELP));
        };
        self.advance();
        if parenthesis && !self.take_symbol(")") {
            let help = "the exponents of a unit are whole numbers: `m^2`, `m^-1`";
            return Err(self.unexpected("`)`", help));
        }
        Ok(sign * exponent)
    }

    fn unit_atom(&mut self) -> Parsed<Factors> {
        let token = self.peek().clone();
        match token.kind {
            TokenKind::Word(text) if !holds_together(&text) => {
                self.advance();
                Ok(vec![(
                    Name {
                        text,
                        span: token.span,
                    },
                    1,
                )])
            }
            TokenKind::Number(text) if text == "1" => {
                self.advance();
                Ok(Vec::new())
            }
            TokenKind::Symbol("(") => {
                self.advance();
                let factors = self.unit_product()?;
                self.expect_symbol(")", HELP)?;
                Ok(factors)
            }
            TokenKind::Number(_) if self.behind(1).kind == TokenKind::Symbol(":") => {
                let help = "a value stands behind `=`: `param m: kg = 1.5;`";
                Err(self.unexpected("a unit", help))
            }
            TokenKind::Symbol("[") => Err(self.unexpected("a unit", "it stands without brackets")),
            TokenKind::Symbol("-") => {
                Err(self.unexpected("a unit", "the unit of a ratio is written `1`"))
            }
            _ => Err(self.unexpected("a unit", HELP)),
        }
    }
}
