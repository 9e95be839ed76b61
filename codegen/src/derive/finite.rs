//! Equations with a number in them that no `f64` holds.
//!
//! In:  a mechanism and its equations.
//! Out: an error at the statements from which such a number comes.
//!
//! Each statement is made of finite numbers, but differentiation multiplies them with one
//! another and with exponents, sums of statements add them, and a solve squares the entries of
//! the rows of constraints.
//!
//! Not here: values that become infinite at some states. A run finds those.

use super::equations::Equations;
use super::swell::statements_of_motion;
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::expr::{Direction, ExprId, Number};
use crate::model::{Graph, Mechanism, Symbol};

const HELP: &str = "declare quantities and choose units so that numbers and their products lie \
                    between 1e-308 and 1e308";

/// Checks that all numbers in the equations of motion and in what is computed besides are
/// finite.
///
/// # Errors
///
/// A number that is not finite, at the statements that are responsible.
pub(super) fn check(mechanism: &Mechanism, equations: &Equations) -> Result<(), Diagnostics> {
    let statements = statements(mechanism);
    let besides = statements.iter().flat_map(|(_, parts)| parts.clone());
    let roots: Vec<ExprId> = equations.expressions().into_iter().chain(besides).collect();
    let finite = mechanism.graph.has_finite_numbers(&roots);
    if finite && has_finite_squares(&mechanism.graph, &equations.jacobian.concat()) {
        return Ok(());
    }
    let mut graph = mechanism.graph.clone();
    let mut alone = statements.clone();
    alone.retain(|(span, parts)| {
        let is_row = mechanism.constraints.iter().any(|row| row.span == *span);
        overflows(&mut graph, parts, is_row)
    });
    let mut found = Diagnostics::new();
    if alone.is_empty() {
        found.push(together(&extremes(&graph, statements)));
    }
    for (span, _) in alone {
        let message = "a number in the equations that come of this is not finite";
        found.push(Diagnostic::error(span, message).help(HELP));
    }
    Err(found)
}

/// The error about statements none of which is at fault alone.
fn together(spans: &[Span]) -> Diagnostic {
    let mut spans = spans.iter().copied();
    let first = spans.next().unwrap_or_default();
    let message = "a number in the equations that come of this and other statements is not finite";
    let error = Diagnostic::error(first, message).help(HELP);
    spans.fold(error, |error, span| error.also(span, "and of this"))
}

/// All statements that have formulas, with these formulas.
fn statements(mechanism: &Mechanism) -> Vec<(Span, Vec<ExprId>)> {
    let m = mechanism;
    let rows = m.start_equations.iter().chain(&m.start_guesses);
    let rows = rows.map(|row| (row.span, vec![row.residual]));
    let inputs = m.inputs.iter();
    let inputs = inputs.map(|input| (input.quantity.span, vec![input.law]));
    let starts = m.starts.iter().map(|start| (start.span, vec![start.value]));
    let outputs = m.outputs.iter();
    let outputs = outputs.map(|output| (output.quantity.span, vec![output.value]));
    let events = m.events.iter().map(|event| (event.span, vec![event.value]));
    let all = statements_of_motion(m).chain(rows).chain(inputs);
    all.chain(starts).chain(outputs).chain(events).collect()
}

/// Whether formulas, or their first two derivatives, have a number that is not finite; for
/// constraints, also whether the squares of their slopes have one.
fn overflows(graph: &mut Graph, parts: &[ExprId], is_row: bool) -> bool {
    let moves = |s: &Symbol| {
        matches!(
            s,
            Symbol::Time | Symbol::Coordinate(_) | Symbol::Velocity(_)
        )
    };
    let symbols = parts.iter().flat_map(|e| graph.symbols(*e));
    let symbols: Vec<Symbol> = symbols.filter(moves).collect();
    // Each symbol changes at a rate of its own, so that no derivatives cancel one another.
    let seeds = symbols.iter().zip(0..);
    let seeds = seeds.map(|(s, i)| (*s, graph.symbol(Symbol::Acceleration(i))));
    let mut direction = Direction::new(seeds.collect());
    parts.iter().any(|e| {
        let first = graph.derivative_along(*e, &mut direction);
        let second = graph.derivative_along(first, &mut direction);
        !graph.has_finite_numbers(&[*e, first, second])
            || is_row && !has_finite_squares(graph, &[first])
    })
}

fn has_finite_squares(graph: &Graph, parts: &[ExprId]) -> bool {
    let numbers = graph.numbers(parts);
    numbers.iter().all(|x| (*x * *x).is_finite())
}

/// The statements with the number whose order of magnitude is farthest from one.
fn extremes(graph: &Graph, statements: Vec<(Span, Vec<ExprId>)>) -> Vec<Span> {
    let order = |number: &Number| match number.to_f64() {
        0.0 => 0.0,
        value => value.abs().log10().abs(),
    };
    let most = |parts: &[ExprId]| {
        let numbers = graph.numbers(parts);
        numbers.iter().map(order).fold(0.0, f64::max)
    };
    let orders: Vec<(Span, f64)> = statements
        .into_iter()
        .map(|(span, parts)| (span, most(&parts)))
        .collect();
    let largest = orders.iter().map(|(_, order)| *order).fold(0.0, f64::max);
    let extremes = orders.into_iter().filter(|(_, order)| *order == largest);
    extremes.map(|(span, _)| span).collect()
}
