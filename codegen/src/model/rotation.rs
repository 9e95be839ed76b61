//! Rotation matrices and their angular velocity, in the body frame.
//!
//! A matrix R takes components in the body frame to components in space. Its
//! angular velocity ω is that of ω̃ = RᵀṘ. For rotations about axes, Euler
//! parameters, and their products and transposes it is known without that
//! product and carried along.

use super::evaluate::Evaluator;
use super::linear::transposed;
use super::unit::{PER_SECOND, Unit};
use super::value::{Matrix, Scalar, Value};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::{Function, Number};
use crate::syntax::ast::Expr;

impl Evaluator {
    /// `rotx(angle)`, `roty(angle)`, `rotz(angle)`: the rotation about an axis.
    pub fn rotation(&mut self, axis: usize, argument: &Expr) -> Option<Value> {
        let angle = self.scalar(argument, "the angle of a rotation")?;
        self.pure(angle.unit, "the angle of a rotation", argument.span)?;
        let unit = angle.unit.power(0.0);
        let scalar = |id| Scalar { id, unit };
        let (sin, cos) = (
            self.graph.function(Function::Sin, angle.id),
            self.graph.function(Function::Cos, angle.id),
        );
        let (zero, one, opposite) = (
            self.graph.integer(0),
            self.graph.integer(1),
            self.graph.neg(sin),
        );
        let mut rows = vec![vec![scalar(zero); 3]; 3];
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        rows[axis][axis] = scalar(one);
        rows[next][next] = scalar(cos);
        rows[last][last] = scalar(cos);
        rows[next][last] = scalar(opposite);
        rows[last][next] = scalar(sin);
        Some(Value::Matrix(Matrix {
            rows,
            spin: self.axis_spin(axis, angle, argument.span),
        }))
    }

    fn axis_spin(&mut self, axis: usize, angle: Scalar, span: Span) -> Option<[Scalar; 3]> {
        let analysis = self.analysis(angle.id);
        if analysis.velocity() || analysis.input {
            return None;
        }
        let rate = self.rate(angle, span)?;
        let none = Scalar::new(self.graph.integer(0), rate.unit);
        let mut spin = [none; 3];
        spin[axis] = rate;
        Some(spin)
    }

    /// `rot(angle)`: the rotation in the plane.
    pub fn plane_rotation(&mut self, argument: &Expr) -> Option<Value> {
        let Value::Matrix(space) = self.rotation(2, argument)? else {
            return None;
        };
        let rows = space.rows.into_iter().take(2);
        let rows = rows.map(|row| row.into_iter().take(2).collect());
        Some(Value::Matrix(Matrix {
            rows: rows.collect(),
            spin: space.spin,
        }))
    }

    /// `rot(axis, angle)`: the rotation about an axis of any length, by Rodrigues' formula
    /// cos φ E + sin φ ñ + (1 − cos φ) n nᵀ. About an axis at rest ω = φ̇ n.
    pub fn rotation_about(&mut self, axis: &Expr, angle: &Expr, span: Span) -> Option<Value> {
        let n = self.direction(axis)?;
        let Value::Matrix(about_z) = self.rotation(2, angle)? else {
            return None;
        };
        let (cos, sin) = (about_z.rows[0][0], about_z.rows[1][0]);
        let one = self.graph.integer(1);
        let unit = cos.unit;
        let versed = Scalar::new(self.graph.sub(one, cos.id), unit);
        let mut rows = vec![Vec::new(); 3];
        for (i, row) in rows.iter_mut().enumerate() {
            for j in 0..3 {
                let across = self.times(n[i], n[j], span)?;
                let dyad = self.times(versed, across, span)?;
                let other = match i == j {
                    true => cos.id,
                    false => {
                        let turned = self.times(sin, n[3 - i - j], span)?;
                        match (i + 1) % 3 == j {
                            true => self.graph.neg(turned.id),
                            false => turned.id,
                        }
                    }
                };
                let id = self.graph.sum([other, dyad.id]);
                row.push(Scalar { id, unit });
            }
        }
        let rests = n.iter().all(|part| {
            let analysis = self.analysis(part.id);
            !analysis.coordinate && !analysis.time && !analysis.velocity() && !analysis.input
        });
        let spin = match about_z.spin.filter(|_| rests) {
            Some([.., rate]) => {
                let parts = n.iter().map(|part| self.times(rate, *part, span));
                let parts: Option<Vec<Scalar>> = parts.collect();
                parts?.try_into().ok()
            }
            None => None,
        };
        Some(Value::Matrix(Matrix { rows, spin }))
    }

    /// The unit vector along a vector of three components.
    fn direction(&mut self, axis: &Expr) -> Option<[Scalar; 3]> {
        let value = self.evaluate(axis)?.operand();
        let Some(parts) = value.as_vector().filter(|parts| parts.len() == 3) else {
            let message = format!(
                "the axis of a rotation is a vector in space, this is {}",
                value.shape()
            );
            let error = Diagnostic::error(axis.span, message);
            return self
                .report(error.help("write `rot([0, 0, 1], angle)`, in the plane `rot(angle)`"));
        };
        let parts = parts.clone();
        let square = self.inner(&parts, &parts, axis.span)?;
        if self.graph.is_zero(square.id) {
            let error = Diagnostic::error(axis.span, "this axis has no direction");
            return self.report(error.help("write a vector that is not zero, such as `[0, 0, 1]`"));
        }
        let length = self.graph.function(Function::Sqrt, square.id);
        let length = Scalar::new(length, square.unit.power(0.5));
        let unit = |part: Scalar| part.unit.times(length.unit.power(-1.0));
        let along = parts
            .iter()
            .map(|part| Scalar::new(self.graph.div(part.id, length.id), unit(*part)));
        let along: Vec<Scalar> = along.collect();
        along.try_into().ok()
    }

