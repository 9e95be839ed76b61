//! The equations of motion linearised about a motion: what implicit integrators need.
//!
//! With `q̈` and the multipliers `λ` given, `ρ₁ = p₁ − M q̈ − Aᵀλ` and `ρ₂ = p₂ − A q̈`
//! vanish. Their derivatives by coordinates and velocities are the right-hand sides of
//! `M δq̈ + Aᵀδλ = ∂ρ₁`, `A δq̈ = ∂ρ₂`, which give those of the acceleration.
//!
//! An input that follows its law changes with the state; one that is held does not.
//! The symbol `Follows` tells them apart.

use super::equations::{Equations, Matrix};
use super::gradient::{against, coordinates, velocities};
use super::inertia::product;
use crate::expr::{Direction, ExprId, Number};
use crate::model::{Graph, Input, Mechanism, Symbol};

/// Derivatives of what is left of the equations of motion.
#[derive(Clone, Debug)]
pub struct Linearisation {
    /// `∂(p₁ − M q̈ − Aᵀλ)/∂q`, `N × N`.
    pub force_by_position: Matrix,
    /// `∂p₁/∂q̇`, `N × N`.
    pub force_by_velocity: Matrix,
    /// `∂(p₂ − A q̈)/∂q`, `R × N`.
    pub row_by_position: Matrix,
    /// `∂p₂/∂q̇`, `R × N`.
    pub row_by_velocity: Matrix,
}

/// The most expressions that linearising may add to those there are.
const EXPRESSIONS_MAX: usize = 30_000;

/// Linearises the equations of motion of a mechanism; none if that takes more
/// expressions than a function should have.
pub fn linearise(mechanism: &mut Mechanism, equations: &Equations) -> Option<Linearisation> {
    let (n, _) = equations.sizes();
    let Mechanism { graph, inputs, .. } = mechanism;
    let forces = forces_left(graph, equations);
    let rows = rows_left(graph, equations);
    let most = graph.len() + EXPRESSIONS_MAX;
    let mut by_position = |left| partials(graph, inputs, left, coordinates(n), most);
    let (force_by_position, row_by_position) = (by_position(&forces)?, by_position(&rows)?);
    let mut by_velocity = |left| partials(graph, inputs, left, velocities(n), most);
    let (force_by_velocity, row_by_velocity) = (by_velocity(&forces)?, by_velocity(&rows)?);
    Some(Linearisation {
        force_by_position,
        force_by_velocity,
        row_by_position,
        row_by_velocity,
    })
}

/// Derivatives of forces, outputs and events.
#[derive(Clone, Debug)]
pub struct Partials {
    /// `∂p₁/∂u`, `N × U` with `U` inputs.
    pub force_by_input: Matrix,
    /// `∂y/∂(q, q̇, q̈, u)`, a row of `3 N + U` for each output.
    pub outputs: Matrix,
    /// Derivatives of the functions of the events by `(q, q̇, q̈, u)`, a row of `3 N + U` for each
    /// event.
    pub events: Matrix,
}

/// Derives what other programs ask for besides [`linearise`]; none if that takes more
/// expressions than a function should have.
pub fn differentiate(mechanism: &mut Mechanism, equations: &Equations) -> Option<Partials> {
    let (n, _) = equations.sizes();
    let outputs: Vec<_> = mechanism.outputs.iter().map(|y| y.value).collect();
    let events: Vec<_> = mechanism.events.iter().map(|e| e.value).collect();
    let Mechanism { graph, inputs, .. } = mechanism;
    let most = graph.len() + EXPRESSIONS_MAX;
    let by_input = || (0..).zip(inputs.iter()).map(|(i, _)| Symbol::Input(i));
    let accelerations = || (0..).map(Symbol::Acceleration).take(n);
    let of_state = || coordinates(n).chain(velocities(n)).chain(accelerations());
    let force_by_input = partials(graph, inputs, &equations.force, by_input(), most)?;
    let mut all = |of: &[ExprId]| partials(graph, inputs, of, of_state().chain(by_input()), most);
    let (outputs, events) = (all(&outputs)?, all(&events)?);
    Some(Partials {
        force_by_input,
        outputs,
        events,
    })
}

/// `p₁ − M q̈ − Aᵀλ`, `N`.
fn forces_left(graph: &mut Graph, equations: &Equations) -> Vec<ExprId> {
    let (inertia, mass) = (equations.inertia.as_ref(), equations.mass.as_ref());
    let inertia = product(graph, inertia, mass);
    let mut left = Vec::new();
    for (i, (&force, inertia)) in equations.force.iter().zip(inertia).enumerate() {
        let column: Vec<ExprId> = equations.jacobian.iter().map(|row| row[i]).collect();
        let reaction = against(graph, &column, Symbol::Multiplier);
        let minus = Number::MINUS_ONE;
        let terms = [(force, Number::ONE), (inertia, minus), (reaction, minus)];
        left.push(graph.weighted_sum(Number::ZERO, &terms));
    }
    left
}

/// `p₂ − A q̈`, `R`.
fn rows_left(graph: &mut Graph, equations: &Equations) -> Vec<ExprId> {
    let mut left = Vec::new();
    for (&bias, row) in equations.bias.iter().zip(&equations.jacobian) {
        let turned = against(graph, row, Symbol::Acceleration);
        left.push(graph.sub(bias, turned));
    }
    left
}

/// `∂e/∂symbol`, a row for each expression, unless the graph becomes too long.
fn partials(
    graph: &mut Graph,
    inputs: &[Input],
    expressions: &[ExprId],
    symbols: impl Iterator<Item = Symbol>,
    most: usize,
) -> Option<Matrix> {
    let zero = graph.integer(0);
    let mut rows: Matrix = vec![Vec::new(); expressions.len()];
    let present: Vec<_> = expressions.iter().map(|&e| graph.symbols(e)).collect();
    for symbol in symbols {
        if graph.len() > most {
            return None;
        }
        let seeds = seeds(graph, inputs, symbol);
        let moving: Vec<Symbol> = seeds.iter().map(|(symbol, _)| *symbol).collect();
        let mut direction = Direction::new(seeds);
        for ((&e, row), present) in expressions.iter().zip(&mut rows).zip(&present) {
            let moves = moving.iter().any(|symbol| present.contains(symbol));
            row.push(match moves {
                true => graph.derivative_along(e, &mut direction),
                false => zero,
            });
        }
    }
    Some(rows)
}

/// A symbol that changes at rate one, with the inputs whose laws contain it.
fn seeds(graph: &mut Graph, inputs: &[Input], symbol: Symbol) -> Vec<(Symbol, ExprId)> {
    let mut seeds = vec![(symbol, graph.integer(1))];
    for (i, input) in (0..).zip(inputs) {
        if graph.depends_on(input.law, symbol) {
            let rate = graph.differentiate(input.law, symbol);
            let follows = graph.symbol(Symbol::Follows(i));
            seeds.push((Symbol::Input(i), graph.mul(follows, rate)));
        }
    }
    seeds
}
