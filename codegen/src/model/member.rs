//! Names in parts: `left.tip`, `leg[2].hip.q`.
//!
//! In:  formulas that name a part, and quantities that wait for their values.
//! Out: values. A quantity of a part is evaluated when it is first asked for, because one
//!      part is given what belongs to another.

use super::declared::{Frame, Waiting};
use super::evaluate::Evaluator;
use super::order::QUANTITIES;
use super::scope::Kind;
use super::value::{Bare, Value};
use crate::diagnostic::{Diagnostic, Span, nearest};
use crate::syntax::ast::{Argument, Expr, ExprKind, Let, Name};
use crate::syntax::messages::{COMPONENT, did_you_mean, no_axis};

/// How many names in a part are listed where one is missing.
const SHOWN: usize = 4;

impl Evaluator {
    /// Whether a formula names a part or an array of them.
    pub fn names_part(&self, e: &Expr) -> bool {
        match &e.kind {
            ExprKind::Name(name) => {
                let entry = self.scope.get(name);
                entry.is_some_and(|entry| entry.kind == Kind::Part)
            }
            ExprKind::Index(inside, _) => self.names_part(inside),
            ExprKind::Member(inside, name) => {
                self.names_part(inside)
                    && self.parts.used.keys().any(|path| last(path) == name.text)
            }
            _ => false,
        }
    }

    /// The full name of the part that a formula names.
    fn path(&mut self, e: &Expr) -> Option<String> {
        match &e.kind {
            ExprKind::Name(name) => {
                let entry = self.scope.look_up(name, false)?;
                Some(entry.name.text.clone())
            }
            ExprKind::Index(inside, index) => {
                let inside = self.path(inside)?;
                let i = self.integer(index, "an index")?;
                let path = format!("{inside}[{i}]");
                if self.parts.used.contains_key(&path) {
                    return Some(path);
                }
                let message = format!("there is no `{path}`");
                let error = Diagnostic::error(e.span, message);
                self.report(error.maybe_help(self.which(&inside)))
            }
            ExprKind::Member(inside, name) => {
                let inside = self.path(inside)?;
                Some(format!("{inside}.{}", name.text))
            }
            _ => None,
        }
    }

    /// Which parts an array of them has.
    fn which(&self, path: &str) -> Option<String> {
        let inside = |known: &&String| {
            let rest = known
                .strip_prefix(path)
                .and_then(|rest| rest.strip_prefix('['));
            rest.is_some_and(|rest| !rest.contains('.'))
        };
        let count = self.parts.used.keys().filter(inside).count();
        Some(match count {
            0 => format!("`{path}` is one part: write `{path}.…`"),
            _ => format!("`{path}` is an array of {count} parts: write `{path}[0].…`"),
        })
    }

    /// `part.name`
    pub fn member(&mut self, inside: &Expr, name: &str, span: Span) -> Option<Value> {
        if !self.names_part(inside) {
            return self.no_part(inside, name, span);
        }
        let path = self.path(inside)?;
        let Some(names) = self.parts.used.get(&path) else {
            // What is wrong with its use has been reported.
            self.parts
                .used
                .keys()
                .find(|known| known.starts_with(&path))?;
            let error = Diagnostic::error(inside.span, format!("`{path}` is not one part"));
            return self.report(error.maybe_help(self.which(&path)));
        };
        if names.iter().any(|known| known == name) {
            return self.declared(&format!("{path}.{name}"), true, span);
        }
        if self.scope.unreadable.contains(name) {
            return None;
        }
        if self.scope.outputs.contains(&format!("{path}.{name}")) {
            return self.output_in_formula(name, span);
        }
        let known = names.iter().map(String::as_str);
        let help = match nearest(name, known.clone()) {
            Some(near) => did_you_mean(near),
            None => format!("it has {}", known.collect::<Vec<_>>().join(", ")),
        };
        let message = format!("the part `{path}` has no `{name}`");
        self.report(Diagnostic::error(span, message).help(help))
    }

    /// An output, which no formula can use.
    pub fn output_in_formula(&mut self, name: &str, span: Span) -> Option<Value> {
        let error = Diagnostic::error(span, format!("`{name}` is an output"));
        self.report(error.help(format!(
            "what formulas use is declared by `let {name} = …;`; an output shows it"
        )))
    }

