//! Functions that the description declares.
//!
//! In:  `fn f(x, y: unit): unit = formula;`.
//! Out: [`Functions`](super::declared::Functions), and the value of a call: that of the
//!      formula with the values of the arguments, looked up where the function stands, not
//!      where it is called.
//!
//! A finding inside a function points to its use as well.

use super::declared::Known;
use super::evaluate::Evaluator;
use super::language::known;
use super::lowering::Lowering;
use super::messages::{count, part_of_library, takes_others};
use super::order::{Definition, Mention, collect, order};
use super::scope::{Kind, twice};
use super::unit::{NONE, Unit};
use super::unit_names;
use super::value::{Scalar, Value, all};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr;
use crate::syntax::ast::{Argument, Expr, Function, Item, ItemKind, Name, UnitExpr};
use crate::syntax::messages::{DECLARED, REMOVE, RENAME};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// What to write where functions call one another.
const RECURSION: &str = "a function can't call itself; what repeats is a `sum`, or an array \
                         `let n[i in 0..K] = …` whose elements use those before them";

impl Lowering<'_> {
    /// Reads the functions, each behind those that it calls.
    pub fn functions<'i>(&mut self, items: impl Iterator<Item = &'i Item>) {
        let functions = items.filter_map(|item| match &item.kind {
            ItemKind::Function(function) => Some(function),
            _ => None,
        });
        let mut places: FxHashMap<&str, Span> = FxHashMap::default();
        let mut fresh = Vec::new();
        for function in functions {
            let name = &function.name;
            match places.insert(&name.text, name.span) {
                Some(first) => self.report(twice(name, first)),
                None => self.is_free(name).and_then(|()| self.is_no_part(name)),
            }
            .into_iter()
            .for_each(|()| fresh.push(Rc::clone(function)));
        }
        let definitions: Vec<Definition> = fresh.iter().map(|f| calls(f)).collect();
        for function in &fresh {
            self.evaluator.functions.known.insert(
                function.name.text.clone(),
                Known {
                    item: None,
                    mentions: Vec::new(),
                    used: true,
                },
            );
        }
        for i in order(&definitions, RECURSION, &mut self.evaluator.diagnostics) {
            let known = &self.evaluator.functions.known;
            let broken = |name: &String| known.get(name).is_some_and(|f| f.item.is_none());
            if !definitions[i].mentions.iter().any(broken) {
                self.function(&fresh[i]);
            }
        }
    }

    /// Refuses the name of a part for a function.
    fn is_no_part(&mut self, name: &Name) -> Option<()> {
        let part = self.evaluator.parts.declared.get(&name.text).copied();
        match part {
            Some(first) if first.library => self.report(part_of_library(name)),
            Some(first) => self.report(twice(name, first)),
            None => Some(()),
        }
    }

    /// Refuses the name of a function that there is already.
    pub fn is_free(&mut self, name: &Name) -> Option<()> {
        let text = name.text.as_str();
        let unary = expr::Function::ALL.iter().any(|(_, known)| *known == text);
        if !unary && !known(text) {
            return Some(());
        }
        let error = Diagnostic::error(name.span, format!("`{text}` is a function already"));
        self.report(error.help(RENAME))
    }

    fn function(&mut self, function: &Rc<Function>) {
        let mut mentions = self.evaluator.functions.mentions([&function.value]);
        for argument in &function.arguments {
            let name = &argument.name;
            if !mentions.contains(&name.text) && !name.text.starts_with('_') {
                let warning =
                    Diagnostic::warning(name.span, format!("`{}` is never used", name.text));
                self.report::<()>(warning.help(REMOVE));
            }
            self.unit(argument.unit.as_ref());
        }
        self.unit(function.unit.as_ref());
        let own = |name: &String| function.arguments.iter().any(|a| a.name.text == *name);
        mentions.retain(|name| !own(name));
        let known = Known {
            item: Some(Rc::clone(function)),
            mentions,
            used: false,
        };
        let name = function.name.text.clone();
        self.evaluator.functions.known.insert(name, known);
    }

    /// Functions that nothing calls.
    pub fn idle_functions(&self) -> Vec<Rc<Function>> {
        let idle = self.evaluator.functions.known.values();
        let idle = idle.filter(|function| !function.used);
        let mut idle: Vec<Rc<Function>> = idle.filter_map(|f| f.item.clone()).collect();
        idle.sort_by_key(|function| function.name.span);
        idle
    }

    /// Refuses names that are not declared where no call would find them.
    pub fn unread_functions(&mut self) {
        for function in self.idle_functions() {
            let arguments = function.arguments.iter();
            let mut known = arguments.map(|a| a.name.text.clone()).collect();
            self.evaluator.refuse_unknown(&function.value, &mut known);
        }
    }

    /// Warns of functions that nothing calls.
    pub fn unused_functions(&mut self) {
        for function in self.idle_functions() {
            let name = &function.name;
            if !name.text.starts_with('_') {
                let message = format!("the function `{}` is never used", name.text);
                let warning = Diagnostic::warning(name.span, message);
                self.report::<()>(warning.help(REMOVE));
            }
        }
    }
}

