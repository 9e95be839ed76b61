//! Declarations of more than one number: vectors, matrices, arrays.
//!
//! In:  what a `const`, `param` or `input` declares.
//! Out: its value, whose every scalar is a constant, a parameter or an input of its own,
//!      with a suffix behind the name: `c.x`, `m[2]`, `I[0][1]`.

use super::evaluate::Evaluator;
use super::lowering::Lowering;
use super::messages::{SIZE, elements_differ};
use super::symbol::Symbol;
use super::unit::Unit;
use super::unit_names;
use super::value::{Array, Scalar, Value, all};
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::ast::{Declaration, Expr, ExprKind, Range, Size, UnitExpr};
use crate::syntax::messages::DECLARED;
use std::rc::Rc;

/// The most elements of an array that is declared.
const ELEMENTS: i64 = 10_000;

/// What the elements of an array are written as.
const LIST: &str = "write one value for each element, `[a, b, c]`, or one number for all";

impl Evaluator {
    /// The value that a declaration gives; `what` names it in messages.
    pub fn declared_value(&mut self, declaration: &Declaration, what: &str) -> Option<Value> {
        let value = &declaration.value;
        match declaration.size.as_deref() {
            None => self.evaluate(value).map(Value::array_to_vector),
            Some(Size::Count(count)) => {
                let count = self.count(count)?;
                self.elements(declaration, count, what)
            }
            Some(Size::Each(range)) => {
                let Some(bounds) = self.each(range) else {
                    return self.look_once(range, |this| this.evaluate(value));
                };
                let (first, mut items) = (bounds.start, Vec::new());
                for i in bounds {
                    items.push(self.with_index(range, i, |this| this.evaluate(value))?);
                }
                self.array_of(first, items, value.span)
            }
        }
    }

    /// The elements of `n[count] = value`: those of a list, of another array, or the same
    /// number for all.
    fn elements(&mut self, declaration: &Declaration, count: i64, what: &str) -> Option<Value> {
        let value = &declaration.value;
        let (list, unit) = match &value.kind {
            ExprKind::Vector(parts) => (Some(parts), None),
            ExprKind::InUnit(inside, unit) => match &inside.kind {
                ExprKind::Vector(parts) => (Some(parts), Some(unit)),
                _ => (None, None),
            },
            _ => (None, None),
        };
        if let Some(parts) = list {
            let items = all(parts.iter().map(|part| self.evaluate(part)))?;
            self.as_many(declaration, count, items.len())?;
            let array = self.array_of(0, items, value.span)?;
            return match unit {
                Some(unit) => self.united(array, unit, value.span),
                None => Some(array),
            };
        }
        match self.evaluate(value)? {
            Value::Scalar(scalar) => {
                let items = (0..count).map(|_| Value::Scalar(scalar)).collect();
                self.array_of(0, items, value.span)
            }
            Value::Array(array) if array.first == 0 => {
                self.as_many(declaration, count, array.items.len())?;
                Some(Value::Array(array))
            }
            Value::Vector(parts) => {
                self.as_many(declaration, count, parts.len())?;
                let items = parts.into_iter().map(Value::Scalar).collect();
                self.array_of(0, items, value.span)
            }
            other => {
                let shape = other.shape();
                let message = format!("{what} with {count} elements can't be {shape}");
                let error = Diagnostic::error(value.span, message);
                self.report(error.help(LIST))
            }
        }
    }

    /// Refuses a list of another length than the declared one.
    fn as_many(&mut self, declaration: &Declaration, count: i64, found: usize) -> Option<()> {
        if found as i64 == count {
            return Some(());
        }
        let name = &declaration.name;
        let message = format!("`{}` has {count} elements, here are {found}", name.text);
        let error = Diagnostic::error(declaration.value.span, message);
        self.report(error.also(name.span, DECLARED).help(LIST))
    }

