//! Declarations: names, then constants, parameters and coordinates, then
//! quantities and the laws of inputs.

use super::lower::Lowering;
use super::order::{Definition, QUANTITIES, order};
use super::scope::Kind;
use super::si;
use super::unit::Unit;
use super::value::{Array, Scalar, Value};
use super::{Input, Quantity};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::Symbol;
use crate::parse::ast::{Declaration, Declared, Expr, Item, ItemKind, Let, Name, UnitExpr};
use std::rc::Rc;

/// The most coordinates of a mechanism.
const COORDINATES: i64 = 10_000;

impl Lowering<'_> {
    /// Reads all declarations outside loops.
    pub fn declare(&mut self, items: &[Item]) {
        let fresh: Vec<&Item> = items
            .iter()
            .filter(|item| self.declare_name(item))
            .collect();
        let declarations = || {
            fresh.iter().filter_map(|item| match &item.kind {
                ItemKind::Declaration(declaration) => Some((*item, declaration)),
                _ => None,
            })
        };
        let of = |kind| declarations().filter(move |(_, d)| d.kind == kind);
        self.evaluator.scope.set_outermost();
        self.functions(items);
        self.constants(&of(Declared::Constant).collect::<Vec<_>>());
        for (item, declaration) in of(Declared::Parameter) {
            self.parameter(item, declaration);
        }
        for item in &fresh {
            if let ItemKind::Coordinate { name, size, unit } = &item.kind {
                self.coordinates(item, name, size.as_ref(), unit.as_ref());
            }
        }
        self.set_flow();
        let inputs: Vec<_> = of(Declared::Input).collect();
        let symbols: Vec<_> = inputs.iter().map(|(_, d)| self.input_symbol(d)).collect();
        let lets: Vec<&Let> = fresh.iter().filter_map(|item| as_let(item)).collect();
        self.quantities(&lets);
        for ((item, declaration), symbols) in inputs.into_iter().zip(symbols) {
            if let Some(symbols) = symbols {
                self.input_law(item, declaration, &symbols);
            }
        }
    }

    /// Declares the name of a statement; false if it is taken or there is none.
    fn declare_name(&mut self, item: &Item) -> bool {
        let (name, kind) = match &item.kind {
            ItemKind::Declaration(declaration) => {
                let kind = match declaration.kind {
                    Declared::Constant => Kind::Constant,
                    Declared::Parameter => Kind::Parameter,
                    Declared::Input => Kind::Input,
                    Declared::Output => return false,
                };
                (&declaration.name, kind)
            }
            ItemKind::Coordinate { name, .. } => (name, Kind::Coordinate),
            ItemKind::Let(quantity) => (&quantity.name, Kind::Quantity),
            _ => return false,
        };
        self.declare_as(name, kind)
    }

    fn declare_as(&mut self, name: &Name, kind: Kind) -> bool {
        match self.evaluator.scope.declare(name, kind) {
            Ok(()) => true,
            Err(diagnostic) => {
                self.report::<()>(*diagnostic);
                false
            }
        }
    }

    /// Refuses a value in another unit than the declared one.
    pub fn fits(&mut self, declaration: &Declaration, unit: Unit, value: Scalar) -> Option<()> {
        let place = declaration.unit.as_ref();
        self.evaluator.fits_in(
            (&declaration.name, place),
            unit,
            (&declaration.value, value),
        )
    }

    fn in_unit(&mut self, quantity: &Let, value: Value) -> Option<Value> {
        self.unit(quantity.unit.as_ref());
        let (name, unit) = (&quantity.name, quantity.unit.as_ref());
        self.evaluator
            .in_declared_unit(name, unit, (&quantity.value, value))
    }

    fn coordinates(
        &mut self,
        item: &Item,
        name: &Name,
        size: Option<&Expr>,
        unit: Option<&UnitExpr>,
    ) {
        let checked = self.unit(unit);
        let Some(size_expr) = size else {
            let whole = quantity(item, name, unit);
            let scalar = self.coordinate(whole, checked);
            self.evaluator
                .scope
                .set(&name.text, Some(Value::Scalar(scalar)));
            return;
        };
        self.evaluator.constant = Some("the size of an array");
        let size = self.evaluator.integer(size_expr, "the size of an array");
        self.evaluator.constant = None;
        let Some(size) = size.and_then(|size| self.size_fits(size, size_expr.span)) else {
            return;
        };
        let element = |i| {
            let mut part = quantity(item, name, unit);
            part.name = format!("{}[{i}]", name.text);
            Value::Scalar(self.coordinate(part, checked))
        };
        let items = (0..size).map(element).collect();
        let array = Value::Array(Rc::new(Array {
            first: 0,
            items,
            end: size,
        }));
        self.evaluator.scope.set(&name.text, Some(array));
    }

    fn size_fits(&mut self, size: i64, span: Span) -> Option<i64> {
        let room = COORDINATES - self.mechanism.coordinates.len() as i64;
        if size < 1 {
            let error = Diagnostic::error(span, format!("an array of {size} coordinates"));
            return self.report(error.help("the size of an array is 1 or more"));
        }
        if size > room {
            let message = format!("more than {COORDINATES} coordinates");
            return self.report(Diagnostic::error(span, message));
        }
        Some(size)
    }

    fn coordinate(&mut self, quantity: Quantity, unit: Unit) -> Scalar {
        let index = self.mechanism.coordinates.len() as u32;
        self.mechanism.coordinates.push(quantity);
        Scalar {
            id: self.evaluator.graph.symbol(Symbol::Coordinate(index)),
            unit,
        }
    }

    /// From here on `der` knows what moves.
    fn set_flow(&mut self) {
        let count = self.mechanism.coordinates.len() as u32;
        let moving = (0..count).map(Symbol::Coordinate);
        let flow = self
            .evaluator
            .graph
            .frozen_flow(moving.chain([Symbol::Time]));
        self.evaluator.flow = flow;
    }

    fn input_symbol(&mut self, declaration: &Declaration) -> Option<Value> {
        let symbols = self.input_symbols(declaration, self.n_inputs)?;
        self.n_inputs += symbols.scalars().len() as u32;
        let name = &declaration.name.text;
        self.evaluator.scope.set(name, Some(symbols.clone()));
        Some(symbols)
    }

    /// The law of an input. Its numbers are gains in units of their own: with
    /// them, `10 - 2*der(q1)` is a moment.
    fn input_law(&mut self, item: &Item, declaration: &Declaration, symbols: &Value) -> Option<()> {
        let unit = self.unit(declaration.unit.as_ref());
        let what = "the law of an input";
        self.evaluator.gains = true;
        let law = match symbols {
            Value::Scalar(_) => {
                (self.evaluator.scalar(&declaration.value, what)).map(Value::Scalar)
            }
            _ => self.evaluator.declared_value(declaration, what),
        };
        self.evaluator.gains = false;
        let law = law?;
        let (place, suffixes) = (declaration.value.span, symbols.suffixes());
        if law.suffixes() != suffixes {
            let message = format!("the elements of this law are {}, not numbers", law.shape());
            return self.report(Diagnostic::error(place, message));
        }
        for (law, suffix) in law.scalars().into_iter().zip(suffixes) {
            self.fits(declaration, unit, law)?;
            if self.evaluator.facts(law.id).input {
                let error = Diagnostic::error(place, "the law of an input contains an input");
                return self.report(error.help("write the other law here, or make it a `let`"));
            }
            let mut quantity = quantity(item, &declaration.name, declaration.unit.as_ref());
            quantity.name.push_str(&suffix);
            let law = law.id;
            self.mechanism.inputs.push(Input { quantity, law });
        }
        Some(())
    }

    /// Declares and evaluates the quantities of the body of a loop.
    pub fn local_quantities(&mut self, items: &[Item]) {
        let lets: Vec<&Let> = items.iter().filter_map(as_let).collect();
        let fresh = lets
            .into_iter()
            .filter(|l| self.declare_as(&l.name, Kind::Quantity));
        let fresh: Vec<&Let> = fresh.collect();
        self.quantities(&fresh);
    }

    /// Evaluates quantities in an order of their own.
    fn quantities(&mut self, lets: &[&Let]) {
        let definitions: Vec<_> = lets
            .iter()
            .map(|quantity| {
                let range = quantity
                    .range
                    .iter()
                    .flat_map(|range| [&range.from, &range.to]);
                let formulas = range.chain([&quantity.value]);
                Definition {
                    name: &quantity.name,
                    mentions: self.evaluator.functions.mentions(formulas),
                    recursive: quantity.range.is_some(),
                }
            })
            .collect();
        for i in order(&definitions, QUANTITIES, &mut self.evaluator.diagnostics) {
            let value = match &lets[i].range {
                None => self.evaluator.evaluate(&lets[i].value),
                Some(range) => self.evaluator.array(&lets[i].name, range, &lets[i].value),
            };
            let value = value.and_then(|value| self.in_unit(lets[i], value));
            let bare = match lets[i].unit {
                Some(_) => None,
                None => self.evaluator.bare(&lets[i].value),
            };
            self.evaluator.scope.set(&lets[i].name.text, value);
            self.evaluator.scope.set_bare(&lets[i].name.text, bare);
        }
    }

    /// The declared unit; [`Unit::Unchecked`] if there is none.
    pub fn unit(&mut self, unit: Option<&UnitExpr>) -> Unit {
        match unit.map(si::resolve) {
            None => Unit::Unchecked,
            Some(Ok(dimension)) => Unit::Known(dimension),
            Some(Err(diagnostic)) => {
                self.report::<()>(*diagnostic);
                Unit::Unchecked
            }
        }
    }
}

fn as_let(item: &Item) -> Option<&Let> {
    match &item.kind {
        ItemKind::Let(quantity) => Some(quantity),
        _ => None,
    }
}

/// A quantity as it is declared.
pub fn quantity(item: &Item, name: &Name, unit: Option<&UnitExpr>) -> Quantity {
    let unit = unit.map(|unit| unit.text.clone()).unwrap_or_default();
    Quantity {
        name: name.text.clone(),
        unit,
        docs: item.docs.clone(),
        span: name.span,
    }
}
