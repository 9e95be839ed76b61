//! Vectors and matrices written out, components, elements.

use super::evaluate::Evaluator;
use super::value::{AXES, Array, Matrix, Value};
use crate::diagnostic::{Diagnostic, Span};
use crate::parse::ast::{Expr, Name, Range};
use std::cmp::Ordering;
use std::rc::Rc;

impl Evaluator {
    /// `let name[range] = value`: one element after the other, each of which may
    /// use those before it.
    pub fn array(&mut self, name: &Name, range: &Range, value: &Expr) -> Option<Value> {
        let bounds = self.bounds(range)?;
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
                let error =
                    Diagnostic::error(value.span, "the elements of an array have one shape");
                return self.report(error);
            }
            // The scope's share is gone, so nothing is copied.
            Rc::make_mut(&mut array).items.push(element);
        }
        Some(Value::Array(array))
    }

    /// `[a, b, c]`
    pub fn vector(&mut self, parts: &[Expr], span: Span) -> Option<Value> {
        let values: Vec<_> = parts.iter().map(|part| self.evaluate(part)).collect();
        let values = values.into_iter().collect::<Option<Vec<_>>>()?;
        if !(2..=3).contains(&values.len()) {
            let message = format!(
                "a vector has two or three components, here are {}",
                values.len()
            );
            return self
                .report(Diagnostic::error(span, message).help("write `[x, y]` or `[x, y, z]`"));
        }
        let scalars = values.iter().map(|v| {
            if let Value::Scalar(s) = v {
                Some(*s)
            } else {
                None
            }
        });
        if let Some(scalars) = scalars.collect() {
            return Some(Value::Vector(scalars));
        }
        let rows = values.iter().map(|v| {
            if let Value::Vector(row) = v {
                Some(row.clone())
            } else {
                None
            }
        });
        match rows.collect::<Option<Vec<_>>>() {
            Some(rows) if rows.iter().all(|row| row.len() == rows[0].len()) => {
                Some(Value::Matrix(Matrix { rows, spin: None }))
            }
            _ => {
                let error = Diagnostic::error(
                    span,
                    "the parts of a vector are numbers, those of a matrix rows of one length",
                );
                self.report(error.help("write `[x, y, z]` or `[[a, b], [c, d]]`"))
            }
        }
    }

    /// `.x`, `.y`, `.z`
    pub fn component(&mut self, inside: &Expr, axis: usize, span: Span) -> Option<Value> {
        let value = self.evaluate(inside)?;
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
            Value::Vector(parts) => (
                at(0).and_then(|k| parts.get(k)).map(|s| Value::Scalar(*s)),
                0,
                parts.len() as i64,
            ),
            Value::Matrix(m) => (
                at(0)
                    .and_then(|k| m.rows.get(k))
                    .map(|r| Value::Vector(r.clone())),
                0,
                m.rows.len() as i64,
            ),
            Value::Scalar(_) => {
                let error = Diagnostic::error(span, "a number has no elements");
                return self.report(
                    error.help("an array is declared `coord theta[3]` or `let n[i in 0..3] = …`"),
                );
            }
        };
        if found.is_none() {
            let message = match i.cmp(&end) {
                Ordering::Less if i >= first => format!("element {i} is not known yet"),
                _ => format!("index {i} is out of range"),
            };
            let help = match i >= first && i < end {
                true => "an element of a `let` array may use those before it".to_string(),
                false => format!("{} has the indices {first} to {}", value.shape(), end - 1),
            };
            return self.report(Diagnostic::error(index.span, message).help(help));
        }
        found
    }
}
