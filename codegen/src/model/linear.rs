//! Products of vectors and matrices.

use super::arithmetic::Part;
use super::evaluate::Evaluator;
use super::value::{Matrix, Scalar, Value, all};
use crate::diagnostic::{Diagnostic, Span};

impl Evaluator {
    /// `a * b` or `a / b`, where not both are scalars.
    pub fn multiply(
        &mut self,
        a: &Value,
        a_span: Span,
        over: bool,
        b: &Value,
        b_span: Span,
    ) -> Option<Value> {
        match (a, b) {
            (Value::Array(_), _) => self.no_array(a_span),
            (_, Value::Array(_)) => self.no_array(b_span),
            (_, Value::Scalar(scalar)) => self.scale(a, (over, *scalar, b_span), a_span),
            (_, _) if over => {
                let message = format!("division by {}", b.shape());
                self.report(Diagnostic::error(b_span, message).help("only a number can divide"))
            }
            (Value::Scalar(scalar), _) => self.scale(b, (false, *scalar, a_span), b_span),
            (Value::Matrix(m), Value::Vector(v)) if m.rows[0].len() == v.len() => {
                self.transform(m, v, a_span.to(b_span)).map(Value::Vector)
            }
            (Value::Matrix(m), Value::Matrix(n)) if m.rows[0].len() == n.rows.len() => {
                self.compose(m, n, a_span.to(b_span)).map(Value::Matrix)
            }
            _ => self.no_product(a, b, a_span.to(b_span)),
        }
    }

    fn no_product(&mut self, a: &Value, b: &Value, span: Span) -> Option<Value> {
        let (message, help) = match (a, b) {
            (Value::Vector(_), Value::Vector(_)) => {
                let help = "write `dot(a, b)` or `cross(a, b)`";
                ("the product of two vectors is ambiguous".to_string(), help)
            }
            (Value::Vector(_), Value::Matrix(_)) => (
                "a vector can't stand in front of a matrix".to_string(),
                "write `transpose(R)*v`",
            ),
            (Value::Matrix(plane), Value::Vector(v)) if plane.rows.len() == 2 && v.len() == 3 => (
                format!("{} can't be multiplied by {}", a.shape(), b.shape()),
                "a rotation in space has an axis: `rotx(a)`, `roty(a)`, `rotz(a)`, \
                 `rot(axis, a)`",
            ),
            _ => (
                format!("{} can't be multiplied by {}", a.shape(), b.shape()),
                "a matrix needs as many columns as what stands behind it has rows",
            ),
        };
        self.report(Diagnostic::error(span, message).help(help))
    }

    fn scale(&mut self, value: &Value, factor: Part, span: Span) -> Option<Value> {
        let scalars = value.scalars().into_iter();
        let scaled = scalars.map(|s| self.product_scalars(&[(false, s, span), factor]));
        Some(value.with_scalars(all(scaled)?))
    }

    /// `M v`
    pub fn transform(&mut self, m: &Matrix, v: &[Scalar], span: Span) -> Option<Vec<Scalar>> {
        m.rows.iter().map(|row| self.inner(row, v, span)).collect()
    }

    /// `M N`; of two rotations, the angular velocity Nᵀω_M + ω_N comes along.
    fn compose(&mut self, m: &Matrix, n: &Matrix, span: Span) -> Option<Matrix> {
        let columns = transposed(&n.rows);
        let row = |this: &mut Self, row: &Vec<Scalar>| -> Option<Vec<Scalar>> {
            columns
                .iter()
                .map(|column| this.inner(row, column, span))
                .collect()
        };
        let rows = m
            .rows
            .iter()
            .map(|r| row(self, r))
            .collect::<Option<Vec<_>>>()?;
        let mut spin = None;
        if let (Some(outer), Some(inner)) = (m.spin, n.spin) {
            let mut total = Vec::new();
            for (k, own) in inner.into_iter().enumerate() {
                let carried = match columns.len() {
                    // About the normal of the plane, which stays where it is.
                    2 => outer[k],
                    _ => self.inner(&columns[k], &outer, span)?,
                };
                total.push(self.add(carried, own, span)?);
            }
            spin = total.try_into().ok();
        }
        Some(Matrix { rows, spin })
    }

    /// `Σ a_k b_k`
    pub fn inner(&mut self, a: &[Scalar], b: &[Scalar], span: Span) -> Option<Scalar> {
        let pairs = a.iter().zip(b);
        let products = pairs.map(|(x, y)| Some((false, self.times(*x, *y, span)?, span)));
        let terms = all(products)?;
        self.sum_scalars(&terms)
    }

    /// `a + b`
    pub fn add(&mut self, a: Scalar, b: Scalar, span: Span) -> Option<Scalar> {
        self.sum_scalars(&[(false, a, span), (false, b, span)])
    }

    /// `a - b`
    pub fn subtract(&mut self, a: Scalar, b: Scalar, span: Span) -> Option<Scalar> {
        self.sum_scalars(&[(false, a, span), (true, b, span)])
    }

    /// `a b`
    pub fn times(&mut self, a: Scalar, b: Scalar, span: Span) -> Option<Scalar> {
        self.product_scalars(&[(false, a, span), (false, b, span)])
    }
}

/// Rows to columns.
pub fn transposed(rows: &[Vec<Scalar>]) -> Vec<Vec<Scalar>> {
    (0..rows[0].len())
        .map(|k| rows.iter().map(|row| row[k]).collect())
        .collect()
}