/// A function by the functions that it calls.
fn calls(function: &Function) -> Definition<'_> {
    let mut mentions = Vec::new();
    collect(&function.value, &mut |mention| {
        if let Mention::Call(name) = mention {
            mentions.push(name.to_string());
        }
    });
    Definition {
        name: &function.name,
        mentions,
        recursive: false,
    }
}

impl Evaluator {
    /// `f(arguments)` of a function that the description declares.
    pub fn apply(&mut self, name: &Name, arguments: &[Expr], span: Span) -> Option<Value> {
        let known = self.functions.known.get_mut(&name.text)?;
        known.used = true;
        let function = Rc::clone(known.item.as_ref()?);
        self.arguments_fit(name, &function.arguments, arguments, span)?;
        let values = function.arguments.iter().zip(arguments);
        let values = all(values.map(|(argument, e)| self.argument(&name.text, argument, e)))?;
        if !self.has_room() {
            let error = Diagnostic::error(span, "too many functions call one another");
            return self.report(error.help("write out what the innermost ones say"));
        }
        let inside = format!("in the function `{}`, used here", name.text);
        self.diagnostics.enter(span, inside);
        let around = self.scope.look_from(&format!("{}().", name.text));
        for (argument, value) in function.arguments.iter().zip(values) {
            if let Err(diagnostic) = self.scope.declare(&argument.name, Kind::Argument) {
                self.report::<()>(*diagnostic);
            }
            self.scope.set(&argument.name.text, Some(value));
        }
        let value = self.evaluate(&function.value);
        self.scope.come_back(around);
        let value = value.and_then(|value| {
            self.in_declared_unit(
                &function.name,
                function.unit.as_ref(),
                (&function.value, value),
            )
        });
        self.diagnostics.leave();
        value
    }

    /// Refuses another number of arguments than there are names for.
    pub fn arguments_fit(
        &mut self,
        name: &Name,
        names: &[Argument],
        arguments: &[Expr],
        span: Span,
    ) -> Option<()> {
        if names.len() == arguments.len() {
            return Some(());
        }
        let message = takes_others(&name.text, &count(names.len()), arguments.len());
        let names: Vec<&str> = names.iter().map(|a| a.name.text.as_str()).collect();
        let help = format!("write `{}({})`", name.text, names.join(", "));
        self.report(Diagnostic::error(span, message).help(help))
    }

    /// The value of an argument, in the unit that it is declared with.
    pub fn argument(&mut self, of: &str, argument: &Argument, e: &Expr) -> Option<Value> {
        let value = self.evaluate(e)?;
        let Some(place) = &argument.unit else {
            return Some(value);
        };
        let unit = declared(Some(place));
        for scalar in value.scalars() {
            if let Err((wanted, found)) = unit.meet(scalar.unit) {
                let name = &argument.name.text;
                let wants = match wanted {
                    NONE => "an angle or a ratio".to_string(),
                    _ => format!("in {}", wanted.text()),
                };
                let message = format!(
                    "the argument `{name}` of `{of}` is {wants}, {}",
                    found.said()
                );
                let error = Diagnostic::error(e.span, message);
                let error = self.declare_bare(error, e, [wanted, found]);
                return self.report(error.also(place.span, DECLARED));
            }
        }
        Some(value.with_unit(unit))
    }
}

impl Evaluator {
    /// Refuses a value in another unit than the declared one.
    pub fn fits_in(
        &mut self,
        (name, place): (&Name, Option<&UnitExpr>),
        unit: Unit,
        (e, value): (&Expr, Scalar),
    ) -> Option<()> {
        let Err((declared, dimension)) = unit.meet(value.unit) else {
            return Some(());
        };
        let (text, unit_name) = (&name.text, declared.text());
        let found = dimension.said();
        let said = found.replacen("this", "its value", 1);
        let message = format!("`{text}` is declared in {unit_name}, {said}");
        let place = place.map_or(name.span, |unit| unit.span);
        let error = Diagnostic::error(e.span, message);
        let error = self.declare_bare(error, e, [declared, dimension]);
        self.report(error.labelled(found).also(place, DECLARED))
    }

    /// A value in the unit that its name is declared with: what bare numbers and symbols
    /// without unit have made is from here on in that unit.
    pub fn in_declared_unit(
        &mut self,
        name: &Name,
        place: Option<&UnitExpr>,
        (e, value): (&Expr, Value),
    ) -> Option<Value> {
        if place.is_none() {
            return Some(value);
        }
        let unit = declared(place);
        for scalar in value.scalars() {
            self.fits_in((name, place), unit, (e, scalar))?;
        }
        Some(value.with_unit(unit))
    }
}

/// A declared unit whose mistakes have been reported.
fn declared(unit: Option<&UnitExpr>) -> Unit {
    match unit.map(unit_names::resolve) {
        Some(Ok(dimension)) => Unit::Known(dimension),
        _ => Unit::Unchecked,
    }
}
