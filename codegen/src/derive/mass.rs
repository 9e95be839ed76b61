//! Generalized momenta `∂T/∂q̇` and the mass matrix `M = ∂²T/∂q̇²` [PH 2.1].

use super::composite;
use super::equations::{Equations, Matrix};
use super::gradient::{Sweep, gradient, velocities};
use super::reduced::Reduced;
use crate::expr::ExprId;
use crate::model::{Graph, Mechanism};

/// `∂T/∂q̇_i`, `N`.
pub(super) fn momenta(graph: &mut Graph, kinetic: ExprId, n: usize, by: Sweep) -> Vec<ExprId> {
    by.gradient(graph, kinetic, velocities(n))
}

/// `M` of a mechanism, whether its `equations` hold the entries or not.
pub fn mass_matrix(mechanism: &mut Mechanism, equations: &Equations) -> Matrix {
    if let Some(mass) = &equations.mass {
        return mass.clone();
    }
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let (graph, kinetic) = (&mut mechanism.graph, equations.energies.kinetic);
    let mut mass = match Reduced::of(graph, kinetic, n) {
        Some(reduced) => composite::mass_matrix(graph, &reduced, n),
        None => {
            let momenta = momenta(graph, kinetic, n, Sweep::Back);
            of_momenta(graph, &momenta)
        }
    };
    set_states(graph, &mut mass, freedoms);
    mass
}

/// Gives states of the first order, which are the velocities of coordinates, a mass of one.
pub(super) fn set_states(graph: &mut Graph, mass: &mut Matrix, freedoms: usize) {
    for (i, row) in mass.iter_mut().enumerate().skip(freedoms) {
        row[i] = graph.integer(1);
    }
}

/// `M_ij = ∂²T/∂q̇_i ∂q̇_j`, `N × N`; the lower triangle is derived, the upper is
/// the same expressions.
pub(super) fn of_momenta(graph: &mut Graph, momenta: &[ExprId]) -> Matrix {
    let n = momenta.len();
    let mut mass: Matrix = vec![Vec::with_capacity(n); n];
    for (i, momentum) in momenta.iter().enumerate() {
        let row = gradient(graph, *momentum, velocities(n).take(i + 1));
        for (j, entry) in row.into_iter().enumerate() {
            mass[i].push(entry);
            if j < i {
                mass[j].push(entry);
            }
        }
    }
    mass
}
