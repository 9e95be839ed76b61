//! What a formula may contain where it stands.
//!
//! Energies and constraints are differentiated, so they are smooth; the
//! kinetic energy is a polynomial of degree two or less in the velocities, a
//! velocity constraint one of degree one; potentials know no velocities; signals
//! act through forces alone.

use super::analysis::{Analysis, NOT_POLYNOMIAL};
use super::lowering::Lowering;
use super::symbol::Symbol;
use super::unit::{AREA, ENERGY, FREQUENCY2, POWER, Unit};
use super::value::{Scalar, Value};
use crate::diagnostic::{Diagnostic, Span, figure};
use crate::expr::ExprId;
use crate::syntax::ast::{Energy, Expr, ExprKind};

/// What to write where a force works on something else.
const WORKED_ON: &str = "write the coordinate, angle, length or point";

const SMOOTH: &str = "`abs`, `sign`, `min`, `max`, `if` and `table` may stand in forces, inputs, outputs and \
     events; a `spline` is smooth";

const STATES_ACT: &str = "a state acts by `force z on x`; what has kinetic energy is a `coord`";

const TURNING: &str = "what turns has a moment of inertia: `1/2*J*der(q)^2` with J in kg*m^2";
const DER: &str = "is `der` missing? the kinetic energy of a mass is `1/2*m*der(x)^2`";

