//! Parts: `part Leg(base, phase) { … }`, used as `let left = Leg([0, 0], 0);`.
//!
//! In:  statements, those of parts among them.
//! Out: [`Placed`]: every statement with the frame in which its names are looked up, that of
//!      a part once for each use. Arguments are quantities of the part; those that are
//!      constants are so inside it, and can give arrays their sizes.

use super::declared::{Frame, Waiting};
use super::lowering::Lowering;
use super::messages::part_of_library;
use super::order::{Mention, collect};
use super::scope::{Kind, built_in, twice};
use super::value::Value;
use crate::diagnostic::{Diagnostic, Label, Span};
use crate::syntax::ast::{Argument, Declared, Expr, ExprKind, Item, ItemKind, Let, Name, Part};
use crate::syntax::messages::{DECLARED, REMOVE};
use std::rc::Rc;

/// A statement and where its names are looked up.
pub struct Placed<'a> {
    /// The statement.
    pub item: &'a Item,
    /// Where its names are looked up.
    pub frame: Rc<Frame>,
    /// Whether it declares a name, which was free.
    pub fresh: bool,
}

/// The library that `use` makes known.
pub const LIBRARY: &str = "parts";

/// The most parts of a mechanism.
const PARTS: usize = 10_000;
/// The most parts inside one another.
const DEEPEST: usize = 50;

