//! Declarations: names, then constants, parameters and coordinates, then
//! quantities and the laws of inputs.

use super::declared::Waiting;
use super::lowering::Lowering;
use super::messages::SIZE;
use super::order::{Definition, QUANTITIES, order};
use super::part::Placed;
use super::scope::Kind;
use super::symbol::Symbol;
use super::unit::Unit;
use super::unit_names;
use super::value::{Array, Scalar, Value};
use super::{Input, Quantity};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::Direction;
use crate::syntax::ast::{Declaration, Declared, ExprKind, Item, ItemKind, Let, Name, UnitExpr};
use std::rc::Rc;

/// The most coordinates of a mechanism.
const COORDINATES: i64 = 10_000;

impl<'a> Lowering<'a> {
    /// Reads all declarations outside loops, those of parts among them, and returns all
    /// statements.
    pub fn declare(&mut self, items: &'a [Item], library: &'a [Item]) -> Vec<Placed<'a>> {
        let mut placed = Vec::new();
        self.parts(items, library);
        self.functions(items.iter().chain(library));
        self.place(items, &Rc::default(), &mut placed);
        if self.evaluator.unread {
            self.place_unread(items, &mut placed);
        }
        let fresh: Vec<&Placed> = placed.iter().filter(|placed| placed.fresh).collect();
        for Placed { item, frame, .. } in &fresh {
            if let ItemKind::Declaration(d) = &item.kind
                && d.kind == Declared::Parameter
            {
                self.inside(frame, |this| this.parameter(item, d));
            }
        }
        for states in [false, true] {
            for Placed { item, frame, .. } in &fresh {
                if let ItemKind::Coordinate { state, .. } = &item.kind
                    && *state == states
                {
                    self.inside(frame, |this| this.coordinates(item));
                }
            }
        }
        self.set_flow();
        let inputs = fresh.iter().filter_map(|placed| match &placed.item.kind {
            ItemKind::Declaration(d) if d.kind == Declared::Input => Some((placed, d)),
            _ => None,
        });
        let inputs: Vec<_> = inputs.collect();
        let symbols = inputs
            .iter()
            .map(|(placed, d)| self.inside(&placed.frame, |this| this.input_symbol(d)));
        let symbols: Vec<_> = symbols.collect();
        self.all_quantities(&fresh);
        for ((placed, declaration), symbols) in inputs.into_iter().zip(symbols) {
            if let Some(symbols) = symbols {
                self.inside(&placed.frame, |this| {
                    this.input_law(placed.item, declaration, &symbols)
                });
            }
        }
        placed
    }

    /// Declares the name of a statement; false if it is taken or there is none.
    pub fn declare_name(&mut self, item: &Item) -> bool {
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
            ItemKind::Coordinate { name, state, .. } => match state {
                true => (name, Kind::State),
                false => (name, Kind::Coordinate),
            },
            ItemKind::Let(quantity) => match &quantity.value.kind {
                ExprKind::Call(called, _) if self.parts.contains_key(called.text.as_str()) => {
                    self.used_parts.push(called.text.clone());
                    (&quantity.name, Kind::Part)
                }
                _ => (&quantity.name, Kind::Quantity),
            },
            _ => return false,
        };
        self.declare_as(name, kind)
    }

    pub fn declare_as(&mut self, name: &Name, kind: Kind) -> bool {
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

    fn coordinates(&mut self, item: &Item) {
        let ItemKind::Coordinate {
            state,
            name,
            size,
            unit,
        } = &item.kind
        else {
            return;
        };
        let unit = unit.as_ref();
        let checked = self.unit(unit);
        let Some(size_expr) = size else {
            let whole = self.quantity(item, name, unit);
            let scalar = self.coordinate(whole, checked, *state);
            self.evaluator
                .scope
                .set(&name.text, Some(Value::Scalar(scalar)));
            return;
        };
        self.evaluator.constant = Some(SIZE);
        let size = self.evaluator.integer(size_expr, SIZE);
        self.evaluator.constant = None;
        let Some(size) = size.and_then(|size| self.size_fits(size, size_expr.span)) else {
            return;
        };
        let element = |i| {
            let mut part = self.quantity(item, name, unit);
            part.name.push_str(&format!("[{i}]"));
            Value::Scalar(self.coordinate(part, checked, *state))
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
            let error = Diagnostic::error(span, format!("an array can't have {size} coordinates"));
            return self.report(error.help("the size of an array is 1 or more"));
        }
        if size > room {
            let message = format!("more than {COORDINATES} coordinates");
            return self.report(
                Diagnostic::error(span, message).help("make the arrays of `coord` smaller"),
            );
        }
        Some(size)
    }

    /// A coordinate, or the velocity of one, which is a state.
    fn coordinate(&mut self, quantity: Quantity, unit: Unit, state: bool) -> Scalar {
        let index = self.mechanism.coordinates.len() as u32;
        self.mechanism.coordinates.push(quantity);
        let symbol = match state {
            true => Symbol::Velocity(index),
            false => Symbol::Coordinate(index),
        };
        self.mechanism.states += usize::from(state);
        let id = self.evaluator.graph.symbol(symbol);
        Scalar { id, unit }
    }

    /// From here on `der` knows what moves.
    fn set_flow(&mut self) {
        let freedoms = self.mechanism.freedoms() as u32;
        let graph = &mut self.evaluator.graph;
        let mut seeds = vec![(Symbol::Time, graph.integer(1))];
        for i in 0..self.mechanism.coordinates.len() as u32 {
            let (velocity, acceleration) = (Symbol::Velocity(i), Symbol::Acceleration(i));
            if i < freedoms {
                seeds.push((Symbol::Coordinate(i), graph.symbol(velocity)));
            }
            seeds.push((velocity, graph.symbol(acceleration)));
        }
        self.evaluator.flow = Direction::new(seeds);
        self.evaluator.analyses.first_state = Some(freedoms);
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
        self.without_acceleration(&declaration.value, &law.scalars(), what)?;
        let (place, suffixes) = (declaration.value.span, symbols.suffixes());
        if law.suffixes() != suffixes {
            let message = format!(
                "each element of this input has to be a number, here it is {}",
                law.shape()
            );
            return self.report(Diagnostic::error(place, message));
        }
        for (law, suffix) in law.scalars().into_iter().zip(suffixes) {
            self.fits(declaration, unit, law)?;
            if self.evaluator.analysis(law.id).input {
                let error = Diagnostic::error(place, "the law of an input contains an input");
                return self.report(error.help("write the other law here, or make it a `let`"));
            }
            let mut quantity = self.quantity(item, &declaration.name, declaration.unit.as_ref());
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

    /// Evaluates the quantities outside loops, each behind those that it mentions, as far as
    /// that shows; others are evaluated when they are asked for.
    fn all_quantities(&mut self, fresh: &[&Placed<'a>]) {
        for Placed { item, frame, .. } in fresh {
            if let ItemKind::Let(quantity) = &item.kind {
                let full = format!("{}{}", frame.prefix, quantity.name.text);
                self.unit(quantity.unit.as_ref());
                let waiting = Waiting {
                    quantity: Rc::new((**quantity).clone()),
                    frame: Rc::clone(frame),
                    index: None,
                    argument_of: None,
                };
                self.waits(full, waiting);
            }
        }
        let all = std::mem::take(&mut self.waiting);
        let names: Vec<Name> = all.iter().map(|full| self.waiting_name(full)).collect();
        let definitions: Vec<Definition> = names.iter().map(|n| self.definition(n)).collect();
        let sorted = order(&definitions, QUANTITIES, &mut self.evaluator.diagnostics);
        let mut circular = vec![true; names.len()];
        sorted.iter().for_each(|&i| circular[i] = false);
        for (name, _) in names.iter().zip(circular).filter(|(_, circular)| *circular) {
            self.evaluator.parts.waiting.remove(&name.text);
        }
        for i in sorted {
            let name = &names[i];
            self.evaluator
                .evaluate_waiting(&name.text, Kind::Quantity, name.span);
        }
        self.evaluator.parts.waiting.clear();
    }

    /// The name of a quantity that waits, in full.
    fn waiting_name(&self, full: &str) -> Name {
        let waiting = self.evaluator.parts.waiting.get(full);
        Name {
            text: full.to_string(),
            span: waiting
                .map(|waiting| waiting.quantity.name.span)
                .unwrap_or_default(),
        }
    }

    /// A quantity that waits, by what it mentions.
    fn definition<'n>(&self, name: &'n Name) -> Definition<'n> {
        let Some(waiting) = self.evaluator.parts.waiting.get(&name.text) else {
            return Definition {
                name,
                mentions: Vec::new(),
                recursive: false,
            };
        };
        let prefix = &waiting.frame.prefix;
        let known = &self.evaluator.parts.waiting;
        let mentions = self
            .evaluator
            .functions
            .mentions(waiting.quantity.formulas());
        let in_full = |short: String| {
            let full = format!("{prefix}{short}");
            match known.contains_key(&full) {
                true => full,
                false => short,
            }
        };
        Definition {
            name,
            mentions: mentions.into_iter().map(in_full).collect(),
            recursive: waiting.quantity.range.is_some(),
        }
    }

    /// Evaluates the quantities of the body of a loop in an order of their own.
    fn quantities(&mut self, lets: &[&Let]) {
        let definitions: Vec<_> = lets
            .iter()
            .map(|quantity| Definition {
                name: &quantity.name,
                mentions: self.evaluator.functions.mentions(quantity.formulas()),
                recursive: quantity.range.is_some(),
            })
            .collect();
        for i in order(&definitions, QUANTITIES, &mut self.evaluator.diagnostics) {
            self.unit(lets[i].unit.as_ref());
            let (value, bare) = self.evaluator.quantity(lets[i]);
            self.evaluator.scope.set(&lets[i].name.text, value);
            self.evaluator.scope.set_bare(&lets[i].name.text, bare);
        }
    }

    /// A quantity as it is declared, with its name in full.
    pub fn quantity(&self, item: &Item, name: &Name, unit: Option<&UnitExpr>) -> Quantity {
        Quantity {
            name: self.evaluator.scope.full(&name.text),
            unit: unit.map(|unit| unit.text.clone()).unwrap_or_default(),
            docs: item.docs.clone(),
            span: self.place_of(name.span),
        }
    }

    /// The declared unit; [`Unit::Unchecked`] if there is none.
    pub fn unit(&mut self, unit: Option<&UnitExpr>) -> Unit {
        match unit.map(unit_names::resolve) {
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
