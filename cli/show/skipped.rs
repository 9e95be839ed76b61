//! What the generated programs leave out, and what that saves.
//!
//! In:  the equations of motion, their programs.
//! Out: a line for each thing that this mechanism doesn't need, with the operations that
//!      a program for any mechanism of its size would spend on it.

use super::parts::parts;
use bricard_codegen::internals::derive::Equations;
use bricard_codegen::internals::expr::{ExprId, Graph, Symbol};
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::optimise::{Cost, Programs, cost, numbers_apart};
use std::collections::BTreeSet;

/// The section, empty where everything is needed.
pub fn skipped(mechanism: &Mechanism, equations: &Equations, programs: &Programs) -> String {
    let lines = [
        coriolis(&mechanism.graph, equations),
        constant_mass(&mechanism.graph, equations),
        solve(&mechanism.graph, equations, programs),
        repeated(&mechanism.graph, equations),
        numbers(programs),
        time(&mechanism.graph, equations),
        ignorable(mechanism, equations),
        apart(mechanism, equations),
        other_sheets(mechanism, equations),
        folded(mechanism),
        no_constraints(equations),
        independent(&mechanism.graph, equations),
        redundant(mechanism, equations),
        on_request(mechanism, programs),
    ];
    let lines: Vec<String> = lines.into_iter().flatten().collect();
    match lines.is_empty() {
        true => String::new(),
        false => format!("\nleft out\n{}\n", lines.join("\n")),
    }
}

fn counted(operations: usize) -> String {
    plural(operations, "operation", "operations")
}

/// All operations.
fn operations(cost: Cost) -> usize {
    cost.sums + cost.products + cost.quotients + cost.angles + cost.functions
}

fn plural(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

fn zeros<'a>(graph: &Graph, entries: impl Iterator<Item = &'a ExprId>) -> usize {
    entries.filter(|e| graph.is_zero(**e)).count()
}

/// Products `Cᵢⱼ q̇ⱼ` that vanish.
fn coriolis(graph: &Graph, equations: &Equations) -> Option<String> {
    let n = equations.coriolis.len();
    let absent = zeros(graph, equations.coriolis.iter());
    // Christoffel symbols take n²(n + 1)/2 slopes of M; each entry n² products with them.
    let each = 2 * n * n;
    (absent > 0).then(|| match absent == n {
        true => format!("Coriolis terms: there are none; {}", counted(n * each)),
        false => format!(
            "Coriolis terms that are zero, {absent} of {n}; {}",
            counted(absent * each)
        ),
    })
}

/// A mass matrix that is factorised once.
fn constant_mass(graph: &Graph, equations: &Equations) -> Option<String> {
    let (n, _) = equations.sizes();
    equations.has_constant_mass(graph).then(|| {
        format!("slopes of M, and its factorisation but for the first: M is constant; {} a factorisation", counted((n * n * n + 2 * n) / 3))
    })
}

/// What zeros of M and G save in the solve, where it is of the entries of M.
fn solve(graph: &Graph, equations: &Equations, programs: &Programs) -> Option<String> {
    if programs.inertia.is_some() {
        return None;
    }
    let (n, r) = equations.sizes();
    let absent = zeros(graph, equations.inertial().iter())
        + 2 * zeros(graph, equations.jacobian.iter().flatten());
    let solved = operations(cost(&programs.acceleration.as_ref()?.program));
    let spent = solved.saturating_sub(operations(programs.terms.cost));
    // Cholesky factors of M and of G M⁻¹ Gᵀ, products for that, and four substitutions.
    let cube = |k: usize| (k * k * k + 2 * k) / 3;
    let dense = cube(n) + n * n * r + n * r * r + cube(r) + 2 * n * n + 2 * r * r + 4 * n * r;
    (absent > 0 && spent < dense).then(|| {
        format!(
            "zeros of M and G in the solve: {absent} of {} entries; {} instead of {dense}",
            n * n + 2 * n * r,
            counted(spent)
        )
    })
}

/// Entries that the first evaluation writes for all others.
fn numbers(programs: &Programs) -> Option<String> {
    let (numbers, _) = numbers_apart(&programs.terms.program);
    let count = numbers.outputs.len();
    (count > 0).then(|| {
        let entries = plural(count, "entry", "entries");
        format!("what does not change in M, G, p₁ and p₂ but the first time: {entries}")
    })
}

/// Entries that are equal to others.
fn repeated(graph: &Graph, equations: &Equations) -> Option<String> {
    let e = equations;
    let rows = e.jacobian.iter().flatten();
    let entries: Vec<ExprId> = e
        .inertial()
        .into_iter()
        .chain(rows.chain(&e.force).chain(&e.bias).copied())
        .filter(|entry| !graph.is_zero(*entry) && graph.constant_value(*entry).is_none())
        .collect();
    let distinct: BTreeSet<ExprId> = entries.iter().copied().collect();
    let again = entries.len() - distinct.len();
    (again > 0).then(|| {
        format!(
            "{} that {} another one",
            plural(again, "entry", "entries"),
            if again == 1 { "equals" } else { "equal" }
        )
    })
}

