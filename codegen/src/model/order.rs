//! The order in which declarations can be evaluated.
//!
//! In:  formulas and the names they define.
//! Out: an order in which every formula comes behind those it mentions; cycles
//!      are reported.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::ast::{Expr, ExprKind, Name};
use rustc_hash::FxHashMap;

/// A definition: a name, the names that it mentions, and whether it may mention
/// itself (the elements of an array may use those before them).
pub struct Definition<'a> {
    /// The name.
    pub name: &'a Name,
    /// What its formulas mention.
    pub mentions: Vec<String>,
    /// Whether it may mention itself.
    pub recursive: bool,
}

/// What to write where quantities come from one another.
pub const QUANTITIES: &str =
    "a quantity must come from others in the end; the unknowns are the coordinates";

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}

/// The indices of definitions in an order of evaluation. What takes part in a
/// cycle is left out; `help` says what to do about a cycle.
pub fn order(definitions: &[Definition], help: &str, diagnostics: &mut Diagnostics) -> Vec<usize> {
    let place = |(i, definition): (usize, &Definition)| (definition.name.text.clone(), i);
    let places: FxHashMap<String, usize> = definitions.iter().enumerate().map(place).collect();
    let needs: Vec<Vec<usize>> = definitions.iter().map(|d| mentioned(d, &places)).collect();
    let mut states = vec![State::New; definitions.len()];
    let mut sorted = Vec::new();
    let mut circular = vec![false; definitions.len()];
    for start in 0..definitions.len() {
        if states[start] == State::New {
            visit(start, &needs, &mut states, &mut sorted, &mut |cycle| {
                cycle.iter().for_each(|&i| circular[i] = true);
                diagnostics.push(report(cycle, definitions, help));
            });
        }
    }
    sorted.retain(|&i| !circular[i]);
    sorted
}

/// Depth-first from one definition, with a stack of its own: chains are long.
fn visit(
    start: usize,
    needs: &[Vec<usize>],
    states: &mut [State],
    sorted: &mut Vec<usize>,
    cycle: &mut dyn FnMut(&[usize]),
) {
    let mut path = vec![start];
    let mut next = vec![0_usize];
    states[start] = State::Open;
    while let (Some(&node), Some(at)) = (path.last(), next.last_mut()) {
        let Some(&need) = needs[node].get(*at) else {
            states[node] = State::Done;
            sorted.push(node);
            path.pop();
            next.pop();
            continue;
        };
        *at += 1;
        match states[need] {
            State::New => {
                states[need] = State::Open;
                path.push(need);
                next.push(0);
            }
            State::Open => {
                let from = path.iter().position(|&p| p == need).unwrap_or(0);
                cycle(&path[from..]);
            }
            State::Done => {}
        }
    }
}

fn report(cycle: &[usize], definitions: &[Definition], help: &str) -> Diagnostic {
    let name = |i: &usize| format!("`{}`", definitions[*i].name.text);
    let first = cycle.iter().min().copied().unwrap_or(0);
    let span = definitions[first].name.span;
    if cycle.len() == 1 {
        let message = format!("{} is defined by itself", name(&first));
        return Diagnostic::error(span, message).help(help);
    }
    let names: Vec<_> = cycle.iter().take(8).map(name).collect();
    let message = format!("{} are defined by one another", names.join(", "));
    let mut diagnostic = Diagnostic::error(span, message).help(help);
    for other in cycle.iter().filter(|i| **i != first).take(3) {
        diagnostic = diagnostic.also(definitions[*other].name.span, "part of the circle");
    }
    diagnostic
}

fn mentioned(definition: &Definition, places: &FxHashMap<String, usize>) -> Vec<usize> {
    let own = &definition.name.text;
    let others = definition.mentions.iter();
    let others = others.filter(|name| !(definition.recursive && *name == own));
    let mut needs: Vec<usize> = others
        .filter_map(|name| places.get(name).copied())
        .collect();
    needs.sort_unstable();
    needs.dedup();
    needs
}

/// What a formula mentions.
#[derive(Clone, Copy)]
pub enum Mention<'a> {
    /// A name.
    Name(&'a str),
    /// A function.
    Call(&'a str),
}

/// Finds what a formula mentions.
pub fn collect<'a>(formula: &'a Expr, found: &mut dyn FnMut(Mention<'a>)) {
    match &formula.kind {
        ExprKind::Name(name) => found(Mention::Name(name)),
        ExprKind::Call(name, _) => found(Mention::Call(&name.text)),
        _ => {}
    }
    for part in parts(formula) {
        collect(part, found);
    }
}

/// The formulas that a formula is made of.
pub fn parts(formula: &Expr) -> Vec<&Expr> {
    match &formula.kind {
        ExprKind::Number(_) | ExprKind::Text(_) | ExprKind::Name(_) => Vec::new(),
        ExprKind::Negative(x)
        | ExprKind::Component(x, _)
        | ExprKind::Member(x, _)
        | ExprKind::InUnit(x, _) => vec![x],
        ExprKind::Sum(parts) | ExprKind::Product(parts) => {
            parts.iter().map(|(_, part)| part).collect()
        }
        ExprKind::Power(a, b) | ExprKind::Index(a, b) => vec![a, b],
        ExprKind::Call(_, parts) | ExprKind::Vector(parts) => parts.iter().collect(),
        ExprKind::Repeat(range, term) => vec![&range.from, &range.to, term],
        ExprKind::If(condition, then, otherwise) => {
            let sides = condition.sides().into_iter();
            sides.chain([&**then, &**otherwise]).collect()
        }
    }
}
