//! Statements that have no value, or no derivative, where the motion begins.

use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::expr::ExprId;
use crate::model::{Mechanism, Symbol};

const VALUE: &str = "this is not finite at the start";
const VALUE_HELP: &str = "a divisor is zero there, or a root, a power or a logarithm has no value";
const RATE: &str = "this has no finite derivative at the start";
const RATE_HELP: &str =
    "the norm of a zero vector and the root of zero have none: begin elsewhere, or write `norm2`";

/// A statement: what has to be finite, and what has to have finite derivatives too.
struct Statement {
    span: Span,
    values: Vec<ExprId>,
    smooth: Vec<ExprId>,
}

/// Warns of statements that have no finite value or derivative at the assembled start.
pub fn statements(numbers: &Numbers, found: &mut Diagnostics) {
    let Some(place) = numbers.assembled() else {
        return;
    };
    let statements = list(numbers.mechanism);
    let n = numbers.mechanism.coordinates.len();
    let v = velocities(numbers, &place);
    let mut graph = numbers.mechanism.graph.clone();
    let moving = (0..n).filter_map(|i| u32::try_from(i).ok().map(Symbol::Coordinate));
    let mut flow = graph.frozen_flow(moving.chain([Symbol::Time]));
    let rates: Vec<Vec<ExprId>> = statements
        .iter()
        .map(|statement| {
            let smooth = statement.smooth.iter();
            smooth
                .map(|e| graph.derivative_along(*e, &mut flow))
                .collect()
        })
        .collect();
    let numbers = numbers.grown(&graph);
    for (statement, rates) in statements.iter().zip(rates) {
        let finite = |roots: &[ExprId]| is_finite(&numbers, roots, &place, &v);
        let (message, help) = if !finite(&statement.values) || !finite(&statement.smooth) {
            (VALUE, VALUE_HELP)
        } else if !finite(&rates) {
            (RATE, RATE_HELP)
        } else {
            continue;
        };
        found.push(Diagnostic::warning(statement.span, message).help(help));
    }
}

/// Velocities of which no two are alike, so that no derivatives cancel each other; states
/// are where they begin.
fn velocities(numbers: &Numbers, place: &Place) -> Vec<f64> {
    let m = &numbers.mechanism;
    let mut v: Vec<f64> = (0..m.freedoms()).map(|i| 1.0 + 0.3 * i as f64).collect();
    v.resize(m.coordinates.len(), 0.0);
    for start in &m.starts {
        if start.coordinate >= m.freedoms() {
            v[start.coordinate] = numbers.values(&[start.value], place)[0];
        }
    }
    v
}

fn is_finite(numbers: &Numbers, roots: &[ExprId], place: &Place, v: &[f64]) -> bool {
    let values = numbers.moving(roots, place, v);
    values.iter().all(|value| value.is_finite())
}

fn list(mechanism: &Mechanism) -> Vec<Statement> {
    let energies = mechanism.kinetic.iter().chain(&mechanism.potential);
    let smooth = energies
        .chain(&mechanism.dissipation)
        .map(|summand| Statement {
            span: summand.span,
            values: Vec::new(),
            smooth: vec![summand.value],
        });
    let start = &mechanism.start_equations;
    let rows = mechanism.constraints.iter().chain(start);
    let rows = rows.map(|row| Statement {
        span: row.span,
        values: Vec::new(),
        smooth: vec![row.residual],
    });
    let forces = mechanism.forces.iter().map(|force| Statement {
        span: force.span,
        values: force.force.clone(),
        smooth: force.on.clone(),
    });
    let plain = |span, value| Statement {
        span,
        values: vec![value],
        smooth: Vec::new(),
    };
    let inputs = mechanism.inputs.iter();
    let inputs = inputs.map(|input| plain(input.quantity.span, input.law));
    let outputs = mechanism.outputs.iter();
    let outputs = outputs.map(|output| plain(output.quantity.span, output.value));
    let events = mechanism.events.iter();
    let events = events.map(|event| plain(event.span, event.value));
    let all = smooth.chain(rows).chain(forces).chain(inputs);
    all.chain(outputs).chain(events).collect()
}