/// Derivatives with respect to time where nothing depends on it explicitly.
fn time(graph: &Graph, equations: &Equations) -> Option<String> {
    let r = equations.drift.len();
    let still = zeros(graph, equations.drift.iter());
    (still > 0).then(|| match still == r {
        true => "partial derivatives of the constraints with respect to time: none of them \
                 depends on it"
            .into(),
        false => format!(
            "partial derivatives with respect to time of {still} of {r} constraint equations, \
             which do not depend on it"
        ),
    })
}

/// Coordinates on which nothing depends, among them integrals of states.
fn ignorable(mechanism: &Mechanism, equations: &Equations) -> Option<String> {
    let e = equations;
    let graph = &mechanism.graph;
    let rows = e.jacobian.iter().flatten();
    let others = rows.chain(&e.force).chain(&e.residual).chain(&e.bias);
    let entries = e.inertial().into_iter().chain(others.copied());
    let present: BTreeSet<Symbol> = entries.flat_map(|entry| graph.symbols(entry)).collect();
    let absent = mechanism.coordinates.iter().enumerate();
    let absent: Vec<String> = absent
        .filter(|(i, _)| !present.contains(&Symbol::Coordinate(*i as u32)))
        .map(|(i, coordinate)| match i < mechanism.freedoms() {
            true => coordinate.name.clone(),
            false => format!("the integral of {}", coordinate.name),
        })
        .collect();
    (!absent.is_empty()).then(|| {
        format!(
            "functions of {}: no term depends on {} (ignorable)",
            absent.join(", "),
            if absent.len() == 1 { "it" } else { "them" }
        )
    })
}

/// Entries between parts that nothing ties to one another.
fn apart(mechanism: &Mechanism, equations: &Equations) -> Option<String> {
    let parts = parts(&mechanism.graph, equations);
    (parts.len() > 1).then(|| {
        format!(
            "whatever would tie these parts to one another: {}; in descriptions of their own each would take steps of its own",
            named(mechanism, parts.iter())
        )
    })
}

/// Sets of coordinates, by their names.
fn named<'a>(mechanism: &Mechanism, sets: impl Iterator<Item = &'a Vec<usize>>) -> String {
    let named = sets.map(|set| {
        let names = set.iter().map(|i| mechanism.coordinates[*i].name.as_str());
        format!("{{{}}}", names.collect::<Vec<&str>>().join(", "))
    });
    named.collect::<Vec<String>>().join(" and ")
}

/// What singular configurations need of coordinates that have no part in them.
fn other_sheets(mechanism: &Mechanism, equations: &Equations) -> Option<String> {
    let components = &equations.components;
    let constrained = components.iter().any(|part| !part.rows.is_empty());
    let anywhere = constrained && !equations.are_independent(&mechanism.graph);
    anywhere.then(|| {
        format!(
            "near a singular configuration of one of {}, all of the others: neither constraints nor M tie them to one another",
            named(mechanism, components.iter().map(|part| &part.coordinates))
        )
    })
}

fn folded(mechanism: &Mechanism) -> Option<String> {
    let count = mechanism.constants.len();
    (count > 0).then(|| {
        format!(
            "{} folded into numbers",
            plural(count, "constant", "constants")
        )
    })
}

fn no_constraints(equations: &Equations) -> Option<String> {
    equations.jacobian.is_empty().then(|| {
        "projection, rank decisions, and all that singular configurations need: there are no constraints".into()
    })
}

/// What singular configurations need, where there is none.
fn independent(graph: &Graph, equations: &Equations) -> Option<String> {
    let (_, r) = equations.sizes();
    (r > 0 && equations.are_independent(graph)).then(|| {
        "rank decisions, and the search for singular configurations in each step: by their form the constraints are independent at all positions".into()
    })
}

/// Rows that the solve does without.
fn redundant(mechanism: &Mechanism, equations: &Equations) -> Option<String> {
    let rows = &equations.redundant;
    let named = rows.iter().map(|row| format!("g[{}]", row + 1));
    let named = named.collect::<Vec<String>>().join(", ");
    (!rows.is_empty()).then(|| {
        format!(
            "{} in the solve, of {}: where the constraints hold {named} {} from the others, which is verified in each step",
            plural(rows.len(), "row of G", "rows of G"),
            mechanism.constraints.len(),
            if rows.len() == 1 { "follows" } else { "follow" }
        )
    })
}

/// What is computed only when it is asked for.
fn on_request(mechanism: &Mechanism, programs: &Programs) -> Option<String> {
    let accelerated = mechanism.outputs.iter().any(|output| output.accelerated);
    let signals = match accelerated {
        true => operations(programs.signals.cost),
        false => 0,
    };
    let costs = [
        ("the energies", operations(programs.energy.cost)),
        ("outputs", operations(programs.outputs.cost) + signals),
    ];
    let said: Vec<String> = costs
        .into_iter()
        .filter(|(_, spent)| *spent > 0)
        .map(|(name, spent)| format!("{name} ({})", counted(spent)))
        .collect();
    (!said.is_empty()).then(|| format!("{}, until they are asked for", said.join(" and ")))
}
