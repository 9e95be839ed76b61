//! Sums, products and powers: scalars, vectors and matrices together.

use super::evaluate::Evaluator;
use super::scope::Kind;
use super::unit::Unit;
use super::value::{Scalar, Value, all};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::Number;
use crate::syntax::ast::{Expr, Name, Range};
use crate::syntax::messages::LARGE_AND_SMALL;

/// The largest exponent that can be written.
const EXPONENT: f64 = 1000.0;

/// A term that may be subtracted, or a factor that may divide.
pub type Part = (bool, Scalar, Span);

/// The place of several terms or factors together.
fn around(parts: &[Part]) -> Span {
    let ends = parts.first().zip(parts.last());
    ends.map_or(Span::default(), |((.., first), (.., last))| first.to(*last))
}

impl Evaluator {
    /// `-x`
    pub fn negative(&mut self, inside: &Expr) -> Option<Value> {
        let value = self.evaluate(inside)?.operand();
        if let Value::Array(_) = value {
            return self.no_array(inside.span);
        }
        let opposite = value.scalars().into_iter().map(|s| self.opposite(s));
        Some(value.with_scalars(opposite.collect()))
    }

    /// `-x` of a number.
    pub fn opposite(&mut self, x: Scalar) -> Scalar {
        Scalar::new(self.graph.neg(x.id), x.unit)
    }

    /// Refuses a whole array in a calculation.
    pub fn no_array<T>(&mut self, span: Span) -> Option<T> {
        let error = Diagnostic::error(span, "a whole array can't stand in a calculation");
        self.report(error.help("write one element, such as `theta[0]`, or use `for` or `sum`"))
    }

    fn parts(&mut self, parts: &[(bool, Expr)]) -> Option<Vec<(bool, Value, Span)>> {
        let value =
            |(flag, part): &(bool, Expr)| Some((*flag, self.evaluate(part)?.operand(), part.span));
        all(parts.iter().map(value))
    }

    /// `a + b - c`
    pub fn sum(&mut self, terms: &[(bool, Expr)]) -> Option<Value> {
        let values = self.parts(terms)?;
        self.sum_values(&values)
    }

    fn sum_values(&mut self, values: &[(bool, Value, Span)]) -> Option<Value> {
        let (_, first, place) = values.first()?;
        for (_, value, span) in values {
            if let Value::Array(_) = value {
                return self.no_array(*span);
            }
            if !first.same_shape(value) {
                let message = format!("{} and {} can't be added", first.shape(), value.shape());
                let error = Diagnostic::error(*span, message)
                    .labelled(format!("this is {}", value.shape()));
                let error = error.also(*place, format!("this is {}", first.shape()));
                return self
                    .report(error.help(
                        "the terms of a sum are numbers, or vectors or matrices of one size",
                    ));
            }
        }
        let columns: Vec<_> = values
            .iter()
            .map(|(minus, v, span)| (*minus, v.scalars(), *span))
            .collect();
        let component = |k: usize| {
            columns
                .iter()
                .map(move |(minus, s, span)| (*minus, s[k], *span))
        };
        let sums =
            (0..first.scalars().len()).map(|k| self.sum_scalars(&component(k).collect::<Vec<_>>()));
        Some(first.with_scalars(all(sums)?))
    }

    /// The sum of scalars, if they have one unit.
    pub fn sum_scalars(&mut self, terms: &[Part]) -> Option<Scalar> {
        let mut unit = Unit::Number;
        for (_, term, span) in terms {
            unit = match unit.meet(term.unit) {
                Ok(unit) => unit,
                Err((left, right)) => {
                    let known = |(_, s, _): &&Part| matches!(s.unit, Unit::Known(_));
                    let first = terms.iter().find(known).map_or(*span, |(_, _, span)| *span);
                    return self.mixed("this sum", [(left, first), (right, *span)]);
                }
            };
        }
        let weight = |minus: bool| {
            if minus {
                Number::MINUS_ONE
            } else {
                Number::ONE
            }
        };
        let weighted: Vec<_> = terms
            .iter()
            .map(|(minus, s, _)| (s.id, weight(*minus)))
            .collect();
        let id = self.graph.weighted_sum(Number::ZERO, &weighted);
        Some(Scalar::new(self.valid(id, around(terms))?, unit))
    }

    /// `a * b / c`
    pub fn product(&mut self, factors: &[(bool, Expr)]) -> Option<Value> {
        let values = self.parts(factors)?;
        let scalar = |(over, value, span): &(bool, Value, Span)| {
            value.as_scalar().map(|scalar| (*over, scalar, *span))
        };
        if let Some(scalars) = values.iter().map(scalar).collect::<Option<Vec<_>>>() {
            return self.product_scalars(&scalars).map(Value::Scalar);
        }
        let mut values = values.into_iter();
        let (_, mut product, mut span) = values.next()?;
        for (over, value, place) in values {
            product = self.multiply(&product, span, over, &value, place)?;
            span = span.to(place);
        }
        Some(product)
    }

