//! States of the first order: `state z: m; der(z) = goal - x;`.
//!
//! In:  statements that give rates.
//! Out: forces. A state is the velocity of a coordinate of mass one, which nothing else
//!      contains; the force at it is the rate of the state.

use super::Force;
use super::lowering::Lowering;
use super::symbol::{Node, Symbol};
use super::unit::{Dimension, PER_SECOND, Unit};
use super::value::Scalar;
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::ExprId;
use crate::syntax::ast::Expr;
use crate::syntax::messages::{GIVEN, REMOVE_ONE};

impl Lowering<'_> {
    /// `der(of) = value`
    pub fn state_rate(&mut self, of: &Expr, value: &Expr, span: Span) -> Option<()> {
        let states = self.evaluator.evaluate(of)?.operand();
        for state in states.scalars() {
            // A state whose rate is wrong has one all the same.
            self.one_rate(state.id, of, span)?;
        }
        let rates = self.evaluator.evaluate(value)?.operand();
        self.without_acceleration(value, &rates.scalars(), "the rate of a state")?;
        if !states.same_shape(&rates) {
            let message = format!("this is {}, its rate {}", states.shape(), rates.shape());
            let error = Diagnostic::error(of.span.to(value.span), message);
            return self.report(
                error.help("give each number of a state a rate of its own: `der(z[0]) = …;`"),
            );
        }
        for (state, rate) in states.scalars().into_iter().zip(rates.scalars()) {
            let per_second = Scalar {
                unit: state.unit.times(Unit::Known(PER_SECOND)),
                ..state
            };
            if let Err((wanted, found)) = per_second.unit.meet(rate.unit) {
                return self.not_per_second([wanted, found], value.span);
            }
            let force = vec![self.evaluator.valid(rate.id, value.span)?];
            self.mechanism.forces.push(Force {
                force,
                on: vec![state.id],
                on_velocity: true,
                span: self.place_of(span),
            });
        }
        Some(())
    }

    /// Says that the rate of a state is in another unit than that of the state per second.
    fn not_per_second(&mut self, [wanted, found]: [Dimension; 2], span: Span) -> Option<()> {
        let message = format!(
            "the rate of this state is in {}, this is in {}",
            wanted.text(),
            found.text()
        );
        let error = Diagnostic::error(span, message);
        let factor = found.power(-1.0).map(|found| wanted.times(found).text());
        self.report(error.maybe_help(
            factor.map(|unit| {
                format!("a factor that is missing is declared: `const a: {unit} = …;`")
            }),
        ))
    }

    /// Takes note that the rate of a state is given; refuses a second one.
    fn one_rate(&mut self, state: ExprId, of: &Expr, span: Span) -> Option<()> {
        let coordinate = self.state_of(state, of)?;
        match self.named.rates.insert(coordinate, self.place_of(span)) {
            Some(first) => {
                let error = Diagnostic::error(span, "this state has a rate already");
                self.report(error.also(first, GIVEN).help(REMOVE_ONE))
            }
            None => Some(()),
        }
    }

    /// The coordinate whose velocity a state is.
    fn state_of(&mut self, state: ExprId, of: &Expr) -> Option<u32> {
        let freedoms = self.mechanism.freedoms() as u32;
        match self.evaluator.graph.node(state) {
            Node::Symbol(Symbol::Velocity(i)) if *i >= freedoms => Some(*i),
            Node::Symbol(Symbol::Coordinate(_)) => {
                let error = Diagnostic::error(of.span, "this is a coordinate, not a state");
                self.report(error.help(
                    "how coordinates move follows from energies and forces; what is prescribed \
                     is a `constraint`; a quantity with a rate of its own is a `state`",
                ))
            }
            _ => {
                let error = Diagnostic::error(of.span, "only a state has a rate that is written");
                self.report(error.help("declare it: `state z: m; der(z) = …;`"))
            }
        }
    }

    /// Refuses states whose rates are not given.
    pub fn states_without_rate(&mut self) {
        if self.named.cut_short {
            return;
        }
        let m = &self.mechanism;
        let states = m.coordinates.iter().enumerate().skip(m.freedoms());
        let lacking = states.filter(|(i, _)| !self.named.rates.contains_key(&(*i as u32)));
        let lacking: Vec<_> = lacking.map(|(_, q)| (q.name.clone(), q.span)).collect();
        for (name, span) in lacking {
            let error = Diagnostic::error(span, format!("the state `{name}` has no rate"));
            self.report::<()>(error.help(format!("write `der({name}) = …;`")));
        }
    }
}
