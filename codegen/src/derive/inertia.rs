//! Inertia forces `M q̈`, from body to body.
//!
//! In:  a kinetic energy in velocities that bodies share.
//! Out: `M q̈`, in as many expressions as there are bodies, where `M` has many more entries.
//!
//! In a chain `M` has an entry for each pair of bodies, and code that writes all of them is
//! as long. Code for a product with `M` is not: a forward sweep finds each shared acceleration
//! from those before it, and a backward sweep passes the inertia forces on, from the last body
//! to the first: `M q̈ = Jᵀ (M̃ (J q̈))`. These are the sweeps of the recursive Newton–Euler
//! algorithm without velocities and forces (Featherstone, Rigid Body Dynamics Algorithms
//! (2008), section 5.3); columns of `M` are its results for unit accelerations (section 6.1).

use super::composite::{of_coordinates, parts};
use super::equations::Matrix;
use super::gradient::against;
use super::reduced::Reduced;
use crate::expr::{Arithmetic, ExprId};
use crate::model::{Graph, Symbol};

/// The fewest coordinates of a long chain. In a shorter one `M` has fewer entries than there
/// is other work, and entry by entry it takes fewer instructions.
pub(super) const LONG_CHAIN: usize = 32;

/// `M q̈` of `n` coordinates; none where they are few, or where writing a triangle of `M` is
/// no longer: an entry takes a product or two, and so does a coefficient of the sweeps.
pub(super) fn inertia(graph: &mut Graph, reduced: &Reduced, n: usize) -> Option<Vec<ExprId>> {
    let (count, coefficients) = (reduced.count, reduced.mass.len() + reduced.links.len());
    if n < LONG_CHAIN || entries_of(reduced, n) < coefficients {
        return None;
    }
    let parts = parts(reduced);
    let mut rates: Vec<Option<ExprId>> = vec![None; count];
    let own = (0..).map(Symbol::Acceleration).take(n);
    rates.extend(own.map(|symbol| Some(graph.symbol(symbol))));
    for (place, parts) in parts.iter().enumerate() {
        rates[place] = combination(graph, parts.iter().map(|&(i, g)| (Some(g), rates[i])));
    }
    let mut rows = vec![Vec::new(); count + n];
    for &(row, place, entry) in &reduced.mass {
        rows[row].push((Some(entry), rates[place]));
    }
    for place in (0..count).rev() {
        let force = combination(graph, std::mem::take(&mut rows[place]).into_iter());
        for &(i, g) in &parts[place] {
            rows[i].push((Some(g), force));
        }
    }
    let zero = graph.integer(0);
    let rows = rows.drain(count..);
    Some(
        rows.map(|row| combination(graph, row.into_iter()).unwrap_or(zero))
            .collect(),
    )
}

/// `M q̈`: derived by itself, or else the product with the entries of `M`.
pub(super) fn product(
    graph: &mut Graph,
    inertia: Option<&Vec<ExprId>>,
    mass: Option<&Matrix>,
) -> Vec<ExprId> {
    let of_entries = |row: &Vec<ExprId>| against(graph, row, Symbol::Acceleration);
    match inertia {
        Some(inertia) => inertia.clone(),
        None => mass.into_iter().flatten().map(of_entries).collect(),
    }
}

/// `Σ g x`.
fn combination(
    graph: &mut Graph,
    terms: impl Iterator<Item = (Option<ExprId>, Option<ExprId>)>,
) -> Option<ExprId> {
    let products: Vec<ExprId> = terms.filter_map(|(g, x)| Some(graph.mul(g?, x?))).collect();
    Some(graph.sum(products)).filter(|sum| !graph.is_zero(*sum))
}

/// How many entries of a triangle of `M` can differ from zero.
fn entries_of(reduced: &Reduced, n: usize) -> usize {
    let rest = of_coordinates(&mut Structure, reduced, n, |_| ());
    let own = reduced.count..reduced.count + n;
    let triangle = own
        .clone()
        .flat_map(|i| (own.start..=i).map(move |j| (i, j)));
    triangle
        .filter(|&(i, j)| rest.entry(i, j).is_some())
        .count()
}

/// Arithmetic that knows what is zero by structure, and nothing else.
struct Structure;

impl Arithmetic for Structure {
    type Value = ();

    fn plus(&mut self, x: Option<()>, y: Option<()>) -> Option<()> {
        x.or(y)
    }

    fn plus_product(&mut self, x: Option<()>, a: Option<()>, b: Option<()>) -> Option<()> {
        x.or(a.and(b))
    }
}