    /// The product of scalars, if no divisor is zero.
    pub fn product_scalars(&mut self, factors: &[Part]) -> Option<Scalar> {
        let mut unit = Unit::Number;
        let mut powers = Vec::new();
        for (over, factor, span) in factors {
            if *over && self.graph.is_zero(factor.id) {
                let error = Diagnostic::error(*span, "division by zero").labelled("this is zero");
                return self.report(error);
            }
            let power = if *over { -1 } else { 1 };
            unit = unit.times(factor.unit.power(f64::from(power)));
            powers.push((factor.id, power));
        }
        let id = self.graph.power_product(&powers);
        if self.graph.is_zero(id) && !powers.iter().any(|(e, _)| self.graph.is_zero(*e)) {
            return self.vanished(around(factors));
        }
        // Zero fits every unit: `[[J1, 0], [0, J2]]*w` is a sum of moments.
        if self.graph.is_zero(id) || (unit == Unit::PURE && self.has_size(factors)) {
            unit = Unit::Number;
        }
        Some(Scalar::new(self.valid(id, around(factors))?, unit))
    }

    /// A number so small that it would be taken for zero.
    fn vanished<T>(&mut self, span: Span) -> Option<T> {
        let error = Diagnostic::error(span, "this number is too small");
        self.report(error.help(LARGE_AND_SMALL))
    }

    /// Whether a number among dimensionless factors may stand for what has a unit:
    /// `0.5` in `0.5*cos(q1)` for a length, but nothing in `45*deg`.
    fn has_size(&mut self, factors: &[Part]) -> bool {
        let numbers = factors
            .iter()
            .any(|(_, factor, _)| factor.unit == Unit::Number);
        numbers
            && factors.iter().all(|(_, factor, _)| {
                factor.unit == Unit::Number || self.analysis(factor.id).value.is_none()
            })
    }

    /// `base ^ exponent`
    pub fn power(&mut self, base: &Expr, exponent: &Expr, span: Span) -> Option<Value> {
        let value = match self.evaluate(base)? {
            Value::Scalar(scalar) => scalar,
            other => {
                let error = Diagnostic::error(span, format!("{} has no powers", other.shape()));
                return self
                    .report(error.help("the square of the length of a vector is `norm2(v)`"));
            }
        };
        let raised = self.scalar(exponent, "an exponent")?;
        if let Unit::Known(dimension) = raised.unit
            && !raised.unit.is_pure()
        {
            let error = Diagnostic::error(exponent.span, "an exponent has no unit");
            let error = error.labelled(dimension.said());
            return self.report(
                error.help("an exponent is a ratio: divide by a constant in the same unit"),
            );
        }
        let number = self.graph.as_number(raised.id).map(Number::to_f64);
        if number.is_some_and(|n| n.abs() > EXPONENT) {
            let message = format!("an exponent above {EXPONENT}");
            return self.report(
                Diagnostic::error(exponent.span, message).help("write a smaller one, or `exp(…)`"),
            );
        }
        if number.is_some_and(|n| n < 0.0) && self.graph.is_zero(value.id) {
            let error = Diagnostic::error(span, "a negative power of zero");
            return self
                .report(error.help("zero divides nothing: correct the base or the exponent"));
        }
        let unit = match number {
            None if raised.unit == Unit::Unchecked => Unit::Unchecked,
            Some(number) => value.unit.power(number),
            None if value.unit.is_pure() => value.unit,
            None => {
                let error =
                    Diagnostic::error(exponent.span, "the exponent of what has a unit is a number");
                let error = error.labelled("this is not known when the code is generated");
                return self.report(error.help("make it a number or a `const`"));
            }
        };
        let id = self.graph.pow(value.id, raised.id);
        if self.graph.is_zero(id) && !self.graph.is_zero(value.id) {
            return self.vanished(span);
        }
        Some(Value::Scalar(Scalar::new(self.valid(id, span)?, unit)))
    }

    /// `sum(i in a..b, term)`
    pub fn repeated_sum(&mut self, range: &Range, term: &Expr, span: Span) -> Option<Value> {
        let Some(bounds) = self.bounds(range) else {
            return self.look_once(range, |this| this.evaluate(term));
        };
        let mut values = Vec::new();
        for i in bounds {
            let value = self
                .with_index(range, i, |this| this.evaluate(term))?
                .operand();
            values.push((false, value, term.span));
        }
        if values.is_empty() {
            let id = self.graph.integer(0);
            return Some(Value::Scalar(Scalar::new(id, Unit::Number)));
        }
        let sum = self.sum_values(&values);
        if sum.is_none() {
            self.spend(span)?;
        }
        sum
    }

    /// Evaluates something while an index has a value.
    pub fn with_index<T>(
        &mut self,
        range: &Range,
        value: i64,
        work: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        self.spend(range.index.span)?;
        let mark = self.scope.open();
        if let Err(diagnostic) = self.scope.declare(&range.index, Kind::Index) {
            return self.report(*diagnostic);
        }
        self.set_index(&range.index, value);
        let result = work(self);
        self.scope.close(mark);
        result
    }

    /// Does something while an index, which is known to be free, has a value.
    pub fn with_value<T>(
        &mut self,
        index: &Name,
        value: i64,
        work: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let mark = self.scope.open();
        if let Err(diagnostic) = self.scope.declare(index, Kind::Index) {
            self.report::<()>(*diagnostic);
        }
        self.set_index(index, value);
        let result = work(self);
        self.scope.close(mark);
        result
    }

    fn set_index(&mut self, index: &Name, value: i64) {
        let id = self.graph.integer(value);
        let value = Value::Scalar(Scalar::new(id, Unit::Number));
        self.scope.set(&index.text, Some(value));
    }
}
