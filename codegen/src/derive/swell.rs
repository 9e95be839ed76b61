//! Equations that grew beyond what a compiler takes quickly.
//!
//! In:  a mechanism and its equations.
//! Out: a warning with the counts and the source lines that contribute most, or an
//!      error with the same where there are so many that generating code and compiling
//!      it would not end in a time that anybody waits.

use super::equations::Equations;
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::expr::ExprId;
use crate::model::{EXPRESSIONS_MAX, Graph, Mechanism, Symbol};
use std::collections::BTreeMap;

/// The most distinct expressions in the equations of motion that pass without a
/// word: about what rustc takes ten seconds for.
pub const SWELL: usize = 10_000;

/// The most distinct expressions for each coordinate and each constraint equation that pass without
/// a word: with fewer a mechanism is large, and what it is made of comes again as loops of the
/// generated code.
const SWELL_EACH: usize = 200;

/// How many contributors are named.
const NAMED: usize = 3;

const HELP: &str = "energies written with the velocities of the body itself, from body to \
                    body, stay much shorter than with positions in the world";

/// Nothing once there are more than [`EXPRESSIONS_MAX`] expressions.
pub(super) fn within_bounds(graph: &Graph) -> Option<()> {
    (graph.len() <= EXPRESSIONS_MAX).then_some(())
}

/// The error for a mechanism that has more expressions than [`EXPRESSIONS_MAX`].
pub(super) fn refusal(mechanism: &Mechanism) -> Diagnostics {
    let message = format!(
        "the equations of motion have more than {EXPRESSIONS_MAX} expressions: the code \
         would take too long to compile"
    );
    let shares = shares(mechanism);
    let (first, _) = shares.first().copied().unwrap_or_default();
    let mut found = Diagnostics::new();
    found.push(with_shares(Diagnostic::error(first, message), &shares).help(HELP));
    found
}

/// A warning if the equations of motion have more than [`SWELL`] expressions, and many for the
/// size of the mechanism.
pub fn swell(mechanism: &Mechanism, equations: &Equations) -> Option<Diagnostic> {
    let (size, (n, r)) = (size(mechanism, equations), equations.sizes());
    if size <= SWELL.max(SWELL_EACH * (n + r)) {
        return None;
    }
    let shares = shares(mechanism);
    let (first, _) = shares.first().copied()?;
    let message = format!("the equations of motion have {size} expressions");
    let help = format!("the generated code is long and takes long to compile; {HELP}");
    Some(with_shares(Diagnostic::warning(first, message), &shares).help(help))
}

/// How many distinct expressions the equations of motion have.
pub(super) fn size(mechanism: &Mechanism, equations: &Equations) -> usize {
    mechanism.graph.reachable(&roots(equations)).len()
}

/// Names the largest contributors at their places.
fn with_shares(mut finding: Diagnostic, shares: &[(Span, f64)]) -> Diagnostic {
    for (i, (span, share)) in shares.iter().take(NAMED).enumerate() {
        finding = match i {
            0 => finding.labelled(part(*share)),
            _ => finding.also(*span, part(*share)),
        };
    }
    finding
}

fn part(share: f64) -> String {
    format!("about {:.0} % of it", 100.0 * share)
}

fn roots(equations: &Equations) -> Vec<ExprId> {
    let masses = equations.inertial();
    let rows = equations.jacobian.concat();
    let vectors = [&masses, &rows, &equations.force, &equations.bias];
    vectors.into_iter().flatten().copied().collect()
}

/// The statements that the equations of motion are made of, with their formulas.
pub(super) fn statements_of_motion(
    mechanism: &Mechanism,
) -> impl Iterator<Item = (Span, Vec<ExprId>)> {
    let energies = [
        &mechanism.kinetic,
        &mechanism.potential,
        &mechanism.dissipation,
    ];
    let energies = energies.into_iter().flatten();
    let energies = energies.map(|summand| (summand.span, vec![summand.value]));
    let forces = mechanism.forces.iter();
    let forces = forces.map(|f| (f.span, [f.force.clone(), f.on.clone()].concat()));
    let rows = mechanism.constraints.iter();
    let rows = rows.map(|row| (row.span, vec![row.residual]));
    energies.chain(forces).chain(rows)
}

/// The part that each statement has in the equations, the largest first. What is
/// written once for a loop counts as one.
fn shares(mechanism: &Mechanism) -> Vec<(Span, f64)> {
    let graph = &mechanism.graph;
    let mut lines: BTreeMap<u32, (Span, f64)> = BTreeMap::new();
    for (span, parts) in statements_of_motion(mechanism) {
        let line = lines.entry(span.start.offset).or_insert((span, 0.0));
        line.1 += derived_size(graph, &parts);
    }
    let mut shares: Vec<(Span, f64)> = lines.into_values().collect();
    let total: f64 = shares.iter().map(|(_, size)| size).sum();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    shares.iter_mut().for_each(|(_, size)| *size /= total);
    shares
}

/// About as many expressions as differentiation makes of a formula: those that it has itself, for
/// each coordinate in it.
fn derived_size(graph: &Graph, parts: &[ExprId]) -> f64 {
    let size = graph.reachable(parts).len();
    let is_coordinate = |s: &Symbol| matches!(s, Symbol::Coordinate(_) | Symbol::Velocity(_));
    let count = |e: &ExprId| {
        graph
            .symbols(*e)
            .iter()
            .filter(|s| is_coordinate(s))
            .count()
    };
    let moved: usize = parts.iter().map(count).sum();
    size as f64 * moved.max(1) as f64
}
