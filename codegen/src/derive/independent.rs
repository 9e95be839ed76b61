//! Constraint rows that are independent by their form.
//!
//! In:  the constraints `g`, their Jacobian `A`.
//! Out: whether the rows of `A` are independent wherever the constraints hold.
//!
//! In a combination of rows that vanishes, a row has the coefficient zero if its entries are
//! never all zero in the columns in which the other rows have none. That is so of
//!
//! - a number, such as that of `x` in `x = l cos φ`;
//! - the sine and the cosine of one angle, such as those of a skate, `ẋ sin φ = ẏ cos φ`;
//! - the gradient of `Σ cⱼ qⱼ² = d ≠ 0`, such as that of the norm of Euler parameters: where
//!   it holds, one of the coordinates is not zero.
//!
//! Such rows are set aside, and the others are examined in the same way, until none is left or
//! none qualifies. Independence that depends on values of parameters is not recognised.

use super::equations::Equations;
use crate::expr::{ExprId, Function};
use crate::model::{Graph, Node, Symbol};

impl Equations {
    /// Whether the rows of `A` are independent at every position where the constraints hold.
    pub fn are_independent(&self, graph: &Graph) -> bool {
        let entries = |row: &Vec<ExprId>| {
            let columns = row.iter().enumerate();
            let columns = columns.filter(|(_, entry)| !graph.is_zero(**entry));
            columns.map(|(j, entry)| (j, *entry)).collect()
        };
        let rows: Vec<Vec<(usize, ExprId)>> = self.jacobian.iter().map(entries).collect();
        // For each coordinate, the number of the rows left that contain it.
        let mut shared = vec![0_usize; self.force.len()];
        for (j, _) in rows.iter().flatten() {
            shared[*j] += 1;
        }
        let mut left: Vec<usize> = (0..rows.len()).collect();
        loop {
            let before = left.len();
            // From the last row to the first: descriptions go from the ground outwards, and only
            // the outermost bodies have coordinates in no other row.
            for row in left.clone().into_iter().rev() {
                let own = |j: usize| shared[j] == 1;
                let entries = rows[row].iter().filter(|(j, _)| own(*j));
                let entries: Vec<ExprId> = entries.map(|(_, entry)| *entry).collect();
                let is_number = |entry: &ExprId| graph.as_number(*entry).is_some();
                if entries.iter().any(is_number)
                    || turn(graph, &entries)
                    || is_of_squares(graph, self.residual[row], own)
                {
                    left.retain(|other| *other != row);
                    rows[row].iter().for_each(|(j, _)| shared[*j] -= 1);
                }
            }
            if left.is_empty() || left.len() == before {
                return left.is_empty();
            }
        }
    }
}

/// Whether an equation is `Σ cⱼ qⱼ² = d ≠ 0` of coordinates of its own, with numbers `cⱼ` and
/// `d`.
fn is_of_squares(graph: &Graph, residual: ExprId, own: impl Fn(usize) -> bool) -> bool {
    are_squares(graph, residual, &own) && graph.evaluate(residual, &|_| 0.0) != 0.0
}

/// Whether an expression is made of numbers and of squares of such coordinates.
fn are_squares(graph: &Graph, e: ExprId, own: &dyn Fn(usize) -> bool) -> bool {
    match graph.node(e) {
        Node::Number(_) => true,
        Node::Sum(_, terms) => terms.iter().all(|(term, _)| are_squares(graph, *term, own)),
        Node::Product(factors) => match factors.as_ref() {
            [(base, 2)] => is_own(graph, *base, own),
            _ => false,
        },
        _ => false,
    }
}

/// Whether an expression is such a coordinate.
fn is_own(graph: &Graph, e: ExprId, own: &dyn Fn(usize) -> bool) -> bool {
    match graph.node(e) {
        Node::Symbol(Symbol::Coordinate(j)) => own(*j as usize),
        _ => false,
    }
}

/// Whether two entries are numbers times the sine and the cosine of one angle, which are
/// never zero together.
fn turn(graph: &Graph, entries: &[ExprId]) -> bool {
    let angles = |function| {
        let of = move |e: &ExprId| match graph.node(unscaled(graph, *e)) {
            Node::Function(name, angle) if *name == function => Some(*angle),
            _ => None,
        };
        entries.iter().filter_map(of)
    };
    angles(Function::Sin).any(|angle| angles(Function::Cos).any(|other| other == angle))
}

/// An expression without a number that it is multiplied by.
fn unscaled(graph: &Graph, e: ExprId) -> ExprId {
    match graph.node(e) {
        Node::Sum(constant, terms) if constant.is_zero() => match terms.as_ref() {
            [(term, _)] => *term,
            _ => e,
        },
        _ => e,
    }
}
