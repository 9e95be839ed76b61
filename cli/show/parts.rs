//! Parts of a mechanism that nothing ties to one another.
//!
//! In:  the equations of motion.
//! Out: coordinates by part: those of one part enter no equation of another.

use bricard_codegen::internals::derive::{Equations, Partition};
use bricard_codegen::internals::expr::{ExprId, Graph, Symbol};

/// The coordinates of each part, in their order.
pub fn parts(graph: &Graph, equations: &Equations) -> Vec<Vec<usize>> {
    let (n, _) = equations.sizes();
    let mut partition = Partition::of(n);
    let moving = |entry: &ExprId| {
        let symbols = graph.symbols(*entry).into_iter();
        symbols.filter_map(|symbol| match symbol {
            Symbol::Coordinate(i) | Symbol::Velocity(i) | Symbol::Acceleration(i) => {
                Some(i as usize)
            }
            _ => None,
        })
    };
    for (i, inertia) in equations.inertia.iter().flatten().enumerate() {
        partition.join(moving(inertia).chain([i]));
    }
    for (i, row) in equations.mass.iter().flatten().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            if !graph.is_zero(*entry) {
                partition.join(moving(entry).chain([i, j]));
            }
        }
    }
    for (i, force) in equations.force.iter().enumerate() {
        partition.join(moving(force).chain([i]));
    }
    for (row, bias) in equations.jacobian.iter().zip(&equations.bias) {
        let present = (0..n).filter(|j| !graph.is_zero(row[*j]));
        partition.join(row.iter().chain([bias]).flat_map(moving).chain(present));
    }
    partition.sets()
}
