//! Forces where they act: on the velocities that bodies share instead of on coordinates.
//!
//! In:  the rows that say what shared velocities are, and forces on coordinates.
//! Out: forces on all velocities that do the same work.
//!
//! In a chain of joint angles, the angle of a link is a sum of these, so that the force on a
//! joint is a sum over all links behind it, and the contribution of one link is the difference
//! of two such sums. Computed as a difference it is lost in round-off; here the common terms
//! cancel symbolically, before anything is computed.

use crate::expr::{ExprId, Number};
use crate::model::{Graph, Node};
use rustc_hash::FxHashMap;

/// A shared velocity with a part that occurs in no other: the velocity of a coordinate.
struct Link {
    /// Its row.
    row: usize,
    /// The place of the coordinate's velocity among all, and its coefficient.
    own: (usize, Number),
    /// Places and coefficients of the other terms of its sum.
    others: Vec<(usize, Number)>,
}

/// The rows by which forces on coordinates are replaced.
pub(super) struct Local {
    links: Vec<Link>,
    count: usize,
}

impl Local {
    /// The rows of `w = L u`, given by their entries, in which all coefficients are numbers.
    /// The first `count` places belong to the shared velocities.
    pub fn of(graph: &Graph, links: &[(usize, usize, ExprId)], count: usize) -> Self {
        let mut entries: Vec<Vec<(usize, Option<Number>)>> = vec![Vec::new(); count];
        let mut uses: FxHashMap<usize, usize> = FxHashMap::default();
        for &(row, place, entry) in links {
            entries[row].push((place, graph.as_number(entry)));
            *uses.entry(place).or_default() += 1;
        }
        let link = |(row, entries): (usize, Vec<(usize, Option<Number>)>)| {
            let entries = entries.into_iter();
            let numbers = entries.map(|(place, entry)| Some((place, entry?)));
            let mut others: Vec<(usize, Number)> = numbers.collect::<Option<_>>()?;
            let is_own = |(place, _): &(usize, Number)| *place >= count && uses[place] == 1;
            let own = others.iter().position(is_own)?;
            let own = others.remove(own);
            Some(Link { row, own, others })
        };
        Self {
            links: entries.into_iter().enumerate().filter_map(link).collect(),
            count,
        }
    }

    /// Forces on all velocities for forces on coordinates: of `w = g q̇ + Σ g_j u_j` the
    /// force `p` on `q` becomes `p / g` on `w` and `−g_j p / g` on the others.
    pub fn moved(&self, graph: &mut Graph, forces: &[ExprId]) -> Vec<ExprId> {
        let own = forces.iter().map(|force| vec![(*force, Number::ONE)]);
        let mut terms: Vec<Vec<(ExprId, Number)>> = vec![Vec::new(); self.count];
        terms.extend(own);
        for link in &self.links {
            let (place, coefficient) = link.own;
            let Some(inverse) = coefficient.powi(-1) else {
                continue;
            };
            terms[place].clear();
            let force = forces[place - self.count];
            terms[link.row].push((force, inverse));
            for &(other, weight) in &link.others {
                terms[other].push((force, Number::MINUS_ONE * weight * inverse));
            }
        }
        let terms = terms.into_iter();
        terms.map(|terms| opened(graph, terms)).collect()
    }
}

/// A sum in which those inner sums are expanded that share a term with it.
fn opened(graph: &mut Graph, terms: Vec<(ExprId, Number)>) -> ExprId {
    let mut constant = Number::ZERO;
    let mut all = Vec::new();
    for &(term, weight) in &terms {
        match graph.node(term) {
            Node::Sum(number, parts)
                if parts
                    .iter()
                    .any(|(part, _)| terms.iter().any(|(other, _)| other == part)) =>
            {
                constant = constant + *number * weight;
                all.extend(parts.iter().map(|&(part, inner)| (part, inner * weight)));
            }
            _ => all.push((term, weight)),
        }
    }
    graph.weighted_sum(constant, &all)
}
