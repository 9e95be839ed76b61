//! Constants and parameters, and what a build script changes about them.

use super::declare::quantity;
use super::lower::Lowering;
use super::order::{Definition, QUANTITIES, order};
use super::unit::Unit;
use super::value::{Scalar, Value};
use super::{Constant, Parameter};
use crate::diagnostic::{Diagnostic, nearest};
use crate::expr::{ExprId, Number, Symbol};
use crate::parse::Model;
use crate::parse::ast::{Declaration, Declared, Item, ItemKind};

impl Lowering<'_> {
    /// Checks that the build script changes what there is.
    pub fn changes_fit(&mut self, model: &Model) {
        let names = |kind: Declared| -> Vec<&str> {
            let declared = model.items.iter().filter_map(|item| match &item.kind {
                ItemKind::Declaration(d) if d.kind == kind => Some(d.name.text.as_str()),
                _ => None,
            });
            declared.collect()
        };
        let constants = self
            .constants
            .iter()
            .map(|(name, _)| (name, "constant", Declared::Constant));
        let frozen = self
            .frozen
            .iter()
            .map(|name| (name, "parameter", Declared::Parameter));
        for (name, kind, declared) in constants.chain(frozen) {
            let known = names(declared);
            if known.contains(&name.as_str()) {
                continue;
            }
            let near = nearest(name, known.iter().copied());
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None if known.is_empty() => format!("the description declares no {kind}"),
                None => format!("the description declares {}", known.join(", ")),
            };
            let message =
                format!("the build script sets the {kind} `{name}`, which is not declared");
            self.report::<()>(Diagnostic::error(model.name.span, message).help(help));
        }
    }

    /// Evaluates the constants, each behind those it mentions.
    pub fn constants(&mut self, items: &[(&Item, &Declaration)]) {
        let definition = |(_, d): &(&'_ Item, &'_ Declaration)| -> bool {
            self.constants.iter().any(|(name, _)| *name == d.name.text)
        };
        let overridden: Vec<bool> = items.iter().map(definition).collect();
        let definitions: Vec<_> = items
            .iter()
            .zip(&overridden)
            .map(|((_, d), overridden)| Definition {
                name: &d.name,
                mentions: match overridden {
                    true => Vec::new(),
                    false => self.evaluator.functions.mentions([&d.value]),
                },
                recursive: false,
            })
            .collect();
        for i in order(&definitions, QUANTITIES, &mut self.evaluator.diagnostics) {
            self.constant(items[i].0, items[i].1);
        }
        let place = |constant: &Constant| constant.quantity.span.start.offset;
        self.mechanism.constants.sort_by_key(place);
    }

    fn constant(&mut self, item: &Item, declaration: &Declaration) {
        let changed = self
            .constants
            .iter()
            .rev()
            .find(|(name, _)| *name == declaration.name.text);
        let changed = changed.map(|(_, value)| *value);
        let Some((unit, id)) = (match changed {
            Some(value) => self.changed_constant(declaration, value),
            None => self.constant_value(declaration, "a constant"),
        }) else {
            return;
        };
        self.evaluator.scope.set(
            &declaration.name.text,
            Some(Value::Scalar(Scalar { id, unit })),
        );
        let quantity = quantity(item, &declaration.name, declaration.unit.as_ref());
        self.mechanism.constants.push(Constant {
            quantity,
            value: id,
        });
    }

    /// The value that the build script gives, as exact as it is written there.
    fn changed_constant(
        &mut self,
        declaration: &Declaration,
        value: f64,
    ) -> Option<(Unit, ExprId)> {
        let unit = self.unit(declaration.unit.as_ref());
        let size = Number::parse_literal(&format!("{:?}", value.abs()));
        let Some(size) = size.filter(|_| value.is_finite()) else {
            let name = &declaration.name;
            let message = format!(
                "the build script sets `{}` to {value}, which is not finite",
                name.text
            );
            return self.report(Diagnostic::error(name.span, message));
        };
        let number = if value < 0.0 { -size } else { size };
        Some((unit, self.evaluator.graph.number(number)))
    }

    /// The declared unit and the value of a formula of numbers and constants.
    fn constant_value(
        &mut self,
        declaration: &Declaration,
        what: &'static str,
    ) -> Option<(Unit, ExprId)> {
        let unit = self.unit(declaration.unit.as_ref());
        self.evaluator.constant = Some(what);
        let value = self.evaluator.scalar(&declaration.value, what);
        self.evaluator.constant = None;
        let value = value?;
        self.fits(declaration, unit, value)?;
        Some((unit, value.id))
    }

    /// Evaluates the default of a parameter.
    pub fn parameter(&mut self, item: &Item, declaration: &Declaration) {
        let Some((unit, default)) = self.constant_value(declaration, "the default of a parameter")
        else {
            return;
        };
        let quantity = quantity(item, &declaration.name, declaration.unit.as_ref());
        let id = if self.frozen.contains(&declaration.name.text) {
            self.mechanism.constants.push(Constant {
                quantity,
                value: default,
            });
            default
        } else {
            let index = self.mechanism.parameters.len() as u32;
            self.mechanism
                .parameters
                .push(Parameter { quantity, default });
            self.evaluator.graph.symbol(Symbol::Parameter(index))
        };
        self.evaluator.scope.set(
            &declaration.name.text,
            Some(Value::Scalar(Scalar { id, unit })),
        );
    }
}
