//! `modelDescription.xml`: what an FMU has, in the words of FMI 2.0.
//!
//! In:  a checked mechanism.
//! Out: text. The order of the variables is that of their value references, which
//!      `fmi2.c` counts in the same order.

use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::{Mechanism, Quantity};
use std::collections::BTreeSet;
use std::fmt::Write;

/// A variable of an FMU.
struct Variable {
    name: String,
    unit: String,
    docs: String,
    kind: Kind,
}

/// What may be done with a variable.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// A coordinate or a velocity; the derivative of the variable with this number.
    State(Option<usize>),
    /// The derivative of the variable with this number.
    Derivative(usize),
    /// Something computed that is of interest now and then.
    Local,
    /// Fixed before the motion begins, with this default.
    Parameter(f64),
    /// Set from outside, with what it is until then.
    Input(f64),
    /// An output of the description.
    Output,
}

/// All variables, in the order of their value references.
fn variables(mechanism: &Mechanism) -> Vec<Variable> {
    let mut all = moving(mechanism);
    let value = |e: ExprId| value(mechanism, e);
    let parameters = mechanism.parameters.iter();
    all.extend(parameters.map(|p| named(&p.quantity, Kind::Parameter(value(p.default)))));
    let inputs = mechanism.inputs.iter();
    all.extend(inputs.map(|u| named(&u.quantity, Kind::Input(value(u.law)))));
    let outputs = mechanism.outputs.iter();
    all.extend(outputs.map(|y| named(&y.quantity, Kind::Output)));
    for (velocity, order) in [(false, 0), (true, 1)] {
        all.extend(mechanism.coordinates.iter().enumerate().map(|(i, q)| {
            let of = match velocity {
                true => format!("der({})", q.name),
                false => q.name.clone(),
            };
            let kind = Kind::Parameter(start(mechanism, i, velocity));
            let unit = per_second(&q.unit, order);
            made(format!("start({of})"), q, unit, "start of", kind)
        }));
    }
    for (name, docs) in [
        ("kinetic", "kinetic energy"),
        ("potential", "potential energy"),
    ] {
        all.push(Variable {
            name: name.to_string(),
            unit: "J".to_string(),
            docs: docs.to_string(),
            kind: Kind::Local,
        });
    }
    apart(&mut all);
    all
}

/// Coordinates, velocities, accelerations and reactions.
fn moving(mechanism: &Mechanism) -> Vec<Variable> {
    let coordinates = || mechanism.coordinates.iter().enumerate();
    let n = mechanism.coordinates.len();
    let mut all = Vec::new();
    all.extend(coordinates().map(|(_, q)| named(q, Kind::State(None))));
    all.extend(coordinates().map(|(i, q)| {
        let (name, unit) = (format!("der({})", q.name), per_second(&q.unit, 1));
        made(name, q, unit, "velocity of", Kind::State(Some(i + 1)))
    }));
    all.extend(coordinates().map(|(i, q)| {
        let (name, unit) = (format!("der(der({}))", q.name), per_second(&q.unit, 2));
        made(
            name,
            q,
            unit,
            "acceleration of",
            Kind::Derivative(n + i + 1),
        )
    }));
    all.extend(coordinates().map(|(_, q)| {
        let (name, unit) = (format!("r({})", q.name), force(&q.unit));
        made(name, q, unit, "reaction force at", Kind::Local)
    }));
    all
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

/// The description of an FMU.
pub fn description(mechanism: &Mechanism, identifier: &str, guid: &str) -> String {
    let variables = variables(mechanism);
    let units: BTreeSet<&str> = variables
        .iter()
        .map(|variable| &*variable.unit)
        .filter(|unit| !unit.is_empty())
        .collect();
    let units: String = units
        .iter()
        .map(|unit| format!("    <Unit name=\"{}\"/>\n", escaped(unit)))
        .collect();
    let mut listed = String::new();
    for (reference, variable) in variables.iter().enumerate() {
        write_variable(&mut listed, reference, variable);
    }
    let about = escaped(mechanism.docs.lines().next().unwrap_or(""));
    let (name, version) = (escaped(&mechanism.name), env!("CARGO_PKG_VERSION"));
    let (events, structure) = (mechanism.events.len(), structure(&variables));
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{guid}" description="{about}" generationTool="bricard {version}" variableNamingConvention="flat" numberOfEventIndicators="{events}">
  <ModelExchange modelIdentifier="{identifier}" canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="true" canSerializeFMUstate="true"/>
  <CoSimulation modelIdentifier="{identifier}" canHandleVariableCommunicationStepSize="true" canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="true" canSerializeFMUstate="true"/>
  <UnitDefinitions>
{units}  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="10" tolerance="1e-9"/>
  <ModelVariables>
{listed}  </ModelVariables>
  <ModelStructure>
{structure}  </ModelStructure>
</fmiModelDescription>
"#
    )
}

fn write_variable(text: &mut String, reference: usize, variable: &Variable) {
    let (attributes, real) = match variable.kind {
        Kind::State(derivative) => {
            let derivative = derivative.map(|of| format!(" derivative=\"{of}\""));
            (OUTPUT, derivative.unwrap_or_default())
        }
        Kind::Derivative(of) => (LOCAL, format!(" derivative=\"{of}\"")),
        Kind::Local => (LOCAL, String::new()),
        Kind::Output => (OUTPUT, String::new()),
        Kind::Parameter(value) => (PARAMETER, format!(" start=\"{value:?}\"")),
        Kind::Input(value) => (INPUT, format!(" start=\"{value:?}\"")),
    };
    let unit = match &*variable.unit {
        "" => String::new(),
        unit => format!(" unit=\"{}\"", escaped(unit)),
    };
    let (name, docs) = (escaped(&variable.name), escaped(&variable.docs));
    let _never_fails = writeln!(
        text,
        "    <ScalarVariable name=\"{name}\" valueReference=\"{reference}\" \
         description=\"{docs}\" {attributes}>\n      <Real{unit}{real}/>\n    </ScalarVariable>"
    );
}

const OUTPUT: &str = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
const LOCAL: &str = "causality=\"local\" variability=\"continuous\" initial=\"calculated\"";
const PARAMETER: &str = "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"";
const INPUT: &str = "causality=\"input\" variability=\"continuous\"";

/// Which variables are outputs, derivatives, and computed at the start.
fn structure(variables: &[Variable]) -> String {
    let list = |element: &str, wanted: &dyn Fn(Kind) -> bool| {
        let numbered = variables.iter().enumerate();
        let wanted = numbered.filter(|(_, variable)| wanted(variable.kind));
        let unknowns: String = wanted
            .map(|(i, _)| format!("      <Unknown index=\"{}\"/>\n", i + 1))
            .collect();
        match unknowns.is_empty() {
            true => String::new(),
            false => format!("    <{element}>\n{unknowns}    </{element}>\n"),
        }
    };
    let is_output = |kind| matches!(kind, Kind::State(_) | Kind::Output);
    let is_derivative = |kind| matches!(kind, Kind::State(Some(_)) | Kind::Derivative(_));
    list("Outputs", &is_output)
        + &list("Derivatives", &is_derivative)
        + &list("InitialUnknowns", &|kind| {
            is_output(kind) || is_derivative(kind)
        })
}

/// A text as XML has it within quotes.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