    /// A name behind the dot of what is no part.
    fn no_part(&mut self, inside: &Expr, name: &str, span: Span) -> Option<Value> {
        self.evaluate(inside)?;
        let message = no_axis(name);
        self.report(Diagnostic::error(span, message).help(COMPONENT))
    }

    /// A part that is called inside a formula.
    pub fn part_alone(&mut self, name: &Name, span: Span) -> Option<Value> {
        let name = &name.text;
        let error = Diagnostic::error(span, format!("`{name}` is a part, no function"));
        self.report(error.help(format!(
            "a part stands alone behind `let`, outside loops: `let a = {name}(…);`, \
             `let a[i in 0..K] = {name}(…);`"
        )))
    }

    /// Evaluates a quantity that waits for its value.
    pub fn evaluate_waiting(&mut self, full: &str, kind: Kind, span: Span) {
        if kind == Kind::Part {
            let message = format!("`{full}` is a part");
            let error = Diagnostic::error(span, message);
            let names = self.parts.used.get(full).into_iter().flatten();
            let names: Vec<String> = names
                .take(SHOWN)
                .map(|name| format!("`{full}.{name}`"))
                .collect();
            let names = match names.is_empty() {
                true => format!("`{full}.…`"),
                false => names.join(", "),
            };
            self.report::<()>(error.help(format!("write a name in it behind a dot: {names}")));
            return;
        }
        if self.parts.open.iter().any(|open| open == full) {
            let error = Diagnostic::error(span, format!("`{full}` is defined by itself"));
            self.report::<()>(error.help(QUANTITIES));
            return;
        }
        let Some(waiting) = self.parts.waiting.remove(full) else {
            return;
        };
        if !self.has_room() {
            let error = Diagnostic::error(span, "too many parts depend on one another in a row");
            let help = "declare each part behind those whose names it is given";
            self.report::<()>(error.help(help));
            return;
        }
        self.parts.open.push(full.to_string());
        let (gains, constant) = (std::mem::take(&mut self.gains), self.constant.take());
        let (value, bare) = self.within(&waiting.frame, |this| match &waiting.index {
            Some((index, i)) => this.with_value(index, *i, |this| this.waited_for(&waiting)),
            None => this.waited_for(&waiting),
        });
        (self.gains, self.constant) = (gains, constant);
        self.parts.open.pop();
        self.scope.define(full, value, bare);
    }

    /// Does something where names are looked up in a frame.
    pub fn within<T>(&mut self, frame: &Frame, work: impl FnOnce(&mut Self) -> T) -> T {
        let uses = self.diagnostics.look_from(frame.uses.clone());
        let around = self.scope.look_from(&frame.prefix);
        let result = work(self);
        self.scope.come_back(around);
        self.diagnostics.look_from(uses);
        result
    }

    fn waited_for(&mut self, waiting: &Waiting) -> (Option<Value>, Option<Bare>) {
        let quantity = &waiting.quantity;
        let Some(part) = &waiting.argument_of else {
            return self.quantity(quantity);
        };
        let argument = Argument {
            name: quantity.name.clone(),
            unit: quantity.unit.clone(),
        };
        (self.argument(part, &argument, &quantity.value), None)
    }

    /// The value of a quantity, and the number without unit that it is made with.
    pub fn quantity(&mut self, quantity: &Let) -> (Option<Value>, Option<Bare>) {
        let value = match &quantity.range {
            None => self.evaluate(&quantity.value),
            Some(range) => self.array(&quantity.name, range, &quantity.value),
        };
        let unit = quantity.unit.as_ref();
        let value = value.and_then(|value| {
            self.in_declared_unit(&quantity.name, unit, (&quantity.value, value))
        });
        let bare = match unit {
            Some(_) => None,
            None => self.bare(&quantity.value),
        };
        (value, bare)
    }
}

/// The last name of a path, without an index.
fn last(path: &str) -> &str {
    let name = path.rsplit('.').next().unwrap_or(path);
    name.split('[').next().unwrap_or(name)
}