    /// `quat(e0, e1, e2, e3)`: the rotation with given Euler parameters, valid on
    /// the unit sphere; quadratic and homogeneous in them.
    pub fn quaternion(&mut self, arguments: &[Expr], span: Span) -> Option<Value> {
        let mut e = Vec::new();
        for argument in arguments {
            let part = self.scalar(argument, "an Euler parameter");
            e.push(part.map(|part| (part, argument.span)));
        }
        let e = e.into_iter().collect::<Option<Vec<_>>>()?;
        for (part, place) in &e {
            self.pure(part.unit, "an Euler parameter", *place)?;
        }
        let e: Vec<Scalar> = e.into_iter().map(|(part, _)| part).collect();
        let (vector, real) = ([e[1], e[2], e[3]], e[0]);
        let mut rows = vec![Vec::new(); 3];
        for (i, row) in rows.iter_mut().enumerate() {
            for j in 0..3 {
                row.push(self.quaternion_entry(real, &vector, i, j, span)?);
            }
        }
        Some(Value::Matrix(Matrix {
            rows,
            spin: self.quaternion_spin(real, &vector, span),
        }))
    }

    /// The entry of (e₀² − eᵀe) E + 2 e eᵀ + 2 e₀ ẽ.
    fn quaternion_entry(
        &mut self,
        real: Scalar,
        vector: &[Scalar; 3],
        i: usize,
        j: usize,
        span: Span,
    ) -> Option<Scalar> {
        let product = self.times(vector[i], vector[j], span)?;
        let mut terms = Vec::new();
        if i == j {
            terms.push((self.times(real, real, span)?, 1));
            for (k, part) in vector.iter().enumerate() {
                terms.push((self.times(*part, *part, span)?, if k == i { 1 } else { -1 }));
            }
        } else {
            let other = self.times(real, vector[3 - i - j], span)?;
            let cyclic = (i + 1) % 3 == j;
            terms.push((product, 2));
            terms.push((other, if cyclic { -2 } else { 2 }));
        }
        let unit = product.unit;
        let terms: Vec<_> = terms
            .iter()
            .map(|(s, weight)| (s.id, Number::integer(*weight)))
            .collect();
        Some(Scalar::new(
            self.graph.weighted_sum(Number::ZERO, &terms),
            unit,
        ))
    }

    /// 2 Ē(e) ė = 2 (e₀ ė − ė₀ e − e × ė), bilinear.
    fn quaternion_spin(
        &mut self,
        real: Scalar,
        vector: &[Scalar; 3],
        span: Span,
    ) -> Option<[Scalar; 3]> {
        for part in [real, vector[0], vector[1], vector[2]] {
            let analysis = self.analysis(part.id);
            if analysis.velocity() || analysis.input {
                return None;
            }
        }
        let real_rate = self.rate(real, span)?;
        let rates = vector
            .iter()
            .map(|part| self.rate(*part, span))
            .collect::<Option<Vec<_>>>()?;
        let mut spin = Vec::new();
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let terms = [
                (self.times(real, rates[i], span)?, 2),
                (self.times(vector[i], real_rate, span)?, -2),
                (self.times(vector[j], rates[k], span)?, -2),
                (self.times(vector[k], rates[j], span)?, 2),
            ];
            let unit = terms.iter().fold(Unit::Number, |unit, (s, _)| {
                unit.meet(s.unit).unwrap_or(unit)
            });
            let weighted: Vec<_> = terms
                .iter()
                .map(|(s, w)| (s.id, Number::integer(*w)))
                .collect();
            spin.push(Scalar::new(
                self.graph.weighted_sum(Number::ZERO, &weighted),
                unit,
            ));
        }
        spin.try_into().ok()
    }

    /// `omega(R)`: what was carried along, or the vector of RᵀṘ; in the plane a number.
    pub fn angular_velocity(&mut self, m: &Matrix, span: Span) -> Option<Value> {
        for entry in m.rows.iter().flatten() {
            self.pure(entry.unit, "an entry of a rotation", span)?;
        }
        let plane = m.rows.len() == 2;
        match m.spin {
            Some([.., spin]) if plane => return Some(Value::Scalar(spin)),
            Some(spin) => return Some(Value::Vector(spin.to_vec())),
            None => {}
        }
        let Value::Matrix(rate) = self.derivative(&Value::Matrix(m.clone()), span)? else {
            return None;
        };
        let (columns, rates) = (transposed(&m.rows), transposed(&rate.rows));
        let mut part = |(i, j): (usize, usize)| {
            let entry = self.inner(&columns[i], &rates[j], span)?;
            let unit = entry
                .unit
                .meet(Unit::Known(PER_SECOND))
                .unwrap_or(entry.unit);
            Some(Scalar { unit, ..entry })
        };
        if plane {
            return part((1, 0)).map(Value::Scalar);
        }
        let parts = [(2, 1), (0, 2), (1, 0)].map(part);
        parts.into_iter().collect::<Option<_>>().map(Value::Vector)
    }
}
