//! Constants and parameters, and what a build script changes about them.

use super::lowering::Lowering;
use super::order::{Definition, QUANTITIES, order};
use super::symbol::Symbol;
use super::value::{Scalar, Value};
use super::{Constant, Parameter};
use crate::diagnostic::{Diagnostic, nearest};
use crate::expr::{ExprId, Number};
use crate::syntax::Model;
use crate::syntax::ast::{Declaration, Declared, ExprKind, Item, ItemKind};
use crate::syntax::messages::did_you_mean;

impl Lowering<'_> {
    /// Checks that the build script changes what there is: whole constants and parameters,
    /// or their elements.
    pub fn changes_fit(&mut self, model: &Model) {
        let elements: Vec<String> = self.mechanism.constants.iter().map(element_name).collect();
        let first = |path: &String| {
            path.split(['.', '['])
                .next()
                .unwrap_or_default()
                .to_string()
        };
        let parts: Vec<String> = self.evaluator.parts.used.keys().map(first).collect();
        let names = |kind: Declared| -> Vec<String> {
            let declared = model.items.iter().filter_map(|item| match &item.kind {
                ItemKind::Declaration(d) if d.kind == kind => Some(d.name.text.clone()),
                _ => None,
            });
            let declared: Vec<String> = declared.collect();
            let in_part = |base: &str| parts.iter().any(|part| part == base);
            let inside = |element: &&String| {
                let base = element.split(['.', '[']).next().unwrap_or_default();
                let declared = declared.iter().any(|name| name == base);
                base != element.as_str() && (declared || in_part(base))
            };
            let elements = elements.iter().filter(inside).cloned().collect();
            [declared, elements].concat()
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
            if known.contains(name) {
                continue;
            }
            let near = nearest(name, known.iter().map(String::as_str));
            let help = match near {
                Some(near) => did_you_mean(near),
                None if known.is_empty() => format!("the description declares no {kind}"),
                None => format!("the {kind}s of the description are {}", known.join(", ")),
            };
            let message =
                format!("the build script sets the {kind} `{name}`, which is not declared");
            self.report::<()>(Diagnostic::error(model.name.span, message).help(help));
        }
    }

    /// Evaluates the constants, each behind those it mentions.
    pub fn constants(&mut self, items: &[(&Item, &Declaration)]) {
        let overridden: Vec<bool> = items
            .iter()
            .map(|(_, d)| {
                is_one_number(d)
                    && self
                        .changed(&self.evaluator.scope.full(&d.name.text))
                        .is_some()
            })
            .collect();
        let definitions: Vec<_> = items
            .iter()
            .zip(&overridden)
            .map(|((_, d), overridden)| Definition {
                name: &d.name,
                mentions: match overridden {
                    true => Vec::new(),
                    false => self.evaluator.functions.mentions(d.formulas()),
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

    /// What the build script gives a constant or an element of one.
    fn changed(&self, name: &str) -> Option<f64> {
        let changes = self.constants.iter().rev();
        let change = changes.into_iter().find(|(changed, _)| changed == name);
        change.map(|(_, value)| *value)
    }

    fn constant(&mut self, item: &Item, declaration: &Declaration) -> Option<()> {
        let name = &declaration.name.text;
        let unit = self.unit(declaration.unit.as_ref());
        let full = self.evaluator.scope.full(name);
        let value = match self.changed(&full) {
            Some(value) if is_one_number(declaration) => {
                let id = self.changed_constant(declaration, value)?;
                Value::Scalar(Scalar { id, unit })
            }
            Some(_) => {
                let message = format!("the build script sets all of `{full}` to one number");
                let error = Diagnostic::error(declaration.name.span, message);
                return self.report(error.help(format!("set its elements, such as `{full}[0]`")));
            }
            None => self.constant_value(declaration, "a constant")?,
        };
        let mut scalars = Vec::new();
        for (scalar, suffix) in value.scalars().into_iter().zip(value.suffixes()) {
            let mut quantity = self.quantity(item, &declaration.name, declaration.unit.as_ref());
            quantity.name.push_str(&suffix);
            let changed = match suffix.is_empty() {
                true => None,
                false => self.changed(&quantity.name),
            };
            let id = match changed {
                Some(value) => self.changed_constant(declaration, value)?,
                None => scalar.id,
            };
            scalars.push(Scalar { id, unit });
            let value = id;
            self.mechanism.constants.push(Constant { quantity, value });
        }
        let same = scalars
            .iter()
            .zip(value.scalars())
            .all(|(a, b)| a.id == b.id);
        let value = match same {
            true => value.with_unit(unit),
            false => value.with_scalars(scalars),
        };
        self.evaluator.scope.set(name, Some(value));
        Some(())
    }

    /// The value that the build script gives, as exact as it is written there.
    fn changed_constant(&mut self, declaration: &Declaration, value: f64) -> Option<ExprId> {
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
        Some(self.evaluator.graph.number(number))
    }

    /// The value of a formula of numbers and constants, in the declared unit.
    fn constant_value(&mut self, declaration: &Declaration, what: &'static str) -> Option<Value> {
        let unit = self.unit(declaration.unit.as_ref());
        self.evaluator.constant = Some(what);
        let value = self.evaluator.declared_value(declaration, what);
        self.evaluator.constant = None;
        let value = value?;
        for scalar in value.scalars() {
            self.fits(declaration, unit, scalar)?;
        }
        Some(value.with_unit(unit))
    }

    /// Evaluates the default of a parameter; each number of it is a parameter of its own.
    pub fn parameter(&mut self, item: &Item, declaration: &Declaration) -> Option<()> {
        let name = &declaration.name.text;
        let value = self.constant_value(declaration, "the default of a parameter")?;
        let whole = self.frozen.contains(&self.evaluator.scope.full(name));
        let mut scalars = Vec::new();
        for (scalar, suffix) in value.scalars().into_iter().zip(value.suffixes()) {
            let mut quantity = self.quantity(item, &declaration.name, declaration.unit.as_ref());
            quantity.name.push_str(&suffix);
            let (default, value) = (scalar.id, scalar.id);
            if whole || self.frozen.contains(&quantity.name) {
                self.mechanism.constants.push(Constant { quantity, value });
                scalars.push(scalar);
                continue;
            }
            let index = self.mechanism.parameters.len() as u32;
            let id = self.evaluator.graph.symbol(Symbol::Parameter(index));
            let parameter = Parameter { quantity, default };
            self.mechanism.parameters.push(parameter);
            scalars.push(Scalar { id, ..scalar });
        }
        let value = value.with_scalars(scalars);
        self.evaluator.scope.set(name, Some(value));
        Some(())
    }
}

/// Whether a declaration is of one number, as far as it shows before it is evaluated.
fn is_one_number(declaration: &Declaration) -> bool {
    let list = matches!(
        declaration.value.kind,
        ExprKind::Vector(_) | ExprKind::InUnit(..)
    );
    declaration.size.is_none() && !list
}

fn element_name(constant: &Constant) -> String {
    constant.quantity.name.clone()
}
