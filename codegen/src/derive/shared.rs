//! The kinetic energy in velocities that bodies share, for solves that need not know how each
//! of them is made of the coordinates' velocities.
//!
//! In:  a mechanism without constraints.
//! Out: [`Shared`]: `T` as a form in the velocities `w` of points that several bodies have in
//!      common and in `q̇`, and how each `w` is made of those before it.
//!
//! In a chain, `M` has an entry for each pair of bodies. With the velocity of each joint as
//! an unknown of its own, each body meets its neighbours only, and elimination goes from
//! body to body, as the recursive methods do. Source: Featherstone, Rigid Body Dynamics
//! Algorithms (2008), section 7.3 ("articulated-body algorithm").
//!
//! `(w, q̇) = J q̇` and `M = Jᵀ M̃ J`, so that `M q̈ = p₁` is part of
//! `[M̃ Gᵀ; G 0] (x, μ) = (f, 0)` for all `f` with `Jᵀ f = p₁`, where the rows `G` say what
//! each `w` is.

use super::equations::Equations;
use super::force;
use super::gradient::{Sweep, coordinates, rates};
use super::local::Local;
use crate::expr::{ExprId, Graph, Node, Symbol};
use crate::model::Mechanism;
use rustc_hash::FxHashMap;

/// Entries of a matrix, by row and column.
type Entries = Vec<(usize, usize, ExprId)>;

/// A kinetic energy in shared velocities. Of the unknowns, they come first.
#[derive(Clone, Debug)]
pub struct Shared {
    /// How many velocities are shared.
    pub count: usize,
    /// `M̃`, both triangles.
    pub mass: Entries,
    /// `G`, a row for each shared velocity.
    pub links: Entries,
    /// `f`, of all unknowns, with what it has in common computed once.
    pub force: Vec<ExprId>,
}

/// The degree of what is no polynomial of the velocities, or one beyond a square.
const BEYOND: i32 = 3;

/// The kinetic energy in shared velocities; none with constraints, where none are shared, or
/// where masses depend on velocities.
pub fn shared(mechanism: &mut Mechanism, equations: &Equations) -> Option<Shared> {
    if !equations.jacobian.is_empty() {
        return None;
    }
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let graph = &mut mechanism.graph;
    let kinetic = graph.sum(mechanism.kinetic.iter().map(|summand| summand.value));
    let (reduced, links) = in_shared(graph, kinetic, n);
    let count = links.len();
    if count == 0 {
        return None;
    }
    let place = |velocity: usize| match velocity.checked_sub(n) {
        Some(shared) => shared,
        None => count + velocity,
    };
    let mut mass = Entries::new();
    for (symbol, momentum) in graph.adjoints(reduced) {
        let Symbol::Velocity(velocity) = symbol else {
            continue;
        };
        let row = place(velocity as usize);
        for (column, entry) in slopes(graph, momentum)? {
            mass.push((row, place(column), entry));
        }
    }
    let one = graph.integer(1);
    mass.extend((freedoms..n).map(|state| (count + state, count + state, one)));
    let mut rows = Entries::new();
    for (row, link) in links.into_iter().enumerate() {
        rows.push((row, row, graph.neg(one)));
        for (column, entry) in slopes(graph, link)? {
            rows.push((row, place(column), entry));
        }
    }
    let parts = parts(mechanism);
    let graph = &mut mechanism.graph;
    let local = Local::of(graph, &rows, count);
    let parts = parts.map(|part| local.moved(graph, &part));
    let mut force = Vec::with_capacity(count + n);
    for place in 0..count + n {
        let [applied, carried, slope, gravity] = [0, 1, 2, 3].map(|part| parts[part][place]);
        let coriolis = graph.sub(carried, slope);
        force.extend(force::total(graph, &[applied], &[coriolis], &[gravity]));
    }
    Some(Shared {
        count,
        mass,
        links: rows,
        force,
    })
}

/// What `p₁` is made of, as reverse sweeps give it: `Q`, `d/dt ∂T/∂q̇` without what
/// accelerations bring, `∂T/∂q` and `h`.
fn parts(mechanism: &mut Mechanism) -> [Vec<ExprId>; 4] {
    let (n, freedoms) = (mechanism.coordinates.len(), mechanism.freedoms());
    let graph = &mut mechanism.graph;
    let [kinetic, potential, dissipation] = [
        &mechanism.kinetic,
        &mechanism.potential,
        &mechanism.dissipation,
    ]
    .map(|summands| graph.sum(summands.iter().map(|summand| summand.value)));
    let by = Sweep::Back;
    let momenta = super::mass::momenta(graph, kinetic, n, by);
    [
        force::applied(graph, &mechanism.forces, dissipation, (n, freedoms), by),
        rates(graph, &momenta, n),
        by.gradient(graph, kinetic, coordinates(n)),
        force::potential_force(graph, potential, n, by),
    ]
}

/// An energy in which sums of velocities that occur more than once are symbols, the
/// velocities after the first `n`, and what these are.
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
