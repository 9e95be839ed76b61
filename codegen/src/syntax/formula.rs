//! Formulas that a program makes: from text, numbers and one another.
//!
//! In:  texts in the notation of descriptions, numbers, other formulas.
//! Out: [`Formula`]; what is wrong with a text stays with it until the formula is
//!      used, as [`ModelError`].

use super::ast::{Expr, ExprKind, Name};
use super::error::ModelError;
use super::{print, read};
use crate::diagnostic::Span;
use std::fmt::{self, Display, Formatter};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A formula for a [`Model`](super::Model).
///
/// Made `From` text (`"L*cos(q)"`), numbers, and by `+ - * /` of formulas; displayed as
/// text, so that it can be part of a `format!` too.
#[derive(Clone, Debug)]
pub struct Formula(Result<Expr, ModelError>);

impl Formula {
    /// `function(arguments)`
    pub fn call<F: Into<Formula>>(function: &str, arguments: impl IntoIterator<Item = F>) -> Self {
        let mut faults = ModelError::default();
        faults.check_name(function);
        let arguments = faults.accept_all(arguments);
        let name = Name {
            text: function.to_string(),
            span: Span::default(),
        };
        faults.or(ExprKind::Call(name, arguments))
    }

    /// `[a, b, c]`
    pub fn vector<F: Into<Formula>>(parts: impl IntoIterator<Item = F>) -> Self {
        let mut faults = ModelError::default();
        let parts = faults.accept_all(parts);
        faults.or(ExprKind::Vector(parts))
    }

    /// `der(self)`
    pub fn der(self) -> Self {
        Self::call("der", [self])
    }

    /// `self^exponent`
    pub fn powi(self, exponent: i32) -> Self {
        let mut faults = ModelError::default();
        let base = faults.accept(self);
        let exponent = faults.accept(exponent.into());
        faults.or(ExprKind::Power(Box::new(base), Box::new(exponent)))
    }

    /// `self[index]`
    pub fn at(self, index: impl Into<Formula>) -> Self {
        let mut faults = ModelError::default();
        let whole = faults.accept(self);
        let index = faults.accept(index.into());
        faults.or(ExprKind::Index(Box::new(whole), Box::new(index)))
    }

    /// A sum, or the longer sum if the first is one already.
    fn plus(self, minus: bool, other: Formula) -> Self {
        let mut faults = ModelError::default();
        let (first, other) = (faults.accept(self), faults.accept(other));
        let mut terms = match first.kind {
            ExprKind::Sum(terms) => terms,
            _ => vec![(false, first)],
        };
        terms.push((minus, other));
        faults.or(ExprKind::Sum(terms))
    }

    /// A product, or the longer product if the first is one already.
    fn times(self, over: bool, other: Formula) -> Self {
        let mut faults = ModelError::default();
        let (first, other) = (faults.accept(self), faults.accept(other));
        let mut factors = match first.kind {
            ExprKind::Product(factors) => factors,
            _ => vec![(false, first)],
        };
        factors.push((over, other));
        faults.or(ExprKind::Product(factors))
    }
}

impl From<&str> for Formula {
    fn from(text: &str) -> Self {
        Self(read::formula(text).map_err(|diagnostics| {
            let mut faults = ModelError::default();
            faults.push(text, diagnostics);
            faults
        }))
    }
}

impl From<String> for Formula {
    fn from(text: String) -> Self {
        Self::from(text.as_str())
    }
}

impl From<&Formula> for Formula {
    fn from(formula: &Formula) -> Self {
        formula.clone()
    }
}

impl From<f64> for Formula {
    /// The shortest decimal that reads back to the number.
    fn from(number: f64) -> Self {
        Self::from(format!("{number:?}"))
    }
}

impl From<i32> for Formula {
    fn from(number: i32) -> Self {
        Self::from(number.to_string())
    }
}

impl<F: Into<Formula>> Add<F> for Formula {
    type Output = Formula;

    fn add(self, other: F) -> Formula {
        self.plus(false, other.into())
    }
}

impl<F: Into<Formula>> Sub<F> for Formula {
    type Output = Formula;

    fn sub(self, other: F) -> Formula {
        self.plus(true, other.into())
    }
}

impl<F: Into<Formula>> Mul<F> for Formula {
    type Output = Formula;

    fn mul(self, other: F) -> Formula {
        self.times(false, other.into())
    }
}

impl<F: Into<Formula>> Div<F> for Formula {
    type Output = Formula;

    fn div(self, other: F) -> Formula {
        self.times(true, other.into())
    }
}

impl Neg for Formula {
    type Output = Formula;

    fn neg(self) -> Formula {
        let mut faults = ModelError::default();
        let inside = faults.accept(self);
        faults.or(ExprKind::Negative(Box::new(inside)))
    }
}

impl Display for Formula {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Ok(expression) => f.write_str(&print::formula(expression)),
            Err(faults) => {
                let texts = faults.parts.iter().map(|(text, _)| text.as_str());
                f.write_str(&texts.collect::<Vec<_>>().join(" "))
            }
        }
    }
}

impl ModelError {
    /// The formula, or a nought in its place while what is wrong is kept.
    pub(super) fn accept(&mut self, formula: Formula) -> Expr {
        formula.0.unwrap_or_else(|mut faults| {
            self.parts.append(&mut faults.parts);
            Expr {
                span: Span::default(),
                kind: ExprKind::Vector(Vec::new()),
            }
        })
    }

    fn accept_all<F: Into<Formula>>(&mut self, parts: impl IntoIterator<Item = F>) -> Vec<Expr> {
        let parts = parts.into_iter();
        parts.map(|part| self.accept(part.into())).collect()
    }

    /// The formula, if nothing is wrong with its parts.
    fn or(self, kind: ExprKind) -> Formula {
        let span = Span::default();
        Formula(if self.is_empty() {
            Ok(Expr { span, kind })
        } else {
            Err(self)
        })
    }
}
