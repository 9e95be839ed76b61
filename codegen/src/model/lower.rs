//! Syntax tree to mechanism: the order of the work.
//!
//! In:  the tree, and what a build script changes.
//! Out: a [`Mechanism`] and warnings, or everything that is wrong.

use super::Mechanism;
use super::evaluate::Evaluator;
use super::lowering::{Lowering, Named};
use super::part::{LIBRARY, Placed, output_names};
use super::scope::{Entry, Kind};
use super::symbol::{Graph, Symbol};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::expr::ExprId;
use crate::syntax::ast::{Energy, Item, ItemKind};
use crate::syntax::messages::REMOVE;
use crate::syntax::{self, Model};
use rustc_hash::FxHashMap;
use std::path::Path;
use std::rc::Rc;

/// Checks a description and puts it into expressions.
///
/// `constants` replaces the values of constants, `frozen` makes parameters
/// constants at their default. Where a description is not `complete`, because some of its
/// statements can't be read, nothing is reported as missing. Files are looked for in a folder.
///
/// # Errors
///
/// Everything that is wrong; warnings come with the mechanism.
pub fn lower(
    model: &Model,
    constants: &[(String, f64)],
    frozen: &[String],
    complete: bool,
    folder: Option<&Path>,
) -> Result<(Mechanism, Diagnostics), Diagnostics> {
    let library = library(model);
    let mut lowering = begun(model, constants, frozen, folder);
    let placed = lowering.declare(&model.items, &library);
    for Placed { item, frame, .. } in &placed {
        lowering.inside(frame, |this| this.statements(std::slice::from_ref(*item)));
    }
    if complete {
        lowering.changes_fit(model);
        let again = begun(model, constants, frozen, folder);
        lowering.unread(again, &model.items, &library);
        lowering.whole(model, &library);
    }
    let Lowering {
        mut evaluator,
        mut mechanism,
        ..
    } = lowering;
    if evaluator.diagnostics.error_count() > 0 {
        return Err(evaluator.diagnostics.into_errors());
    }
    mechanism.files = std::mem::take(&mut evaluator.files);
    mechanism.tables = std::mem::take(&mut evaluator.tables);
    mechanism.graph = std::mem::replace(&mut evaluator.graph, Graph::new());
    Ok((mechanism, evaluator.diagnostics))
}

/// A mechanism of which nothing is known yet.
fn begun<'a>(
    model: &Model,
    constants: &'a [(String, f64)],
    frozen: &'a [String],
    folder: Option<&Path>,
) -> Lowering<'a> {
    let mut evaluator = Evaluator::default();
    evaluator.folder = folder.map(Path::to_path_buf);
    evaluator.scope.unreadable = model.unreadable.iter().cloned().collect();
    evaluator.scope.outputs = output_names(&model.items).map(str::to_string).collect();
    Lowering {
        evaluator,
        mechanism: Mechanism::named(&model.name.text, &model.docs),
        constants,
        frozen,
        indices: Vec::new(),
        parts: FxHashMap::default(),
        used_parts: Vec::new(),
        frame: Rc::default(),
        waiting: Vec::new(),
        n_inputs: 0,
        named: Named::default(),
    }
}

/// The statements of the library, if a description uses it.
fn library(model: &Model) -> Rc<[Item]> {
    let uses = |item: &Item| matches!(&item.kind, ItemKind::Use(name) if name.text == LIBRARY);
    match model.items.iter().any(uses) {
        true => syntax::library(),
        false => Rc::default(),
    }
}

/// Whether a statement, or one of a loop or a part, gives kinetic energy.
fn gives_kinetic_energy(item: &Item) -> bool {
    match &item.kind {
        ItemKind::Energy(kind, _) => *kind == Energy::Kinetic,
        ItemKind::For(_, body) => body.iter().any(gives_kinetic_energy),
        ItemKind::Part(part) => part.items.iter().any(gives_kinetic_energy),
        _ => false,
    }
}

impl Lowering<'_> {
    /// What concerns the mechanism as a whole.
    fn whole(&mut self, model: &Model, library: &[Item]) {
        let (name, at) = (&model.name, model.name.span);
        let declared = |item: &Item| matches!(item.kind, ItemKind::Coordinate { state: false, .. });
        let wrong = self.evaluator.diagnostics.error_count() > 0;
        // What has been left out because it is wrong isn't missing.
        let written = || model.items.iter().chain(library).any(gives_kinetic_energy);
        if !model.items.iter().any(declared) && self.mechanism.freedoms() == 0 {
            let error = Diagnostic::error(at, format!("`{}` has no coordinates", name.text));
            self.report::<()>(error.help("declare what moves, for example `coord q1: rad;`"));
        } else if self.mechanism.kinetic.is_empty() && !(wrong && written()) {
            let error = Diagnostic::error(at, format!("`{}` has no kinetic energy", name.text));
            self.report::<()>(error.help("write for example `kinetic 1/2*J*der(q1)^2;`"));
        }
        self.states_without_rate();
        self.unread_functions();
        if self.evaluator.diagnostics.error_count() > 0 {
            return;
        }
        let entries = self.evaluator.scope.close(0);
        self.unused(&entries);
        self.unused_functions();
        self.unused_parts();
        self.idle_coordinates();
    }

    /// Warns of names that no formula mentions. A name that begins with `_` says
    /// that this is meant.
    pub fn unused(&mut self, entries: &[Entry]) {
        for entry in entries {
            let counts = !matches!(entry.kind, Kind::Coordinate | Kind::Index | Kind::Part);
            // A part offers names; not every use needs all of them.
            let offered = entry.name.text.contains('.');
            if counts && !offered && !entry.used && !entry.name.text.starts_with('_') {
                let message = format!("`{}` is never used", entry.name.text);
                let warning = Diagnostic::warning(entry.name.span, message);
                self.report::<()>(warning.help(REMOVE));
            }
        }
    }

    /// Warns of coordinates that neither energies nor forces nor constraints
    /// contain.
    fn idle_coordinates(&mut self) {
        let m = &self.mechanism;
        let summands = m.kinetic.iter().chain(&m.potential).chain(&m.dissipation);
        let mut roots: Vec<ExprId> = summands.map(|summand| summand.value).collect();
        roots.extend(m.constraints.iter().map(|constraint| constraint.residual));
        roots.extend(m.forces.iter().flat_map(|force| force.on.iter().copied()));
        let graph = &mut self.evaluator.graph;
        let mut busy = vec![false; m.coordinates.len()];
        for e in graph.reachable(&roots) {
            if let crate::expr::Node::Symbol(Symbol::Coordinate(i) | Symbol::Velocity(i)) =
                graph.node(e)
            {
                busy[*i as usize] = true;
            }
        }
        let declared = m.coordinates[..m.freedoms()].iter();
        let idle = declared.zip(&busy).filter(|(_, busy)| !**busy);
        let idle: Vec<(String, Span)> = idle.map(|(q, _)| (q.name.clone(), q.span)).collect();
        for (name, span) in idle {
            let message = format!("`{name}` takes part in no energy, force or constraint");
            let warning = Diagnostic::warning(span, message);
            self.report::<()>(
                warning.help("give it a kinetic energy or a constraint, or remove it"),
            );
        }
    }
}
