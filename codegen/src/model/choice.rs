//! `if … then … else …`: choices and the conditions that they depend on.
//!
//! In:  conditions and formulas of the syntax tree.
//! Out: expressions that select; where a condition is known now, one of the formulas.

use super::evaluate::Evaluator;
use super::messages::{ONE_SIZE, sides_differ};
use super::value::{Scalar, Value};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::{Comparison, ExprId};
use crate::syntax::ast::{Condition, Expr};

/// What is known of a condition.
enum Truth {
    /// It holds, or does not.
    Known(bool),
    Compare(Comparison, ExprId, ExprId),
    Not(Box<Truth>),
    And(Box<Truth>, Box<Truth>),
    Or(Box<Truth>, Box<Truth>),
}

impl Evaluator {
    /// A choice. Where the condition is known now only one side is looked at:
    /// `if i == 0 then a else p[i-1]` is no real choice.
    pub fn choice(
        &mut self,
        condition: &Condition,
        then: &Expr,
        otherwise: &Expr,
        span: Span,
    ) -> Option<Value> {
        let truth = match self.truth(condition)? {
            Truth::Known(true) => return self.evaluate(then),
            Truth::Known(false) => return self.evaluate(otherwise),
            open => open,
        };
        let (yes, no) = (self.evaluate(then), self.evaluate(otherwise));
        let (yes, no) = (yes?.operand(), no?.operand());
        if !yes.same_shape(&no) {
            let error = Diagnostic::error(span, sides_differ("choice", &yes, &no));
            return self.report(error.help(ONE_SIZE));
        }
        let mut chosen = Vec::new();
        for (one, other) in yes.scalars().into_iter().zip(no.scalars()) {
            let sides = [(one, then.span), (other, otherwise.span)];
            let unit = self.same_unit(sides, "this choice")?;
            let id = self.select(&truth, one.id, other.id);
            chosen.push(Scalar { id, unit });
        }
        Some(yes.with_scalars(chosen))
    }

    /// What is known of a condition. Where its first part decides, the second is not
    /// looked at.
    fn truth(&mut self, condition: &Condition) -> Option<Truth> {
        Some(match condition {
            Condition::Compare(comparison, sides) => self.compare(*comparison, sides)?,
            Condition::Not(inside) => match self.truth(inside)? {
                Truth::Known(holds) => Truth::Known(!holds),
                open => Truth::Not(Box::new(open)),
            },
            Condition::And(first, second) => match self.truth(first)? {
                Truth::Known(false) => Truth::Known(false),
                Truth::Known(true) => self.truth(second)?,
                open => match self.truth(second)? {
                    Truth::Known(false) => Truth::Known(false),
                    Truth::Known(true) => open,
                    other => Truth::And(Box::new(open), Box::new(other)),
                },
            },
            Condition::Or(first, second) => match self.truth(first)? {
                Truth::Known(true) => Truth::Known(true),
                Truth::Known(false) => self.truth(second)?,
                open => match self.truth(second)? {
                    Truth::Known(true) => Truth::Known(true),
                    Truth::Known(false) => open,
                    other => Truth::Or(Box::new(open), Box::new(other)),
                },
            },
        })
    }

    fn compare(&mut self, comparison: Comparison, sides: &[Expr; 2]) -> Option<Truth> {
        let left = self.scalar(&sides[0], "the side of a comparison")?;
        let right = self.scalar(&sides[1], "the side of a comparison")?;
        let placed = [(left, sides[0].span), (right, sides[1].span)];
        self.same_unit(placed, "this comparison")?;
        let numbers = (
            self.graph.as_number(left.id),
            self.graph.as_number(right.id),
        );
        Some(match numbers {
            (Some(a), Some(b)) => Truth::Known(comparison.holds(a.to_f64(), b.to_f64())),
            _ => Truth::Compare(comparison, left.id, right.id),
        })
    }

    /// One of two expressions, nested selections standing for joined conditions.
    fn select(&mut self, truth: &Truth, yes: ExprId, no: ExprId) -> ExprId {
        match truth {
            Truth::Known(true) => yes,
            Truth::Known(false) => no,
            Truth::Compare(comparison, left, right) => {
                self.graph.select(*comparison, *left, *right, yes, no)
            }
            Truth::Not(inside) => self.select(inside, no, yes),
            Truth::And(first, second) => {
                let both = self.select(second, yes, no);
                self.select(first, both, no)
            }
            Truth::Or(first, second) => {
                let either = self.select(second, yes, no);
                self.select(first, yes, either)
            }
        }
    }
}
