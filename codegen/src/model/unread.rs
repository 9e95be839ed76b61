//! Parts and functions that nothing uses, checked as far as that goes without arguments.
//!
//! In:  a description that has been read.
//! Out: what is wrong with them. For that the description is read once more, with these parts
//!      in use and their arguments without values. What has no value says nothing, as if its
//!      mistakes had been reported, so found is only what is wrong whatever the arguments are.
//!
//! Not here: what is missing, such as the rate of a state: it may stand in a loop of which
//! nobody knows how often it goes round.

use super::declared::Frame;
use super::evaluate::Evaluator;
use super::lowering::{Lowering, Named};
use super::part::Placed;
use super::scope::Kind;
use crate::diagnostic::{Diagnostic, Severity, Span};
use crate::syntax::ast::{Argument, Function, Item, ItemKind, Part, Range};
use std::rc::Rc;
use std::slice::from_ref;

impl<'a> Lowering<'a> {
    /// Reports what is wrong with what nothing uses, by another reading of the description
    /// that has not begun.
    pub fn unread(&mut self, mut again: Lowering<'a>, items: &'a [Item], library: &'a [Item]) {
        let functions = self.idle_functions();
        let parts = self.idle_parts(items);
        if functions.is_empty() && parts.is_empty() {
            return;
        }
        again.evaluator.unread = true;
        let placed = again.declare(items, library);
        let placed: Vec<&Placed> = placed.iter().filter(|p| p.frame.is_unread()).collect();
        for of_one in placed.chunk_by(|a, b| a.frame.parts.first() == b.frame.parts.first()) {
            // What two of them say about the mechanism around is said by neither.
            again.named = Named::default();
            for Placed { item, frame, .. } in of_one {
                again.inside(frame, |this| this.statements(from_ref(*item)));
            }
        }
        for function in &functions {
            again.evaluator.unread_function(function);
        }
        let whole = |f: &Rc<Function>| f.name.span.to(f.value.span);
        let parts = parts.into_iter().map(|(_, span)| span);
        let places: Vec<Span> = parts.chain(functions.iter().map(whole)).collect();
        let found = again.evaluator.diagnostics.sorted().into_iter();
        for finding in found.filter(|finding| concerns(finding, &places)) {
            if !self.evaluator.diagnostics.is_wrong(finding.primary.span) {
                // It changes nothing yet.
                self.report::<()>(Diagnostic {
                    severity: Severity::Warning,
                    ..finding.clone()
                });
            }
        }
    }

    /// The parts that nothing uses, and where they stand.
    fn idle_parts(&self, items: &'a [Item]) -> Vec<(&'a Part, Span)> {
        let part = |item: &'a Item| match &item.kind {
            ItemKind::Part(part) => Some((&**part, item.span)),
            _ => None,
        };
        let known = |part: &Part| {
            let known = self.parts.get(part.name.text.as_str());
            known.is_some_and(|known| std::ptr::eq(*known, part))
        };
        let idle = |part: &Part| known(part) && !self.used_parts.contains(&part.name.text);
        let all = items.iter().filter_map(part);
        all.filter(|(part, _)| idle(part)).collect()
    }

    /// Puts the statements of parts that nothing uses behind all others.
    pub fn place_unread(&mut self, items: &'a [Item], placed: &mut Vec<Placed<'a>>) {
        for (part, _) in self.idle_parts(items) {
            let name = &part.name.text;
            // A symbol may have the same name, and names in it.
            let prefix = match self.evaluator.scope.get(name) {
                None => format!("{name}."),
                Some(_) => format!("{name}()."),
            };
            let frame = Rc::new(Frame {
                prefix,
                uses: Vec::new(),
                parts: vec![name.clone()],
            });
            self.inside(&frame, |this| {
                this.evaluator.declare_unknown(&part.arguments);
                this.place(&part.items, &frame, placed);
            });
        }
    }
}

/// Whether a finding is about something at one of some places.
fn concerns(finding: &Diagnostic, places: &[Span]) -> bool {
    let inside = |span: Span| {
        let within = |place: &Span| place.start <= span.start && span.end <= place.end;
        !span.library && places.iter().any(within)
    };
    let labels = [&finding.primary].into_iter().chain(&finding.secondary);
    let mut spans = labels.map(|label| label.span);
    finding.severity == Severity::Error && spans.any(inside)
}

impl Evaluator {
    /// Declares arguments without values.
    fn declare_unknown(&mut self, arguments: &[Argument]) {
        for argument in arguments {
            if let Err(diagnostic) = self.scope.declare(&argument.name, Kind::Argument) {
                self.report::<()>(*diagnostic);
            }
        }
    }

    fn unread_function(&mut self, function: &Function) {
        let prefix = format!("{}().", function.name.text);
        let around = self.scope.look_from(&prefix);
        self.declare_unknown(&function.arguments);
        let value = self.evaluate(&function.value);
        self.scope.come_back(around);
        if let Some(value) = value {
            let unit = function.unit.as_ref();
            self.in_declared_unit(&function.name, unit, (&function.value, value));
        }
    }

    /// Looks once at what is repeated nobody knows how often, while its index has no value.
    /// Returns nothing, for what comes of it has no value either.
    pub fn look_once<T, U>(
        &mut self,
        range: &Range,
        work: impl FnOnce(&mut Self) -> T,
    ) -> Option<U> {
        if self.unread {
            let mark = self.scope.open();
            if let Err(diagnostic) = self.scope.declare(&range.index, Kind::Index) {
                self.report::<()>(*diagnostic);
            }
            work(self);
            self.scope.close(mark);
        }
        None
    }
}