impl<'a> Lowering<'a> {
    /// Reads which parts there are: those of the library and those of the description.
    pub fn parts(&mut self, items: &'a [Item], library: &'a [Item]) {
        let parts = |items: &'a [Item]| {
            items.iter().filter_map(|item| match &item.kind {
                ItemKind::Part(part) => Some(&**part),
                _ => None,
            })
        };
        for part in parts(library).chain(parts(items)) {
            let name = &part.name;
            for argument in &part.arguments {
                self.unit(argument.unit.as_ref());
            }
            if self.is_free(name).is_none() {
                continue;
            }
            let known = &mut self.evaluator.parts.declared;
            match known.get(&name.text).copied() {
                Some(first) if first.library => {
                    self.report::<()>(part_of_library(name));
                }
                Some(first) => self.report(twice(name, first)).unwrap_or_default(),
                None => {
                    known.insert(name.text.clone(), name.span);
                    self.parts.insert(&name.text, part);
                }
            }
        }
        for item in items {
            if let ItemKind::Use(name) = &item.kind
                && name.text != LIBRARY
            {
                let message = format!("there is no library `{}`", name.text);
                let error = Diagnostic::error(name.span, message);
                self.report::<()>(error.help("the library of parts is used by `use parts;`"));
            }
        }
    }

    /// The part that a statement uses.
    fn instance(&self, item: &'a Item) -> Option<(&'a Let, &'a Part, &'a [Expr])> {
        let ItemKind::Let(quantity) = &item.kind else {
            return None;
        };
        let ExprKind::Call(name, arguments) = &quantity.value.kind else {
            return None;
        };
        let part = self.parts.get(name.text.as_str())?;
        Some((quantity, part, arguments))
    }

    /// Declares the names of statements, evaluates the constants among them, and puts the
    /// statements of parts in the place of their uses.
    pub fn place(&mut self, items: &'a [Item], frame: &Rc<Frame>, placed: &mut Vec<Placed<'a>>) {
        let fresh: Vec<bool> = items.iter().map(|item| self.declare_name(item)).collect();
        self.evaluator.scope.set_outermost();
        let both = || items.iter().zip(fresh.iter().copied());
        let constants = both().filter_map(|(item, fresh)| match &item.kind {
            ItemKind::Declaration(d) if fresh && d.kind == Declared::Constant => Some((item, d)),
            _ => None,
        });
        self.constants(&constants.collect::<Vec<_>>());
        for (item, fresh) in both() {
            match self.instance(item) {
                Some(instance) if fresh => {
                    // What is wrong has been reported.
                    let _ = self.instantiate(instance, frame, placed);
                }
                _ => placed.push(Placed {
                    item,
                    frame: Rc::clone(frame),
                    fresh,
                }),
            }
        }
    }

    /// `let name = Part(arguments)` or `let name[range] = Part(arguments)`
    fn instantiate(
        &mut self,
        (quantity, part, arguments): (&'a Let, &'a Part, &'a [Expr]),
        frame: &Rc<Frame>,
        placed: &mut Vec<Placed<'a>>,
    ) -> Option<()> {
        let (span, of) = (quantity.value.span, &part.name);
        if frame.parts.contains(&of.text) {
            let message = format!("the part `{}` is made of itself", of.text);
            let error = Diagnostic::error(span, message).also(of.span, DECLARED);
            return self.report(error.help(format!(
                "several in a row are an array: `let a[i in 0..K] = {}(…);`",
                of.text
            )));
        }
        if frame.parts.len() == DEEPEST {
            let message = format!("more than {DEEPEST} parts inside one another");
            let error = Diagnostic::error(span, message);
            return self.report(error.help("use the innermost ones in the mechanism itself"));
        }
        if let Some(unit) = &quantity.unit {
            let error = Diagnostic::error(unit.span, "a part has no unit");
            return self.report(error.help(format!(
                "write `let {} = {}(…);`",
                quantity.name.text, of.text
            )));
        }
        let (names, evaluator) = (&part.arguments, &mut self.evaluator);
        evaluator.arguments_fit(of, names, arguments, span)?;
        let path = evaluator.scope.full(&quantity.name.text);
        let Some(range) = &quantity.range else {
            return self.element(&path, (part, arguments, span), None, placed);
        };
        let Some(bounds) = self.evaluator.bounds(range) else {
            if self.evaluator.unread {
                self.evaluator.scope.make_unknown(&quantity.name.text);
            }
            return None;
        };
        for i in bounds {
            let path = format!("{path}[{i}]");
            let index = Some((&range.index, i));
            self.element(&path, (part, arguments, span), index, placed)?;
        }
        Some(())
    }

    fn element(
        &mut self,
        path: &str,
        (part, arguments, span): (&'a Part, &'a [Expr], Span),
        index: Option<(&Name, i64)>,
        placed: &mut Vec<Placed<'a>>,
    ) -> Option<()> {
        self.evaluator.spend(span)?;
        if self.evaluator.parts.used.len() >= PARTS {
            let message = format!("more than {PARTS} parts");
            return self
                .report(Diagnostic::error(span, message).help("make the arrays of parts smaller"));
        }
        let frame = Rc::clone(&self.frame);
        let text = format!("in the part `{}`, used here", part.name.text);
        let of = [part.name.text.clone()];
        let inner = Rc::new(Frame {
            prefix: format!("{path}."),
            uses: [frame.uses.as_slice(), &[Label { span, text }]].concat(),
            parts: [frame.parts.as_slice(), &of].concat(),
        });
        let pairs = || part.arguments.iter().zip(arguments);
        let values: Vec<Option<Option<Value>>> = pairs()
            .map(|(argument, e)| self.constant_argument(&part.name.text, argument, e, index))
            .collect();
        self.inside(&inner, |this| {
            for ((argument, e), value) in pairs().zip(values) {
                let kind = match value {
                    Some(_) => Kind::Argument,
                    None => Kind::Quantity,
                };
                this.declare_as(&argument.name, kind);
                let full = this.evaluator.scope.full(&argument.name.text);
                match value {
                    Some(value) => this.evaluator.scope.define(&full, value, None),
                    None => this.waits(full, waiting(argument, e, &frame, index, part)),
                }
            }
            let mut names: Vec<String> = declared_names(&part.items).collect();
            names.extend(part.arguments.iter().map(|a| a.name.text.clone()));
            this.evaluator.parts.used.insert(path.to_string(), names);
            let outputs = output_names(&part.items).map(|name| format!("{path}.{name}"));
            this.evaluator.scope.outputs.extend(outputs);
            this.place(&part.items, &inner, placed);
        });
        Some(())
    }

    /// The value of an argument that is built of constants; `None` if it is not.
    fn constant_argument(
        &mut self,
        part: &str,
        argument: &Argument,
        e: &Expr,
        index: Option<(&Name, i64)>,
    ) -> Option<Option<Value>> {
        let evaluator = &mut self.evaluator;
        // An argument of the part around is one if it is a constant itself.
        let is_constant = |kind: Kind| matches!(kind, Kind::Constant | Kind::Argument);
        let mut constant = true;
        collect(e, &mut |mention| {
            let fine = |name: &str| {
                let kind = evaluator.scope.get(name).map(|entry| entry.kind);
                let is_index = index.is_some_and(|(index, _)| index.text == name);
                is_index
                    || kind.is_some_and(is_constant)
                    || (name != "t" && built_in().any(|b| b == name))
            };
            constant &= match mention {
                Mention::Name(name) => fine(name),
                Mention::Call(_) => true,
            };
        });
        let free = evaluator.functions.mentions([e]);
        let only = |name: &String| {
            let entry = evaluator.scope.get(name);
            entry.is_none_or(|entry| is_constant(entry.kind))
        };
        if !constant || !free.iter().all(only) {
            return None;
        }
        Some(match index {
            Some((index, i)) => {
                evaluator.with_value(index, i, |this| this.argument(part, argument, e))
            }
            None => evaluator.argument(part, argument, e),
        })
    }

    /// Notes a quantity that is evaluated when it is asked for.
    pub fn waits(&mut self, full: String, waiting: Waiting) {
        self.evaluator
            .parts
            .waiting
            .insert(full.clone(), Rc::new(waiting));
        self.waiting.push(full);
    }

    /// Does something where names are looked up in a frame.
    pub fn inside<T>(&mut self, frame: &Rc<Frame>, work: impl FnOnce(&mut Self) -> T) -> T {
        let around = std::mem::replace(&mut self.frame, Rc::clone(frame));
        let uses = self.evaluator.diagnostics.look_from(frame.uses.clone());
        let names = self.evaluator.scope.look_from(&frame.prefix);
        let result = work(self);
        self.evaluator.scope.come_back(names);
        self.evaluator.diagnostics.look_from(uses);
        self.frame = around;
        result
    }

    /// The place of a statement in the description: that of its use, if the library has it.
    pub fn place_of(&self, span: Span) -> Span {
        match self.frame.uses.first() {
            Some(label) if span.library => label.span,
            _ => span,
        }
    }

    /// Warns of parts that nothing uses.
    pub fn unused_parts(&mut self) {
        let used: Vec<String> = std::mem::take(&mut self.used_parts);
        let declared = self.evaluator.parts.declared.clone();
        for (name, span) in declared {
            if !span.library && !name.starts_with('_') && !used.contains(&name) {
                let warning = Diagnostic::warning(span, format!("the part `{name}` is never used"));
                self.report::<()>(warning.help(REMOVE));
            }
        }
    }
}

