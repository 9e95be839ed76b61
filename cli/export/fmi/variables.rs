//! What an FMU has: its variables, the same for all versions of FMI.
//!
//! In:  a checked mechanism.
//! Out: variables, in the order of their value references, which `instance.c` counts in the
//!      same order.

use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::{Mechanism, Quantity};
use std::collections::BTreeSet;

/// A variable of an FMU.
pub struct Variable {
    pub name: String,
    pub unit: String,
    pub docs: String,
    pub kind: Kind,
}

/// What may be done with a variable.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    /// A coordinate, a velocity or a state of the first order; the derivative of the
    /// variable at this place.
    State(Option<usize>),
    /// The derivative of the variable at this place.
    Derivative(usize),
    /// Something computed that is of interest now and then.
    Local,
    /// Fixed before the motion begins, with this default.
    Parameter(f64),
    /// Set from outside, with what it is until then.
    Input(f64),
    /// An output of the description.
    Output,
    /// The function of an event.
    Indicator,
    /// The time.
    Time,
}

/// All variables, in the order of their value references.
pub fn variables(mechanism: &Mechanism) -> Vec<Variable> {
    let mut all = moving(mechanism);
    let value = |e: ExprId| value(mechanism, e);
    let parameters = mechanism.parameters.iter();
    all.extend(parameters.map(|p| named(&p.quantity, Kind::Parameter(value(p.default)))));
    let inputs = mechanism.inputs.iter();
    all.extend(inputs.map(|u| named(&u.quantity, Kind::Input(value(u.law)))));
    let outputs = mechanism.outputs.iter();
    all.extend(outputs.map(|y| named(&y.quantity, Kind::Output)));
    all.extend(starts(mechanism));
    for (name, docs) in [
        ("kinetic", "kinetic energy"),
        ("potential", "potential energy"),
    ] {
        all.push(plain(name, "J", docs, Kind::Local));
    }
    let events = mechanism.events.iter();
    all.extend(events.map(|event| {
        let docs = format!("function of the event `{}`", event.name);
        plain(
            &format!("event({})", event.name),
            "",
            &docs,
            Kind::Indicator,
        )
    }));
    all.push(plain("time", "s", "time", Kind::Time));
    apart(&mut all);
    all
}

/// What the motion begins with: coordinates, velocities, states of the first order, whose
/// integrals begin anywhere.
fn starts(mechanism: &Mechanism) -> Vec<Variable> {
    let numbered = || mechanism.coordinates.iter().enumerate();
    let freedoms = mechanism.freedoms();
    let positions = numbered().take(freedoms).map(|(i, q)| {
        let kind = Kind::Parameter(start(mechanism, i, false));
        made(
            format!("start({})", q.name),
            q,
            q.unit.clone(),
            "start of",
            kind,
        )
    });
    let velocities = numbered().map(|(i, q)| {
        let kind = Kind::Parameter(start(mechanism, i, true));
        let (of, unit, what) = match i < freedoms {
            true => (
                format!("der({})", q.name),
                per_second(&q.unit, 1),
                "start of the velocity of",
            ),
            false => (q.name.clone(), q.unit.clone(), "start of"),
        };
        made(format!("start({of})"), q, unit, what, kind)
    });
    positions.chain(velocities).collect()
}

/// Coordinates, velocities, states of the first order, what these change at, and reactions.
fn moving(mechanism: &Mechanism) -> Vec<Variable> {
    let (freedoms, states) = mechanism.coordinates.split_at(mechanism.freedoms());
    let numbered = || freedoms.iter().enumerate();
    let (n, behind) = (freedoms.len(), 2 * freedoms.len());
    let mut all: Vec<_> = freedoms
        .iter()
        .map(|q| named(q, Kind::State(None)))
        .collect();
    all.extend(numbered().map(|(i, q)| {
        let (name, unit) = (format!("der({})", q.name), per_second(&q.unit, 1));
        made(name, q, unit, "velocity of", Kind::State(Some(i)))
    }));
    all.extend(states.iter().map(|z| named(z, Kind::State(None))));
    all.extend(numbered().map(|(i, q)| {
        let (name, unit) = (format!("der(der({}))", q.name), per_second(&q.unit, 2));
        made(name, q, unit, "acceleration of", Kind::Derivative(n + i))
    }));
    all.extend(states.iter().enumerate().map(|(i, z)| {
        let (name, unit) = (format!("der({})", z.name), per_second(&z.unit, 1));
        made(name, z, unit, "rate of", Kind::Derivative(behind + i))
    }));
    all.extend(freedoms.iter().map(|q| {
        let (name, unit) = (format!("r({})", q.name), force(&q.unit));
        made(name, q, unit, "reaction force at", Kind::Local)
    }));
    all
}

/// A variable that every FMU has.
fn plain(name: &str, unit: &str, docs: &str, kind: Kind) -> Variable {
    Variable {
        name: name.to_string(),
        unit: unit.to_string(),
        docs: docs.to_string(),
        kind,
    }
}

/// A variable of the description's own.
fn named(quantity: &Quantity, kind: Kind) -> Variable {
    Variable {
        name: quantity.name.clone(),
        unit: quantity.unit.clone(),
        docs: quantity.docs.clone(),
        kind,
    }
}

/// A variable that belongs to a coordinate.
fn made(name: String, of: &Quantity, unit: String, what: &str, kind: Kind) -> Variable {
    Variable {
        docs: format!("{what} `{}`", of.name),
        name,
        unit,
        kind,
    }
}

/// Gives variables of one name several.
fn apart(variables: &mut [Variable]) {
    let mut taken = BTreeSet::new();
    for variable in variables {
        let wish = variable.name.clone();
        let mut number = 2;
        while !taken.insert(variable.name.clone()) {
            variable.name = format!("{wish}_{number}");
            number += 1;
        }
    }
}

/// The value of an expression at the default start; zero where that is no number.
fn value(mechanism: &Mechanism, e: ExprId) -> f64 {
    let at = |symbol: Symbol| match symbol {
        Symbol::Parameter(index) => {
            let parameter = mechanism.parameters.get(index as usize);
            parameter
                .and_then(|parameter| mechanism.graph.constant_value(parameter.default))
                .unwrap_or(0.0)
        }
        _ => 0.0,
    };
    let value = mechanism.graph.evaluate(e, &at);
    if value.is_finite() { value } else { 0.0 }
}

/// What inputs are told to be until they are set, as a list in C.
pub fn inputs(mechanism: &Mechanism) -> String {
    let laws = mechanism.inputs.iter();
    let values: Vec<String> = laws
        .map(|input| format!("{:?}", value(mechanism, input.law)))
        .collect();
    match values.is_empty() {
        true => "0.0".to_string(),
        false => values.join(", "),
    }
}

/// What the description gives for the start of a coordinate.
fn start(mechanism: &Mechanism, coordinate: usize, velocity: bool) -> f64 {
    let given = mechanism.starts.iter().rev();
    given
        .filter(|start| start.coordinate == coordinate && start.velocity == velocity)
        .map(|start| value(mechanism, start.value))
        .next()
        .unwrap_or(0.0)
}

fn per_second(unit: &str, order: usize) -> String {
    match (unit, order) {
        ("", _) => String::new(),
        (_, 0) => unit.to_string(),
        (_, 1) => format!("{unit}/s"),
        _ => format!("{unit}/s^2"),
    }
}

fn force(unit: &str) -> String {
    match unit {
        "m" => "N",
        "rad" => "N*m",
        _ => "",
    }
    .to_string()
}