impl Lowering<'_> {
    /// Checks a summand of an energy.
    pub fn legal_energy(&mut self, kind: Energy, e: &Expr, value: Scalar) -> Option<()> {
        let (what, unit, unit_name) = match kind {
            Energy::Kinetic => ("the kinetic energy", ENERGY, "J"),
            Energy::Potential => ("the potential energy", ENERGY, "J"),
            Energy::Dissipation => ("the dissipation function", POWER, "W"),
        };
        let analysis = self.evaluator.analysis(value.id);
        if analysis.kinked {
            let span = self.culprit(e, |analysis| analysis.kinked);
            let message = format!("{what} has to be smooth, this is non-smooth");
            return self.report(Diagnostic::error(span, message).help(SMOOTH));
        }
        if analysis.input && kind != Energy::Dissipation {
            let span = self.culprit(e, |analysis| analysis.input);
            let message = format!("{what} can't contain an input");
            return self
                .report(Diagnostic::error(span, message).help("an input acts by `force u on x`"));
        }
        if analysis.state && kind != Energy::Dissipation {
            let span = self.culprit(e, |analysis| analysis.state);
            let message = format!("{what} can't contain a state");
            return self.report(Diagnostic::error(span, message).help(STATES_ACT));
        }
        self.legal_velocities(kind, e, analysis)?;
        match value.unit {
            Unit::Known(found) if found != unit => {
                let message = format!("{what} is in {unit_name}, this is in {}", found.text());
                let error = Diagnostic::error(e.span, message);
                let lacking = found.power(-1.0).map(|found| unit.times(found));
                let error = match lacking {
                    Some(FREQUENCY2) if kind == Energy::Kinetic && !analysis.velocity() => {
                        error.help(DER)
                    }
                    Some(AREA) if kind == Energy::Kinetic => error.help(TURNING),
                    _ => error,
                };
                let error = self.evaluator.declare_bare(error, e, [unit, found]);
                self.report(error)
            }
            _ => Some(()),
        }
    }

    fn legal_velocities(&mut self, kind: Energy, e: &Expr, analysis: Analysis) -> Option<()> {
        match kind {
            Energy::Kinetic if analysis.degree >= NOT_POLYNOMIAL => {
                let span = self.culprit(e, |analysis| analysis.degree >= NOT_POLYNOMIAL);
                let error = Diagnostic::error(
                    span,
                    "the kinetic energy has to be quadratic in the velocities",
                );
                let help = "it is a polynomial of degree two or less in `der(…)`";
                self.report(error.help(help))
            }
            Energy::Potential if analysis.velocity() => {
                let span = self.culprit(e, Analysis::velocity);
                let error =
                    Diagnostic::error(span, "the potential energy can't contain a velocity");
                let help = "terms with `der(…)` belong in `kinetic`, losses in `dissipation`";
                self.report(error.help(help))
            }
            // With a constant that is zero nothing is dissipated.
            Energy::Dissipation if !analysis.velocity() && analysis.value != Some(0.0) => {
                let error = Diagnostic::error(e.span, "the dissipation function needs a velocity");
                self.report(error.help("write for example `dissipation 1/2*d*der(q1)^2;`"))
            }
            _ => Some(()),
        }
    }

    /// Checks what a force works on: whether it is a velocity, such as `omega(R)`.
    pub fn legal_target(&mut self, on: &Expr, point: &Value) -> Option<bool> {
        let analysis: Vec<Analysis> = point
            .scalars()
            .iter()
            .map(|s| self.evaluator.analysis(s.id))
            .collect();
        let any = |has: fn(&Analysis) -> bool| analysis.iter().any(has);
        let derivative = matches!(&on.kind, ExprKind::Call(name, _) if name.text == "der");
        let (message, help) = if any(Analysis::velocity) && derivative {
            ("a force can't work on a velocity", WORKED_ON)
        } else if any(|analysis| analysis.degree > 1) {
            (
                "what a moment works on has to be linear in the velocities",
                "write the angular velocity of a body: `force M on omega(R);`",
            )
        } else if any(|analysis| analysis.input) {
            ("a force can't work on an input", WORKED_ON)
        } else if any(|analysis| analysis.state) {
            (
                "a force can't work on a state",
                "write its rate instead: `der(z) = …;`",
            )
        } else if any(|analysis| analysis.kinked) {
            ("what a force works on has to be differentiable", SMOOTH)
        } else if !any(|analysis| analysis.coordinate || analysis.velocity()) {
            (
                "this force does no work: there is no coordinate in what it works on",
                "write what it moves",
            )
        } else {
            return Some(any(Analysis::velocity));
        };
        self.report(Diagnostic::error(on.span, message).help(help))
    }

    /// Checks one row of a constraint: whether it is holonomic, `None` inside if
    /// it says nothing.
    pub fn legal_constraint(
        &mut self,
        residual: ExprId,
        sides: [&Expr; 2],
    ) -> Option<Option<bool>> {
        let analysis = self.evaluator.analysis(residual);
        self.legal_row(analysis, sides)?;
        if self.evaluator.graph.is_zero_everywhere(residual) {
            return Some(None);
        }
        if analysis.coordinate || analysis.velocity() {
            return Some(Some(!analysis.velocity()));
        }
        let whole = sides[0].span.to(sides[1].span);
        match analysis.value {
            // A constant that is made with `max` is not looked at as a function.
            Some(0.0) => Some(None),
            Some(value) => {
                let error = Diagnostic::error(whole, "this equation never holds");
                self.report(error.labelled(format!("left minus right is {}", figure(value))))
            }
            None => {
                let error = Diagnostic::error(whole, "this equation contains no coordinate");
                self.report(error.help("a constraint restricts how coordinates move"))
            }
        }
    }

    fn legal_row(&mut self, analysis: Analysis, sides: [&Expr; 2]) -> Option<()> {
        let (bad, message, help): (fn(&Analysis) -> bool, _, _) = if analysis.kinked {
            let message = "a constraint has to be smooth, this is non-smooth";
            (|analysis| analysis.kinked, message, SMOOTH)
        } else if analysis.input {
            let help = "what is prescribed is written with `t`; an input acts by `force`";
            (
                |analysis| analysis.input,
                "a constraint can't contain an input",
                help,
            )
        } else if analysis.state {
            let message = "a constraint can't contain a state";
            (|analysis| analysis.state, message, STATES_ACT)
        } else if analysis.degree > 1 {
            let help = "write it with `der(…)` of first degree, or for positions";
            (
                |analysis| analysis.degree > 1,
                "a constraint has to be linear in the velocities",
                help,
            )
        } else {
            return Some(());
        };
        let span = self.culprit_of(sides, bad);
        self.report(Diagnostic::error(span, message).help(help))
    }

    /// Refuses accelerations outside outputs.
    pub fn without_acceleration(&mut self, e: &Expr, scalars: &[Scalar], what: &str) -> Option<()> {
        let mut ids = scalars.iter().map(|scalar| scalar.id);
        if !ids.any(|id| self.evaluator.analysis(id).acceleration) {
            return Some(());
        }
        let span = self.culprit(e, |analysis| analysis.acceleration);
        let freedoms = self.mechanism.freedoms() as u32;
        let of_state = |s: &Symbol| !matches!(s, Symbol::Acceleration(i) if *i < freedoms);
        let graph = &self.evaluator.graph;
        if scalars
            .iter()
            .all(|s| graph.symbols(s.id).iter().all(of_state))
        {
            let error =
                Diagnostic::error(span, format!("{what} can't contain `der(…)` of a state"));
            let help = match what {
                "a force" | "an event function" | "the rate of a state" => {
                    "give the formula of that rate a name with `let`, and write the name in both \
                     places"
                }
                _ => STATES_ACT,
            };
            return self.report(error.help(help));
        }
        let error = Diagnostic::error(span, format!("{what} can't contain an acceleration"));
        let help = "accelerations follow from the equations of motion; they may stand in outputs";
        self.report(error.help(help))
    }

    /// The term of a sum that has some property, else the whole.
    fn culprit(&mut self, e: &Expr, bad: impl Fn(&Analysis) -> bool) -> Span {
        self.culprit_in(e, &bad).unwrap_or(e.span)
    }

    fn culprit_of(&mut self, sides: [&Expr; 2], bad: impl Fn(&Analysis) -> bool) -> Span {
        let found = sides
            .into_iter()
            .find_map(|side| self.culprit_in(side, &bad));
        found.unwrap_or(sides[0].span.to(sides[1].span))
    }

    fn culprit_in(&mut self, e: &Expr, bad: &impl Fn(&Analysis) -> bool) -> Option<Span> {
        let only = [(false, e.clone())];
        let terms: &[(bool, Expr)] = match &e.kind {
            ExprKind::Sum(terms) => terms,
            _ => &only,
        };
        terms
            .iter()
            .find(|(_, term)| self.has(term, bad))
            .map(|(_, term)| term.span)
    }

    fn has(&mut self, e: &Expr, bad: &impl Fn(&Analysis) -> bool) -> bool {
        let value = self.evaluator.evaluate(e);
        value.is_some_and(|value| {
            value
                .scalars()
                .iter()
                .any(|scalar| bad(&self.evaluator.analysis(scalar.id)))
        })
    }
}