    fn array_of(&mut self, first: i64, items: Vec<Value>, span: Span) -> Option<Value> {
        if items.iter().any(|item| !item.same_shape(&items[0])) {
            return self.report(elements_differ(span));
        }
        let end = first + items.len() as i64;
        Some(Value::Array(Rc::new(Array { first, items, end })))
    }

    /// The number of elements of an array.
    fn count(&mut self, size: &Expr) -> Option<i64> {
        let around = self.constant.replace(SIZE);
        let count = self.integer(size, SIZE);
        self.constant = around;
        self.elements_fit(0..count?, size.span).map(|all| all.end)
    }

    /// The indices of an array.
    fn each(&mut self, range: &Range) -> Option<std::ops::Range<i64>> {
        let bounds = self.bounds(range)?;
        self.elements_fit(bounds, range.from.span.to(range.to.span))
    }

    fn elements_fit(
        &mut self,
        indices: std::ops::Range<i64>,
        span: Span,
    ) -> Option<std::ops::Range<i64>> {
        let count = indices.end.saturating_sub(indices.start);
        if (1..=ELEMENTS).contains(&count) {
            return Some(indices);
        }
        let message = format!("an array can't have {count} elements");
        let help = format!("the size of an array is between 1 and {ELEMENTS}");
        self.report(Diagnostic::error(span, message).help(help))
    }

    /// `[a, b, c] unit`
    pub fn in_unit(&mut self, inside: &Expr, unit: &UnitExpr) -> Option<Value> {
        let value = self.evaluate(inside)?;
        self.united(value, unit, inside.span)
    }

    fn united(&mut self, value: Value, place: &UnitExpr, span: Span) -> Option<Value> {
        let unit = match unit_names::resolve(place) {
            Ok(dimension) => Unit::Known(dimension),
            Err(diagnostic) => {
                let name = place.factors.first().map(|(name, _)| name.text.as_str());
                let known = name.filter(|name| self.scope.get(name).is_some());
                let product =
                    |name| format!("behind a vector stands a unit; a product is `…*{name}`");
                return self.report(diagnostic.maybe_help(known.map(product)));
            }
        };
        for scalar in value.scalars() {
            if let Err((declared, found)) = unit.meet(scalar.unit) {
                let message = format!(
                    "this vector is declared in {}, {}",
                    declared.text(),
                    found.said()
                );
                let error = Diagnostic::error(span, message);
                return self.report(error.also(place.span, "this is its unit"));
            }
        }
        Some(value.with_unit(unit))
    }
}

impl Lowering<'_> {
    /// An input as symbols, before its law is known: a list has one for each component, an
    /// array one for each element.
    pub fn input_symbols(&mut self, declaration: &Declaration, first: u32) -> Option<Value> {
        let unit = self.unit(declaration.unit.as_ref());
        let evaluator = &mut self.evaluator;
        let symbol = |evaluator: &mut Evaluator, k: usize| {
            let id = evaluator.graph.symbol(Symbol::Input(first + k as u32));
            Scalar { id, unit }
        };
        let list = match &declaration.value.kind {
            ExprKind::InUnit(inside, _) => &inside.kind,
            other => other,
        };
        let bounds = match (declaration.size.as_deref(), list) {
            (Some(Size::Count(count)), _) => 0..evaluator.count(count)?,
            (Some(Size::Each(range)), _) => evaluator.each(range)?,
            (None, ExprKind::Vector(parts)) if (2..=4).contains(&parts.len()) => {
                let parts = (0..parts.len()).map(|k| symbol(evaluator, k));
                return Some(Value::Vector(parts.collect()));
            }
            (None, _) => return Some(Value::Scalar(symbol(evaluator, 0))),
        };
        let count = (bounds.end - bounds.start) as usize;
        let items = (0..count).map(|k| Value::Scalar(symbol(evaluator, k)));
        let items = items.collect();
        evaluator.array_of(bounds.start, items, declaration.value.span)
    }
}