fn waiting(
    argument: &Argument,
    e: &Expr,
    frame: &Rc<Frame>,
    index: Option<(&Name, i64)>,
    part: &Part,
) -> Waiting {
    Waiting {
        quantity: Rc::new(Let {
            name: argument.name.clone(),
            range: None,
            unit: argument.unit.clone(),
            value: e.clone(),
        }),
        frame: Rc::clone(frame),
        index: index.map(|(index, i)| (index.clone(), i)),
        argument_of: Some(part.name.text.clone()),
    }
}

/// The names of outputs that statements declare.
pub fn output_names(items: &[Item]) -> impl Iterator<Item = &str> {
    items.iter().filter_map(|item| match &item.kind {
        ItemKind::Declaration(d) if d.kind == Declared::Output => Some(d.name.text.as_str()),
        _ => None,
    })
}

/// The names that the statements of a part declare for those who use it.
fn declared_names(items: &[Item]) -> impl Iterator<Item = String> {
    items.iter().filter_map(|item| match &item.kind {
        ItemKind::Declaration(d) if d.kind != Declared::Output => Some(d.name.text.clone()),
        ItemKind::Coordinate { name, .. } => Some(name.text.clone()),
        ItemKind::Let(quantity) => Some(quantity.name.text.clone()),
        _ => None,
    })
}
