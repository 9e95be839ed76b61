//! Numbers that stand in a formula for what has a unit.
//!
//! In:  a formula whose unit is wrong.
//! Out: the number in it, or in the quantities that it mentions, that was probably
//!      meant in a unit, and how that is declared.

use super::evaluate::Evaluator;
use super::unit::Dimension;
use super::value::Bare;
use crate::diagnostic::{Diagnostic, figure};
use crate::expr::Number;
use crate::syntax::ast::{Expr, ExprKind};

/// Numbers that stand in front of anything: 0, 1, 0.5.
fn is_coefficient(number: &Number) -> bool {
    [0.0, 0.5, 1.0].contains(&number.to_f64())
}

impl Evaluator {
    /// The number in a formula that was most probably meant in a unit.
    pub fn bare(&self, e: &Expr) -> Option<Bare> {
        let mut found = Vec::new();
        self.collect(e, &mut found);
        let measured = found.iter().find(|bare| bare.is_measured());
        measured.or(found.first()).copied()
    }

    fn collect(&self, e: &Expr, found: &mut Vec<Bare>) {
        match &e.kind {
            ExprKind::Number(number) if !is_coefficient(number) => found.push(Bare {
                number: *number,
                span: e.span,
                power: 1.0,
            }),
            ExprKind::Name(name) => {
                found.extend(self.scope.get(name).and_then(|entry| entry.bare));
            }
            ExprKind::Negative(x) | ExprKind::Component(x, _) | ExprKind::Index(x, _) => {
                self.collect(x, found);
            }
            ExprKind::Sum(parts) => parts.iter().for_each(|(_, x)| self.collect(x, found)),
            ExprKind::Product(parts) => self.collect_factors(parts, found),
            ExprKind::Power(base, exponent) => {
                if let ExprKind::Number(exponent) = &exponent.kind {
                    let inside = self.bare(base);
                    found.extend(inside.map(|bare| bare.raised(exponent.to_f64())));
                }
            }
            ExprKind::Call(name, arguments) => match name.text.as_str() {
                "der" | "norm" | "dot" | "cross" | "transpose" => {
                    arguments.iter().for_each(|x| self.collect(x, found));
                }
                "norm2" => {
                    let inside = arguments.iter().filter_map(|x| self.bare(x));
                    found.extend(inside.map(|bare| bare.raised(2.0)));
                }
                _ => {}
            },
            ExprKind::Member(..) => {}
            ExprKind::Repeat(_, term) => self.collect(term, found),
            ExprKind::Vector(parts) => parts.iter().for_each(|x| self.collect(x, found)),
            ExprKind::Number(_) | ExprKind::Text(_) | ExprKind::If(..) | ExprKind::InUnit(..) => {}
        }
    }

    /// The factors of a product; a fraction of whole numbers, such as 1/2, is a ratio.
    fn collect_factors(&self, parts: &[(bool, Expr)], found: &mut Vec<Bare>) {
        let whole = |e: &Expr| matches!(&e.kind, ExprKind::Number(n) if n.as_integer().is_some());
        let ratio = parts.iter().any(|(over, x)| *over && whole(x));
        for (over, factor) in parts {
            if ratio && whole(factor) {
                continue;
            }
            let inside = self.bare(factor);
            let power = if *over { -1.0 } else { 1.0 };
            found.extend(inside.map(|bare| bare.raised(power)));
        }
    }

    /// Says how the number is declared that would turn one unit into another.
    pub fn declare_bare(
        &self,
        error: Diagnostic,
        e: &Expr,
        [wanted, found]: [Dimension; 2],
    ) -> Diagnostic {
        let Some(bare) = self.bare(e) else {
            return error;
        };
        let lacking = found.power(-1.0).map(|found| wanted.times(found));
        let Some(unit) = lacking.and_then(|unit| unit.power(1.0 / bare.power)) else {
            return error;
        };
        let unit = unit.text();
        let usual = if unit == "m/s^2" { "g" } else { "a" };
        let free = |name: &&str| self.scope.get(name).is_none();
        let names = [usual, "c0", "c1", "c2"];
        let name = names.into_iter().find(free).unwrap_or("c3");
        let number = figure(bare.number.to_f64());
        error.also(bare.span, "this has no unit").help(format!(
            "a bare number has no unit: declare `const {name}: {unit} = {number};` and write `{name}`"
        ))
    }
}
