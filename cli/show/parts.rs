//! Parts of a mechanism that nothing ties to one another.
//!
//! In:  the equations of motion.
//! Out: coordinates by part: those of one part enter no equation of another.

use bricard_codegen::internals::derive::Equations;
use bricard_codegen::internals::expr::{ExprId, Graph, Symbol};

/// The coordinates of each part, in their order.
pub fn parts(graph: &Graph, equations: &Equations) -> Vec<Vec<usize>> {
    let (n, _) = equations.sizes();
    let mut part: Vec<usize> = (0..n).collect();
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
        let together: Vec<usize> = moving(inertia).chain([i]).collect();
        join(&mut part, &together);
    }
    for (i, row) in equations.mass.iter().flatten().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            if !graph.is_zero(*entry) {
                let together: Vec<usize> = moving(entry).chain([i, j]).collect();
                join(&mut part, &together);
            }
        }
    }
    for (i, force) in equations.force.iter().enumerate() {
        let together: Vec<usize> = moving(force).chain([i]).collect();
        join(&mut part, &together);
    }
    for (row, bias) in equations.jacobian.iter().zip(&equations.bias) {
        let present = (0..n).filter(|j| !graph.is_zero(row[*j]));
        let together: Vec<usize> = row
            .iter()
            .chain([bias])
            .flat_map(moving)
            .chain(present)
            .collect();
        join(&mut part, &together);
    }
    let first = |k: &usize| part[*k] == *k;
    let of = |k: usize| (0..n).filter(|i| part[*i] == k).collect();
    (0..n).filter(first).map(of).collect()
}

/// Puts the parts of some coordinates together. A part is named by its first coordinate.
fn join(part: &mut [usize], together: &[usize]) {
    let named: Vec<usize> = together.iter().map(|i| part[*i]).collect();
    let Some(&least) = named.iter().min() else {
        return;
    };
    for name in part.iter_mut().filter(|name| named.contains(name)) {
        *name = least;
    }
}
