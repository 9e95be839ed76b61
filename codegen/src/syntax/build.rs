//! A description by calls, statement by statement.
//!
//! In:  statements of a program, as [`Formula`]s.
//! Out: [`Model`]; as text it is a description like one that a person writes.
//!
//! The statements that a program adds have no place in a file. So a model built by
//! calls is written down first ([`Model::text`]) and read again, and messages about it
//! show its lines.

use super::ast::{
    Crossing, Declaration, Declared, Drawing, Energy, Expr, ExprKind, Item, ItemKind, Let, Name,
    StartItem, UnitExpr,
};
use super::error::ModelError;
use super::formula::Formula;
use super::model::Model;
use super::{print, unit};
use crate::diagnostic::Span;

impl Model {
    /// A description with nothing in it but its name.
    pub fn new(name: &str) -> Self {
        let mut model = Self::named(here(name), String::new());
        model.check_name(name);
        model
    }

    /// The description as text, in the notation of `.mech` files.
    ///
    /// # Errors
    ///
    /// The texts that were given as formulas, units or names and can't be read as such.
    pub fn text(&self) -> Result<String, ModelError> {
        if self.faults.is_empty() {
            Ok(print::description(&self.name.text, &self.docs, &self.items))
        } else {
            Err(self.faults.clone())
        }
    }

    /// Documents what was added last; at first the mechanism itself.
    pub fn docs(mut self, text: &str) -> Self {
        let place = match self.items.last_mut() {
            Some(item) => &mut item.docs,
            None => &mut self.docs,
        };
        *place = text.trim().to_string();
        self
    }

    /// `const name: unit = value;` An empty unit is left out.
    pub fn constant(self, name: &str, unit: &str, value: impl Into<Formula>) -> Self {
        self.declaration(Declared::Constant, name, unit, value.into())
    }

    /// `param name: unit = value;`
    pub fn parameter(self, name: &str, unit: &str, value: impl Into<Formula>) -> Self {
        self.declaration(Declared::Parameter, name, unit, value.into())
    }

    /// `input name: unit = law;`
    pub fn input(self, name: &str, unit: &str, law: impl Into<Formula>) -> Self {
        self.declaration(Declared::Input, name, unit, law.into())
    }

    /// `output name: unit = value;`
    pub fn output(self, name: &str, unit: &str, value: impl Into<Formula>) -> Self {
        self.declaration(Declared::Output, name, unit, value.into())
    }

    /// `coord name: unit;`
    pub fn coordinate(mut self, name: &str, unit: &str) -> Self {
        self.check_name(name);
        let unit = self.unit(unit);
        self.statement(ItemKind::Coordinate {
            state: false,
            name: here(name),
            size: None,
            unit,
        })
    }

    /// `coord name[size]: unit;`
    pub fn coordinates(mut self, name: &str, size: impl Into<Formula>, unit: &str) -> Self {
        self.check_name(name);
        let size = Some(self.faults.accept(size.into()));
        let unit = self.unit(unit);
        self.statement(ItemKind::Coordinate {
            state: false,
            name: here(name),
            size,
            unit,
        })
    }

    /// `state name: unit; der(name) = rate;`
    pub fn state(mut self, name: &str, unit: &str, rate: impl Into<Formula>) -> Self {
        self.check_name(name);
        let unit = self.unit(unit);
        let value = self.faults.accept(rate.into());
        let declared = self.statement(ItemKind::Coordinate {
            state: true,
            name: here(name),
            size: None,
            unit,
        });
        let of = Expr {
            span: value.span,
            kind: ExprKind::Name(name.to_string()),
        };
        declared.statement(ItemKind::Rate { of, value })
    }

    /// `let name = value;`
    pub fn quantity(mut self, name: &str, value: impl Into<Formula>) -> Self {
        self.check_name(name);
        let value = self.faults.accept(value.into());
        self.statement(ItemKind::Let(Box::new(Let {
            name: here(name),
            range: None,
            unit: None,
            value,
        })))
    }

