//! `modelDescription.xml`: what an FMU has, in the words of FMI 2.0 or 3.0.
//!
//! In:  a checked mechanism.
//! Out: text.

use super::variables::{Kind, Variable, variables};
use super::version::Version;
use bricard_codegen::internals::model::Mechanism;
use std::collections::BTreeSet;
use std::fmt::Write;

/// What a description begins with.
pub struct About<'a> {
    pub version: Version,
    /// What functions and libraries are called by.
    pub identifier: &'a str,
    /// By what the library knows that it belongs to the description.
    pub token: &'a str,
    /// Whether directional derivatives are provided.
    pub differentiated: bool,
}

/// The description of an FMU.
pub fn description(mechanism: &Mechanism, about: &About) -> String {
    let variables = variables(mechanism);
    let docs = escaped(mechanism.docs.lines().next().unwrap_or(""));
    let (name, tool) = (escaped(&mechanism.name), env!("CARGO_PKG_VERSION"));
    let (version, token) = (about.version.number(), about.token);
    let own = match about.version {
        Version::Two => format!(
            "guid=\"{token}\" numberOfEventIndicators=\"{}\"",
            mechanism.events.len()
        ),
        Version::Three => format!("instantiationToken=\"{token}\""),
    };
    let capabilities = capabilities(about);
    let (units, listed) = (units(&variables), listed(about.version, &variables));
    let structure = structure(about.version, &variables);
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="{version}" modelName="{name}" {own} description="{docs}" generationTool="bricard {tool}" variableNamingConvention="flat">
{capabilities}  <UnitDefinitions>
{units}  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusDiscard"/>
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

/// What an FMU can do.
fn capabilities(about: &About) -> String {
    let (both, own, derivatives) = match about.version {
        Version::Two => (
            "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" \
             canSerializeFMUstate=\"true\"",
            "",
            " providesDirectionalDerivative=\"true\"",
        ),
        Version::Three => (
            "canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"",
            // States that have left the constraints are found there.
            " needsCompletedIntegratorStep=\"true\"",
            " providesDirectionalDerivatives=\"true\"",
        ),
    };
    let derivatives = if about.differentiated {
        derivatives
    } else {
        ""
    };
    let identifier = about.identifier;
    format!(
        "  <ModelExchange modelIdentifier=\"{identifier}\" {both}{own}{derivatives}/>\n  \
         <CoSimulation modelIdentifier=\"{identifier}\" \
         canHandleVariableCommunicationStepSize=\"true\" {both}{derivatives}/>\n"
    )
}

/// The units that there are.
fn units(variables: &[Variable]) -> String {
    let units: BTreeSet<&str> = variables
        .iter()
        .map(|variable| &*variable.unit)
        .filter(|unit| !unit.is_empty())
        .collect();
    units
        .iter()
        .map(|unit| format!("    <Unit name=\"{}\"/>\n", escaped(unit)))
        .collect()
}

/// The variables, one after the other.
fn listed(version: Version, variables: &[Variable]) -> String {
    let mut text = String::new();
    for (reference, variable) in variables.iter().enumerate() {
        let (kind, more) = match variable.kind {
            Kind::State(of) => (OUTPUT, of.map(|of| derivative(version, of))),
            Kind::Derivative(of) => (LOCAL, Some(derivative(version, of))),
            Kind::Local | Kind::Indicator => (LOCAL, None),
            Kind::Output => (OUTPUT, None),
            Kind::Parameter(value) => (PARAMETER, Some(format!(" start=\"{value:?}\""))),
            Kind::Input(value) => (INPUT, Some(format!(" start=\"{value:?}\""))),
            Kind::Time => (TIME, None),
        };
        let unit = match &*variable.unit {
            "" => String::new(),
            unit => format!(" unit=\"{}\"", escaped(unit)),
        };
        let own = unit + &more.unwrap_or_default();
        let name = escaped(&variable.name);
        let docs = match &*variable.docs {
            "" => String::new(),
            docs => format!("description=\"{}\" ", escaped(docs)),
        };
        let known = format!("name=\"{name}\" valueReference=\"{reference}\" {docs}{kind}");
        let _never_fails = match version {
            Version::Two => writeln!(
                text,
                "    <ScalarVariable {known}>\n      <Real{own}/>\n    </ScalarVariable>"
            ),
            Version::Three => writeln!(text, "    <Float64 {known}{own}/>"),
        };
    }
    text
}

const OUTPUT: &str = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
const LOCAL: &str = "causality=\"local\" variability=\"continuous\" initial=\"calculated\"";
const PARAMETER: &str = "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"";
const INPUT: &str = "causality=\"input\" variability=\"continuous\"";
const TIME: &str = "causality=\"independent\" variability=\"continuous\"";

/// That a variable is the derivative of another: FMI 2.0 counts from one.
fn derivative(version: Version, of: usize) -> String {
    let of = match version {
        Version::Two => of + 1,
        Version::Three => of,
    };
    format!(" derivative=\"{of}\"")
}

/// Which variables are outputs, derivatives, computed at the start, functions of events.
fn structure(version: Version, variables: &[Variable]) -> String {
    let is_output = |kind| matches!(kind, Kind::State(_) | Kind::Output);
    let is_derivative = |kind| matches!(kind, Kind::State(Some(_)) | Kind::Derivative(_));
    let is_unknown = |kind| is_output(kind) || is_derivative(kind);
    let is_indicator = |kind| matches!(kind, Kind::Indicator);
    let places = |wanted: &dyn Fn(Kind) -> bool| -> Vec<usize> {
        let numbered = variables.iter().enumerate();
        let wanted = numbered.filter(|(_, variable)| wanted(variable.kind));
        wanted.map(|(place, _)| place).collect()
    };
    match version {
        Version::Two => {
            indices("Outputs", &places(&is_output))
                + &indices("Derivatives", &places(&is_derivative))
                + &indices("InitialUnknowns", &places(&is_unknown))
        }
        Version::Three => {
            references("Output", &places(&is_output))
                + &references("ContinuousStateDerivative", &places(&is_derivative))
                + &references("InitialUnknown", &places(&is_unknown))
                + &references("EventIndicator", &places(&is_indicator))
        }
    }
}

/// A list of FMI 2.0, nothing if it is empty.
fn indices(element: &str, places: &[usize]) -> String {
    let unknown = |place: &usize| format!("      <Unknown index=\"{}\"/>\n", place + 1);
    let unknowns: String = places.iter().map(unknown).collect();
    match unknowns.is_empty() {
        true => String::new(),
        false => format!("    <{element}>\n{unknowns}    </{element}>\n"),
    }
}

/// Elements of FMI 3.0.
fn references(element: &str, places: &[usize]) -> String {
    let one = |place: &usize| format!("    <{element} valueReference=\"{place}\"/>\n");
    places.iter().map(one).collect()
}

/// A text as XML has it within quotes, where characters that it forbids are spaces.
fn escaped(text: &str) -> String {
    let allowed = |c| match c {
        '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => ' ',
        _ => c,
    };
    let text: String = text.chars().map(allowed).collect();
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
