//! Statements: energies, forces, constraints, outputs, events, loops.

use super::language::REACTION;
use super::lowering::Lowering;
use super::messages::{BY_ROWS, ONE_SIZE, sides_are, sides_differ};
use super::scope::{Kind, twice};
use super::unit::{Dimension, ENERGY, NONE, POWER, Unit};
use super::value::{Scalar, Value};
use super::{Constraint, Direction, Event, Force, Output, Quantity, Summand};
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::ast::{
    Crossing, Declaration, Declared, Energy, Expr, Item, ItemKind, Name, Range,
};
use crate::syntax::messages::{REMOVE, RENAME};

/// Events that a run has room for.
const ROOM: usize = 64;

impl Lowering<'_> {
    /// Reads statements that aren't declarations.
    pub fn statements(&mut self, items: &[Item]) {
        for item in items {
            // What is wrong has been reported; the next statement is read anyway.
            let _ = self.statement(item);
        }
    }

    fn statement(&mut self, item: &Item) -> Option<()> {
        match &item.kind {
            ItemKind::Declaration(d) if d.kind == Declared::Output => self.output(item, d),
            ItemKind::Declaration(d) => {
                let word = match d.kind {
                    Declared::Constant => "const",
                    Declared::Parameter => "param",
                    _ => "input",
                };
                self.outermost(&d.name, word, " = …")
            }
            ItemKind::Coordinate { state, name, .. } => {
                self.outermost(name, if *state { "state" } else { "coord" }, "")
            }
            ItemKind::Function(function) => self.in_no_part(&function.name, "a function"),
            ItemKind::Part(part) => self.in_no_part(&part.name, "a part"),
            ItemKind::Use(library) => self.in_no_part(library, "`use`"),
            ItemKind::Let(_) => Some(()),
            ItemKind::Rate { of, value } => self.state_rate(of, value, item.span),
            ItemKind::Energy(kind, value) => self.energy(*kind, value),
            ItemKind::Force { force, on } => self.force(force, on, item.span),
            ItemKind::Constraint {
                name,
                left,
                right,
                text,
            } => {
                let named = match name {
                    Some(name) => Some(self.constraint_name(item, name)?),
                    None => None,
                };
                self.constraint((left, right), text, named, item.span)
            }
            ItemKind::Start(entries) => self.start(entries),
            ItemKind::Event {
                name,
                value,
                direction,
            } => self.event(name, value, *direction, item.span),
            ItemKind::Draw { shape, arguments } => self.draw(*shape, arguments, item.span),
            ItemKind::For(range, body) if is_empty(body) => {
                self.evaluator.bounds(range)?;
                self.evaluator.with_index(range, 0, |_| Some(()))?;
                let warning = Diagnostic::warning(item.span, "nothing stands in this loop");
                self.report(warning.help(REMOVE))
            }
            ItemKind::For(range, body) => self.repeat(range, |this| {
                let mark = this.evaluator.scope.open();
                this.local_quantities(body);
                this.statements(body);
                let local = this.evaluator.scope.close(mark);
                this.unused(&local);
            }),
        }
    }

    /// Refuses what stands in front of parts and loops.
    fn in_no_part(&mut self, name: &Name, what: &str) -> Option<()> {
        if self.indices.is_empty() && self.frame.prefix.is_empty() {
            return Some(());
        }
        let message = format!("{what} can't stand in a part or a loop");
        self.report(Diagnostic::error(name.span, message).help("write it in the mechanism itself"))
    }

    /// Refuses a declaration inside a loop.
    fn outermost(&mut self, name: &Name, word: &str, value: &str) -> Option<()> {
        if self.indices.is_empty() {
            return Some(());
        }
        let message = format!("`{}` is declared inside a loop", name.text);
        let array = format!("`{word} {}[K]{value};`", name.text);
        let help =
            format!("declare it in front of the loop, one for each index as an array: {array}");
        self.report(Diagnostic::error(name.span, message).help(help))
    }

    /// Does something for each index of a range, until something is wrong: the
    /// next round would only say the same.
    pub fn repeat(&mut self, range: &Range, mut body: impl FnMut(&mut Self)) -> Option<()> {
        let Some(bounds) = self.evaluator.bounds(range) else {
            return self.repeat_once(range, body);
        };
        if bounds.start > bounds.end {
            let span = range.from.span.to(range.to.span);
            let warning = Diagnostic::warning(span, "this range ends before it begins");
            self.report::<()>(warning.help("nothing is repeated; write the smaller bound first"));
        }
        let errors = self.evaluator.diagnostics.error_count();
        for i in bounds {
            self.evaluator.spend_round(range.index.span)?;
            let mark = self.evaluator.scope.open();
            if let Err(diagnostic) = self.evaluator.scope.declare(&range.index, Kind::Index) {
                return self.report(*diagnostic);
            }
            let id = self.evaluator.graph.integer(i);
            let index = Value::Scalar(Scalar::new(id, Unit::Number));
            self.evaluator.scope.set(&range.index.text, Some(index));
            self.indices.push((range.index.text.clone(), i));
            body(self);
            self.indices.pop();
            self.evaluator.scope.close(mark);
            if self.evaluator.diagnostics.error_count() > errors {
                self.named.cut_short = true;
                return None;
            }
        }
        Some(())
    }

    /// Does something once for a range whose bounds are unknown, while its index has no value: as
    /// [`Evaluator::look_once`].
    ///
    /// [`Evaluator::look_once`]: super::evaluate::Evaluator::look_once
    fn repeat_once(&mut self, range: &Range, mut body: impl FnMut(&mut Self)) -> Option<()> {
        if self.evaluator.unread {
            let mark = self.evaluator.scope.open();
            self.declare_as(&range.index, Kind::Index);
            // What loops name differs by their indices, which are no numbers here.
            let place = -1 - i64::from(range.index.span.start.offset);
            self.indices.push((range.index.text.clone(), place));
            body(self);
            self.indices.pop();
            self.evaluator.scope.close(mark);
        }
        None
    }

    fn energy(&mut self, kind: Energy, e: &Expr) -> Option<()> {
        let value = self.evaluator.scalar(e, "an energy")?;
        self.without_acceleration(e, &[value], "an energy")?;
        self.legal_energy(kind, e, value)?;
        let summand = Summand {
            value: value.id,
            span: self.place_of(e.span),
        };
        match kind {
            Energy::Dissipation if self.evaluator.graph.is_zero(value.id) => {}
            Energy::Kinetic => self.mechanism.kinetic.push(summand),
            Energy::Potential => self.mechanism.potential.push(summand),
            Energy::Dissipation => self.mechanism.dissipation.push(summand),
        }
        Some(())
    }

    fn force(&mut self, force: &Expr, on: &Expr, span: Span) -> Option<()> {
        let (strength, point) = (self.evaluator.evaluate(force), self.evaluator.evaluate(on));
        let (strength, point) = (strength?.operand(), point?.operand());
        let strength = self.spread(&strength, &point);
        let fits =
            matches!(point, Value::Scalar(_) | Value::Vector(_)) && strength.same_shape(&point);
        if !fits {
            let message = format!(
                "the force is {}, it works on {}",
                strength.shape(),
                point.shape()
            );
            let error = Diagnostic::error(force.span, message)
                .labelled(format!("this is {}", strength.shape()));
            let error = error.also(on.span, format!("this is {}", point.shape()));
            return self.report(error.help(
                "a number works on a coordinate, an angle or a length, a vector on a point",
            ));
        }
        self.without_acceleration(force, &strength.scalars(), "a force")?;
        self.without_acceleration(on, &point.scalars(), "what a force works on")?;
        let on_velocity = self.legal_target(on, &point)?;
        let product = if on_velocity { POWER } else { ENERGY };
        for (f, x) in strength.scalars().into_iter().zip(point.scalars()) {
            self.force_unit((force, f.unit), (on, x.unit), product)?;
        }
        let ids = |value: Value| {
            value
                .scalars()
                .into_iter()
                .map(|scalar| scalar.id)
                .collect()
        };
        self.mechanism.forces.push(Force {
            force: ids(strength),
            on: ids(point),
            on_velocity,
            span: self.place_of(span),
        });
        Some(())
    }

    /// Refuses a force whose product with what it works on is no energy, or no power.
    fn force_unit(
        &mut self,
        (force, strength): (&Expr, Unit),
        (on, point): (&Expr, Unit),
        product: Dimension,
    ) -> Option<()> {
        let Unit::Known(place) = point.power(-1.0) else {
            return Some(());
        };
        let wanted = product.times(place);
        match strength {
            Unit::Known(found) if found != wanted => {
                let units = [wanted, found];
                let (found, wanted) = (found.text(), wanted.text());
                let message = format!("this force is in {found}, here it has to be in {wanted}");
                let target = match place {
                    NONE => "this is in rad".to_string(),
                    _ => place.power(-1.0).map_or(String::new(), Dimension::said),
                };
                let error = Diagnostic::error(force.span, message).also(on.span, target);
                let error =
                    error.help("a force works on a length or a point, a moment on an angle");
                let error = self.evaluator.declare_bare(error, force, units);
                self.report(error)
            }
            _ => Some(()),
        }
    }

    /// Refuses two constraints of one name; in a loop the index belongs to it.
    fn constraint_name(&mut self, item: &Item, name: &Name) -> Option<Quantity> {
        let full = self.indexed(&name.text);
        let mut multiplier = self.quantity(item, name, None);
        multiplier.name = format!("{REACTION}({full})");
        match self.named.constraints.insert(full, name.span) {
            Some(first) => self.report(twice(name, first)),
            None => Some(multiplier),
        }
    }

    fn constraint(
        &mut self,
        (left, right): (&Expr, &Expr),
        text: &str,
        named: Option<Quantity>,
        span: Span,
    ) -> Option<()> {
        let (a, b) = (
            self.evaluator.evaluate(left),
            self.evaluator.evaluate(right),
        );
        let (a, b) = (a?.operand(), b?.operand());
        let (a, b) = (self.spread(&a, &b), self.spread(&b, &a));
        let vectors = matches!(a, Value::Scalar(_) | Value::Vector(_)) && a.same_shape(&b);
        if !vectors {
            let (message, help) = match a.same_shape(&b) {
                true => (sides_are("equation", &a), BY_ROWS),
                false => (sides_differ("equation", &a, &b), ONE_SIZE),
            };
            let error = Diagnostic::error(left.span.to(right.span), message);
            return self.report(error.help(help));
        }
        for (side, value) in [(left, &a), (right, &b)] {
            self.without_acceleration(side, &value.scalars(), "a constraint")?;
        }
        let suffixes = a.suffixes();
        let mut active = false;
        for ((a, b), suffix) in a.scalars().into_iter().zip(b.scalars()).zip(suffixes) {
            let sides = [(a, left.span), (b, right.span)];
            let unit = self.evaluator.same_unit(sides, "this equation")?;
            let residual = self.evaluator.graph.sub(a.id, b.id);
            let residual = self.evaluator.valid(residual, span)?;
            let Some(holonomic) = self.legal_constraint(residual, [left, right])? else {
                continue;
            };
            active = true;
            let text = self.row_text(text, &suffix);
            let multiplier = named.clone().map(|named| Quantity {
                name: format!("{}{suffix}", named.name),
                unit: multiplier_unit(unit, holonomic),
                ..named
            });
            self.mechanism.constraints.push(Constraint {
                residual,
                holonomic,
                text,
                multiplier,
                span: self.place_of(span),
            });
        }
        // A part is written for many uses: in some of them an equation says nothing.
        if !active && self.frame.prefix.is_empty() {
            let warning = Diagnostic::warning(span, "this equation always holds");
            return self.report(warning.help(REMOVE));
        }
        Some(())
    }

    /// A literal zero stands for a zero vector where the other side is a vector.
    fn spread(&self, value: &Value, other: &Value) -> Value {
        match (value, other) {
            (Value::Scalar(zero), Value::Vector(parts))
                if self.evaluator.graph.is_zero(zero.id) =>
            {
                Value::Vector(vec![*zero; parts.len()])
            }
            _ => value.clone(),
        }
    }

    /// An equation as written, with the component and the indices it is for.
    pub fn row_text(&self, text: &str, suffix: &str) -> String {
        let row = match suffix.strip_prefix('.') {
            Some(axis) => format!(" [{axis}]"),
            None if suffix.is_empty() => String::new(),
            None => format!(" {suffix}"),
        };
        let indices: Vec<_> = self
            .indices
            .iter()
            .map(|(name, i)| format!("{name}={i}"))
            .collect();
        let indices = if indices.is_empty() {
            String::new()
        } else {
            format!(" [{}]", indices.join(", "))
        };
        let part = match self.frame.prefix.strip_suffix('.') {
            Some(part) => format!(" in {part}"),
            None => String::new(),
        };
        format!("{text}{row}{indices}{part}")
    }

    /// The name of what is declared inside loops: `hit[0]`, `hit[1]`.
    fn indexed(&self, name: &str) -> String {
        let indices: String = self.indices.iter().map(|(_, i)| format!("[{i}]")).collect();
        format!("{}{indices}", self.evaluator.scope.full(name))
    }

    fn output(&mut self, item: &Item, declaration: &Declaration) -> Option<()> {
        let checked = self.unit(declaration.unit.as_ref());
        let value = self.evaluator.evaluate(&declaration.value)?;
        let name = self.indexed(&declaration.name.text);
        for (scalar, suffix) in value.scalars().into_iter().zip(value.suffixes()) {
            self.fits(declaration, checked, scalar)?;
            let unit = declaration.unit.as_ref();
            let mut quantity = self.quantity(item, &declaration.name, unit);
            quantity.name = format!("{name}{suffix}");
            self.column_is_free(&quantity.name, &declaration.name)?;
            let accelerated = self.evaluator.analysis(scalar.id).acceleration;
            self.mechanism.outputs.push(Output {
                quantity,
                value: scalar.id,
                accelerated,
            });
        }
        Some(())
    }

    /// Refuses an output whose column has the name of another column.
    fn column_is_free(&mut self, column: &str, name: &Name) -> Option<()> {
        if column == "t" {
            let error = Diagnostic::error(name.span, "`t` is the time already");
            return self.report(error.help(RENAME));
        }
        let coordinate = self.mechanism.coordinates.iter().find(|q| q.name == column);
        let taken = coordinate
            .map(|q| q.span)
            .or_else(|| self.named.outputs.get(column).copied());
        if let Some(first) = taken {
            return self.report(twice(name, first));
        }
        self.named.outputs.insert(column.to_string(), name.span);
        Some(())
    }

    fn event(&mut self, name: &Name, value: &Expr, direction: Crossing, span: Span) -> Option<()> {
        if self.mechanism.events.len() == ROOM {
            let message = format!("there are more than {ROOM} events, for which a run has no room");
            return self.report(Diagnostic::error(span, message).help("leave some out"));
        }
        let scalar = self.evaluator.scalar(value, "an event function")?;
        self.without_acceleration(value, &[scalar], "an event function")?;
        if self.evaluator.analysis(scalar.id).is_fixed() {
            let warning = Diagnostic::warning(value.span, "this never changes");
            self.report::<()>(warning.help("write what changes its sign: `x - 0.5 rising`"));
        }
        let full = self.indexed(&name.text);
        if let Some(first) = self.named.events.insert(full.clone(), name.span) {
            return self.report(twice(name, first));
        }
        let direction = match direction {
            Crossing::Rising => Direction::Rising,
            Crossing::Falling => Direction::Falling,
            Crossing::Crossing => Direction::Crossing,
        };
        self.mechanism.events.push(Event {
            name: full,
            value: scalar.id,
            direction,
            span: self.place_of(span),
        });
        Some(())
    }
}

/// The unit of a multiplier: with the equation it makes an energy, with a rate a power;
/// empty if that of the equation is not known.
fn multiplier_unit(equation: Unit, holonomic: bool) -> String {
    let work = if holonomic { ENERGY } else { POWER };
    match equation.power(-1.0) {
        Unit::Known(inverse) => work.times(inverse).text(),
        _ => String::new(),
    }
}

/// Whether nothing but loops in which nothing stands is in the body of a loop.
fn is_empty(body: &[Item]) -> bool {
    let empty = |item: &Item| matches!(&item.kind, ItemKind::For(_, inner) if is_empty(inner));
    body.iter().all(empty)
}
