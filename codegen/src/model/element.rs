//! Vectors and matrices written out, components, elements.

use super::evaluate::Evaluator;
use super::messages::{are, elements_differ};
use super::value::{AXES, Array, Matrix, Value, all};
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::ast::{Expr, Name, Range};
use crate::syntax::messages::NO_ELEMENTS;
use std::rc::Rc;

impl Evaluator {
    /// `let name[range] = value`: one element after the other, each of which may
    /// use those before it.
    pub fn array(&mut self, name: &Name, range: &Range, value: &Expr) -> Option<Value> {
        let Some(bounds) = self.bounds(range) else {
            // One that uses its own elements would seem to be defined by itself.
            let own = self.functions.mentions([value]).contains(&name.text);
            return match own {
                true => None,
                false => self.look_once(range, |this| this.evaluate(value)),
            };
        };
        if bounds.is_empty() {
            let span = range.from.span.to(range.to.span);
            let error =
                Diagnostic::error(span, format!("the array `{}` has no elements", name.text));
            return self.report(error.help("the second bound has to be above the first"));
        }
        let mut array = Rc::new(Array {
            first: bounds.start,
            items: Vec::new(),
            end: bounds.end,
        });
        for i in bounds {
            self.scope
                .set(&name.text, Some(Value::Array(Rc::clone(&array))));
            let element = self.with_index(range, i, |this| this.evaluate(value))?;
            self.scope.set(&name.text, None);
            if array
                .items
                .first()
                .is_some_and(|first| !first.same_shape(&element))
            {
                return self.report(elements_differ(value.span));
            }
            // The scope's share is gone, so nothing is copied.
            Rc::make_mut(&mut array).items.push(element);
        }
        Some(Value::Array(array))
    }

    /// `[a, b, c]`
    pub fn vector(&mut self, parts: &[Expr], span: Span) -> Option<Value> {
        let values = parts
            .iter()
            .map(|part| Some(self.evaluate(part)?.operand()));
        let values = all(values)?;
        if !(2..=4).contains(&values.len()) {
            let here = are(values.len());
            let message = format!("a vector has two to four components, here {here}");
            let help = match values.len() {
                0 | 1 => "write `[x, y]` or `[x, y, z]`",
                _ => "longer lists are arrays: `param m[6] = […];`, `let a[i in 0..6] = …;`",
            };
            return self.report(Diagnostic::error(span, message).help(help));
        }
        if let Some(scalars) = values.iter().map(Value::as_scalar).collect() {
            return Some(Value::Vector(scalars));
        }
        let rows = values.iter().map(|row| row.as_vector().cloned());
        match rows.collect::<Option<Vec<_>>>() {
            Some(rows) if rows.iter().all(|row| row.len() == rows[0].len()) => {
                Some(Value::Matrix(Matrix { rows, spin: None }))
            }
            _ => {
                let message = "a vector is made of numbers, a matrix of rows of one length";
                let error = Diagnostic::error(span, message);
                self.report(error.help("write `[x, y, z]` or `[[a, b], [c, d]]`"))
            }
        }
    }

    /// `.x`, `.y`, `.z`
    pub fn component(&mut self, inside: &Expr, axis: usize, span: Span) -> Option<Value> {
        if self.names_part(inside) {
            return self.member(inside, AXES[axis], span);
        }
        let value = self.evaluate(inside)?.operand();
        match &value {
            Value::Vector(parts) => match parts.get(axis) {
                Some(scalar) => Some(Value::Scalar(*scalar)),
                None => {
                    let message = format!("{} has no `.{}`", value.shape(), AXES[axis]);
                    self.report(Diagnostic::error(span, message))
                }
            },
            Value::Matrix(_) => {
                let error = Diagnostic::error(span, "a matrix has no components");
                self.report(error.help("write `R[0][1]`"))
            }
            _ => {
                let message = format!("{} has no components", value.shape());
                self.report(
                    Diagnostic::error(span, message).help("only vectors have `.x`, `.y` and `.z`"),
                )
            }
        }
    }

    /// `array[i]`, `vector[i]`, `matrix[i]`
    pub fn element(&mut self, inside: &Expr, index: &Expr, span: Span) -> Option<Value> {
        let value = self.evaluate(inside)?;
        let i = self.integer(index, "an index")?;
        let at = |first: i64| usize::try_from(i.checked_sub(first)?).ok();
        let (found, first, end) = match &value {
            Value::Array(array) => {
                let item = at(array.first).and_then(|k| array.items.get(k).cloned());
                (item, array.first, array.end)
            }
            Value::Vector(parts) => {
                let part = at(0).and_then(|k| parts.get(k).copied());
                (part.map(Value::Scalar), 0, parts.len() as i64)
            }
            Value::Matrix(m) => {
                let row = at(0).and_then(|k| m.rows.get(k).cloned());
                (row.map(Value::Vector), 0, m.rows.len() as i64)
            }
            Value::Scalar(_) => {
                let error = Diagnostic::error(span, NO_ELEMENTS);
                let help = "an array is declared `coord theta[3]` or `let n[i in 0..3] = …`";
                return self.report(error.help(help));
            }
        };
        found.or_else(|| self.no_element(&value, i, first..end, index.span))
    }

    fn no_element(
        &mut self,
        value: &Value,
        i: i64,
        indices: std::ops::Range<i64>,
        span: Span,
    ) -> Option<Value> {
        if indices.contains(&i) {
            let error = Diagnostic::error(span, format!("element {i} is not known yet"));
            return self.report(error.help("an element of a `let` array may use those before it"));
        }
        let error = Diagnostic::error(span, format!("index {i} is out of range"));
        let (first, last) = (indices.start, indices.end - 1);
        self.report(error.help(format!(
            "{} has the indices {first} to {last}",
            value.shape()
        )))
    }
}
