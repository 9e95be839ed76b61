//! What every value has to satisfy: units that agree, numbers that are finite.

use super::evaluate::Evaluator;
use super::symbol::Node;
use super::unit::{Dimension, Unit};
use super::value::Scalar;
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::ExprId;
use crate::syntax::messages::LARGE_AND_SMALL;

/// The largest exponent that is kept as a product.
const LARGEST_EXPONENT: i32 = 1_000_000;

impl Evaluator {
    /// The unit that two sides have in common.
    pub fn same_unit(&mut self, sides: [(Scalar, Span); 2], what: &str) -> Option<Unit> {
        let [(left, left_span), (right, right_span)] = sides;
        match left.unit.meet(right.unit) {
            Ok(unit) => Some(unit),
            Err((left, right)) => self.mixed(what, [(left, left_span), (right, right_span)]),
        }
    }

    /// Says that two units stand where one belongs.
    pub fn mixed<T>(&mut self, what: &str, sides: [(Dimension, Span); 2]) -> Option<T> {
        let [(left, left_span), (right, right_span)] = sides;
        let message = format!("{what} mixes {} and {}", left.text(), right.text());
        let error = Diagnostic::error(right_span, message).labelled(right.said());
        let lacking = right.power(-1.0).map(|right| left.times(right));
        let lacking = lacking.filter(|_| left.is_rate() || right.is_rate());
        let unit = match lacking {
            Some(unit) if right.is_rate() => Some(unit),
            Some(unit) => unit.power(-1.0),
            None => None,
        };
        let declare = |unit: Dimension| {
            let unit = unit.text();
            format!("a number that is meant in {unit} is declared: `const a: {unit} = …;`")
        };
        self.report(
            error
                .also(left_span, left.said())
                .maybe_help(unit.map(declare)),
        )
    }

    /// Refuses a unit where an angle or ratio belongs.
    pub fn pure(&mut self, unit: Unit, what: &str, span: Span) -> Option<()> {
        match unit {
            Unit::Known(dimension) if !unit.is_pure() => {
                let message = format!("{what} is in {}", dimension.text());
                let error = Diagnostic::error(span, message);
                self.report(error.help("it has to be an angle (rad) or a ratio without unit"))
            }
            _ => Some(()),
        }
    }

    /// Refuses an expression with numbers that no `f64` can hold, or with a huge exponent.
    pub fn valid(&mut self, id: ExprId, span: Span) -> Option<ExprId> {
        let (finite, tame) = match self.graph.node(id) {
            Node::Number(value) => (value.is_finite(), true),
            Node::Sum(constant, terms) => {
                let weights = terms.iter().all(|(_, weight)| weight.is_finite());
                (weights && constant.is_finite(), true)
            }
            Node::Product(factors) => (
                true,
                factors
                    .iter()
                    .all(|(_, exponent)| exponent.abs() <= LARGEST_EXPONENT),
            ),
            _ => {
                let value = self.analysis(id).value;
                if value.is_some_and(f64::is_nan) {
                    let error = Diagnostic::error(span, "this is not a real number");
                    let help =
                        "a number below zero has whole powers only, and no root or logarithm";
                    return self.report(error.help(help));
                }
                (value.is_none_or(f64::is_finite), true)
            }
        };
        if !finite {
            let message = "this is not a finite number";
            let error = Diagnostic::error(span, message);
            return self.report(error.help(LARGE_AND_SMALL));
        }
        if !tame {
            let message = format!("this contains a power above {LARGEST_EXPONENT}");
            return self
                .report(Diagnostic::error(span, message).help("make the exponents smaller"));
        }
        Some(id)
    }
}
