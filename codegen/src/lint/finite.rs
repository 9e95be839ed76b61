//! Statements that have no value, or no derivative, where the motion begins.

use super::numbers::{Numbers, Place};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::expr::ExprId;
use crate::model::{Mechanism, Symbol};

const VALUE: &str = "this is not finite at the start";
const VALUE_HELP: &str = "a divisor is zero there, or a root, a power or a logarithm has no value";
const RATE: &str = "this has no finite derivative at the start";
const RATE_HELP: &str = "the norm of a zero vector, the root of zero and the angle of the point (0, 0) \
                         have none: begin elsewhere, or write `norm2`";

/// A statement: what has to be finite, and what has to have finite derivatives too.
struct Statement {
    span: Span,
    values: Vec<ExprId>,
    smooth: Vec<ExprId>,
    /// What has to have finite derivatives by the velocities, at those with which the motion
    /// begins.
    dissipated: Option<ExprId>,
}

/// Warns of statements that have no finite value or derivative at the assembled start; of
/// constraints also where that keeps the start from being assembled.
pub fn statements(numbers: &Numbers, found: &mut Diagnostics) {
    match numbers.assembled() {
        Some(place) => warn(numbers, list(numbers.mechanism), &place, found),
        // Formulas that are guesses move the others before anything is assembled.
        None if numbers.mechanism.start_guesses.is_empty() => {
            let (guess, _) = numbers.start();
            if guess.q.iter().all(|q| q.is_finite()) {
                warn(numbers, rows(numbers.mechanism), &guess, found);
            }
        }
        None => {}
    }
}

fn warn(numbers: &Numbers, list: Vec<Statement>, place: &Place, found: &mut Diagnostics) {
    let n = numbers.mechanism.coordinates.len();
    let v = velocities(numbers, place);
    let beginning = numbers.beginning(place);
    let mut graph = numbers.mechanism.graph.clone();
    let indices = || (0..n).filter_map(|i| u32::try_from(i).ok());
    let moving = indices().map(Symbol::Coordinate);
    let mut flow = graph.frozen_flow(moving.chain([Symbol::Time]));
    let mut rates = |e: &ExprId| graph.derivative_along(*e, &mut flow);
    let rates: Vec<Vec<ExprId>> = list
        .iter()
        .map(|statement| statement.smooth.iter().map(&mut rates).collect())
        .collect();
    let mut forces = |e: ExprId| -> Vec<ExprId> {
        let velocities = indices().map(Symbol::Velocity);
        velocities.map(|v| graph.differentiate(e, v)).collect()
    };
    let forces: Vec<Vec<ExprId>> = list
        .iter()
        .map(|statement| statement.dissipated.map_or_else(Vec::new, &mut forces))
        .collect();
    let numbers = numbers.grown(&graph);
    for ((statement, rates), forces) in list.iter().zip(rates).zip(forces) {
        let finite = |roots: &[ExprId]| is_finite(&numbers, roots, place, &v);
        let begins = |v: &Vec<f64>| is_finite(&numbers, &forces, place, v);
        let (message, help) = if !finite(&statement.values) || !finite(&statement.smooth) {
            (VALUE, VALUE_HELP)
        } else if !finite(&rates) || !beginning.as_ref().is_none_or(begins) {
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
    let energies = energies.map(|summand| smooth(summand.span, summand.value));
    let dissipation = mechanism.dissipation.iter().map(|summand| Statement {
        dissipated: Some(summand.value),
        ..smooth(summand.span, summand.value)
    });
    let forces = mechanism.forces.iter().map(|force| Statement {
        span: force.span,
        values: force.force.clone(),
        smooth: force.on.clone(),
        dissipated: None,
    });
    let plain = |span, value| Statement {
        span,
        values: vec![value],
        smooth: Vec::new(),
        dissipated: None,
    };
    let inputs = mechanism.inputs.iter();
    let inputs = inputs.map(|input| plain(input.quantity.span, input.law));
    let outputs = mechanism.outputs.iter();
    let outputs = outputs.map(|output| plain(output.quantity.span, output.value));
    let events = mechanism.events.iter();
    let events = events.map(|event| plain(event.span, event.value));
    let all = energies.chain(dissipation).chain(rows(mechanism));
    let all = all.chain(forces).chain(inputs);
    all.chain(outputs).chain(events).collect()
}

/// The constraints and the equations of the start.
fn rows(mechanism: &Mechanism) -> Vec<Statement> {
    let rows = mechanism.constraints.iter();
    let rows = rows.chain(&mechanism.start_equations);
    rows.map(|row| smooth(row.span, row.residual)).collect()
}

fn smooth(span: Span, value: ExprId) -> Statement {
    Statement {
        span,
        values: Vec::new(),
        smooth: vec![value],
        dissipated: None,
    }
}