    /// `kinetic value;`
    pub fn kinetic(self, value: impl Into<Formula>) -> Self {
        self.energy(Energy::Kinetic, value.into())
    }

    /// `potential value;`
    pub fn potential(self, value: impl Into<Formula>) -> Self {
        self.energy(Energy::Potential, value.into())
    }

    /// `dissipation value;`
    pub fn dissipation(self, value: impl Into<Formula>) -> Self {
        self.energy(Energy::Dissipation, value.into())
    }

    /// `force force on point;`
    pub fn force(mut self, force: impl Into<Formula>, on: impl Into<Formula>) -> Self {
        let force = self.faults.accept(force.into());
        let on = self.faults.accept(on.into());
        self.statement(ItemKind::Force { force, on })
    }

    /// `constraint left = right;`
    pub fn constraint(mut self, left: impl Into<Formula>, right: impl Into<Formula>) -> Self {
        let left = self.faults.accept(left.into());
        let right = self.faults.accept(right.into());
        let text = format!("{} = {}", print::formula(&left), print::formula(&right));
        self.statement(ItemKind::Constraint {
            name: None,
            left,
            right,
            text,
        })
    }

    /// An entry `target = value;` of `start`: held.
    pub fn held(self, target: impl Into<Formula>, value: impl Into<Formula>) -> Self {
        self.start(target.into(), true, value.into())
    }

    /// An entry `target ~ value;` of `start`: a guess.
    pub fn guess(self, target: impl Into<Formula>, value: impl Into<Formula>) -> Self {
        self.start(target.into(), false, value.into())
    }

    /// `event name: value direction;`
    pub fn event(mut self, name: &str, value: impl Into<Formula>, direction: Crossing) -> Self {
        self.check_name(name);
        let value = self.faults.accept(value.into());
        self.statement(ItemKind::Event {
            name: here(name),
            value,
            direction,
        })
    }

    /// `draw shape(arguments);`
    pub fn draw<F: Into<Formula>>(
        mut self,
        shape: Drawing,
        arguments: impl IntoIterator<Item = F>,
    ) -> Self {
        let arguments = arguments.into_iter();
        let arguments = arguments.map(|part| self.faults.accept(part.into()));
        let arguments = arguments.collect();
        self.statement(ItemKind::Draw { shape, arguments })
    }

    fn statement(mut self, kind: ItemKind) -> Self {
        self.add(Item {
            docs: String::new(),
            span: Span::default(),
            kind,
        });
        self
    }

    fn declaration(mut self, kind: Declared, name: &str, unit: &str, value: Formula) -> Self {
        self.check_name(name);
        let unit = self.unit(unit);
        let value = self.faults.accept(value);
        self.statement(ItemKind::Declaration(Declaration {
            kind,
            name: here(name),
            size: None,
            unit,
            value,
        }))
    }

    fn energy(mut self, kind: Energy, value: Formula) -> Self {
        let value: Expr = self.faults.accept(value);
        self.statement(ItemKind::Energy(kind, value))
    }

    /// Adds to the `start` block in front, if there is one.
    fn start(mut self, target: Formula, held: bool, value: Formula) -> Self {
        let entry = StartItem::Entry {
            target: self.faults.accept(target),
            held,
            value: self.faults.accept(value),
        };
        if let Some(ItemKind::Start(entries)) = self.items.last_mut().map(|item| &mut item.kind) {
            entries.push(entry);
            return self;
        }
        self.statement(ItemKind::Start(vec![entry]))
    }

    fn unit(&mut self, text: &str) -> Option<UnitExpr> {
        if text.trim().is_empty() {
            return None;
        }
        match unit::read(text) {
            Ok(unit) => Some(unit),
            Err(diagnostics) => {
                self.faults.push(text, diagnostics);
                None
            }
        }
    }

    fn check_name(&mut self, name: &str) {
        self.faults.check_name(name);
    }
}

/// A name that stands in no file.
fn here(text: &str) -> Name {
    Name {
        text: text.to_string(),
        span: Span::default(),
    }
}
