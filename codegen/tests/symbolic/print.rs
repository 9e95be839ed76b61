//! Printed expressions against what a description makes of them.

use super::recipe::{self, SYMBOLS, evaluated};
use super::{agree, config};
use bricard_codegen::Settings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::expr::{Graph, Symbol};
use proptest::prelude::*;

/// The names of the symbols in the description around a printed expression.
fn name(symbol: Symbol) -> String {
    match symbol {
        Symbol::Time => "t".into(),
        Symbol::Coordinate(i) => format!("x{i}"),
        Symbol::Velocity(i) => format!("der(x{i})"),
        Symbol::Parameter(i) => format!("p{i}"),
        Symbol::Input(i) => format!("u{i}"),
        Symbol::Acceleration(_)
        | Symbol::Multiplier(_)
        | Symbol::Weight(_)
        | Symbol::Follows(_) => {
            unreachable!("no description has {symbol:?}")
        }
    }
}

fn description(text: &str) -> String {
    format!(
        "mechanism Printed {{
            param p0 = 1;
            coord x0;
            coord x1;
            kinetic 1/2*der(x0)^2 + 1/2*p0*der(x1)^2;
            output y = {text};
        }}"
    )
}

/// What is refused in numbers: random expressions contain it now and then.
const REFUSED: [&str; 4] = [
    "has no finite value",
    "not a finite number",
    "a negative power of zero",
    "division by zero",
];

proptest! {
    #![proptest_config(config())]

    #[test]
    fn printed_expressions_read_back_with_their_value(
        recipe in recipe::any(),
        values in recipe::values(),
    ) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let source = description(&graph.text(e, &name));
        let (mechanism, _) = match analyse(&source, &Settings::default()) {
            Ok(analysed) => analysed,
            Err(errors) => {
                let rendered = errors.render("printed.mech", &source);
                // What has no value anywhere is rightly refused.
                prop_assume!(!REFUSED.iter().any(|refused| rendered.contains(refused)));
                return Err(TestCaseError::fail(rendered));
            }
        };
        let read = evaluated(&mechanism.graph, mechanism.outputs[0].value, &values);
        let exact = evaluated(&graph, e, &values);
        if exact.is_sound() {
            agree(read.value, exact.value, read.value_error + exact.value_error)?;
        }
    }
}

#[test]
fn every_symbol_has_a_name_of_its_own() {
    let names = SYMBOLS.map(name);
    for (i, name) in names.iter().enumerate() {
        assert!(!names[..i].contains(name), "{name}");
    }
}
