//! The kinetic energy in velocities that bodies have in common.
//!
//! In:  a kinetic energy.
//! Out: [`Reduced`]: its mass matrix in these velocities `w` and in those of the coordinates,
//!      with an entry for each pair that meets in a body only, and what each `w` is made of.

use crate::expr::ExprId;
use crate::model::{Graph, Node, Symbol};
use rustc_hash::FxHashMap;

/// Entries of a matrix, by row and column.
pub type Entries = Vec<(usize, usize, ExprId)>;

/// A kinetic energy in shared velocities. Of all velocities `u`, they come first.
pub(super) struct Reduced {
    /// How many velocities are shared.
    pub count: usize,
    /// `M̃`, both triangles.
    pub mass: Entries,
    /// `L` of `w = L u`; each is made of those before it and of velocities of coordinates.
    pub links: Entries,
}

/// The degree of what is no polynomial of the velocities, or one beyond a square.
const BEYOND: i32 = 3;

impl Reduced {
    /// A kinetic energy of `n` coordinates; none where no velocities are shared, or where
    /// masses depend on velocities.
    pub fn of(graph: &mut Graph, kinetic: ExprId, n: usize) -> Option<Self> {
        let (reduced, shared) = in_shared(graph, kinetic, n);
        let count = shared.len();
        if count == 0 {
            return None;
        }
        let place = |velocity: usize| match velocity.checked_sub(n) {
            Some(shared) => shared,
            None => count + velocity,
        };
        let mut mass = Entries::new();
        for (symbol, momentum) in graph.gradient(reduced) {
            let Symbol::Velocity(velocity) = symbol else {
                continue;
            };
            let row = place(velocity as usize);
            for (column, entry) in slopes(graph, momentum)? {
                mass.push((row, place(column), entry));
            }
        }
        let mut links = Entries::new();
        for (row, velocity) in shared.into_iter().enumerate() {
            for (column, entry) in slopes(graph, velocity)? {
                links.push((row, place(column), entry));
            }
        }
        Some(Self { count, mass, links })
    }
}

/// An energy in which sums of velocities that occur more than once are replaced by symbols, the
/// velocities after the first `n`; and these sums.
fn in_shared(graph: &mut Graph, energy: ExprId, n: usize) -> (ExprId, Vec<ExprId>) {
    let nodes = graph.reachable(&[energy]);
    let mut uses: FxHashMap<ExprId, usize> = FxHashMap::default();
    let mut degrees: FxHashMap<ExprId, i32> = FxHashMap::default();
    for &e in &nodes {
        let node = graph.node(e);
        node.for_each_child(&mut |child| *uses.entry(child).or_default() += 1);
        degrees.insert(e, degree(node, &degrees));
    }
    let mut links = Vec::new();
    let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for e in nodes {
        let mut rebuilt = graph.rebuild(e, &|child| known[&child]);
        let is_sum = matches!(graph.node(e), Node::Sum(..));
        if is_sum && degrees[&e] == 1 && uses.get(&e).is_some_and(|uses| *uses > 1) {
            let next = u32::try_from(n + links.len()).unwrap_or(u32::MAX);
            links.push(rebuilt);
            rebuilt = graph.symbol(Symbol::Velocity(next));
        }
        known.insert(e, rebuilt);
    }
    (known[&energy], links)
}

/// The degree of a node in the velocities, from those of its parts.
fn degree(node: &Node, known: &FxHashMap<ExprId, i32>) -> i32 {
    match node {
        Node::Symbol(Symbol::Velocity(_)) => 1,
        Node::Sum(_, terms) => terms.iter().map(|(term, _)| known[term]).fold(0, i32::max),
        Node::Product(factors) => {
            let degree = |(base, exponent): &(ExprId, i32)| match known[base] {
                0 => 0,
                degree if *exponent > 0 => degree.saturating_mul(*exponent),
                _ => BEYOND,
            };
            let whole = factors.iter().map(degree).fold(0, i32::saturating_add);
            whole.min(BEYOND)
        }
        other => {
            let moves = other.children().iter().any(|child| known[child] > 0);
            if moves { BEYOND } else { 0 }
        }
    }
}

/// How an expression changes with each velocity that it contains; none where that depends on
/// velocities.
fn slopes(graph: &mut Graph, e: ExprId) -> Option<Vec<(usize, ExprId)>> {
    let is_velocity = |symbol: &Symbol| matches!(symbol, Symbol::Velocity(_));
    let mut slopes = Vec::new();
    for symbol in graph.symbols(e) {
        let Symbol::Velocity(velocity) = symbol else {
            continue;
        };
        let slope = graph.differentiate(e, symbol);
        if graph.symbols(slope).iter().any(is_velocity) {
            return None;
        }
        if !graph.is_zero(slope) {
            slopes.push((velocity as usize, slope));
        }
    }
    Some(slopes)
}
