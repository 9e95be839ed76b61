//! Printed expressions against what a description makes of them.

use super::recipe::{self, SYMBOLS, evaluated};
use super::{agree, config};
use bricard_codegen::CompileSettings;
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
        | Symbol::Tabulated(_)
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
const REFUSED: [&str; 5] = [
    "has no finite value",
    "not a finite number",
    "not a real number",
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
        let (mechanism, _) = match analyse(&source, &CompileSettings::default()) {
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

/// An expression that holds the one before it twice is twice as long, and soon longer than
/// any text could be.
#[test]
fn lengths_count_shared_parts_as_often_as_they_are_written() {
    let mut graph = Graph::new();
    let x = graph.symbol(Symbol::Coordinate(0));
    let one = graph.integer(1);
    let mut e = graph.add(x, one);
    let mut lengths = Vec::new();
    for level in 0..70 {
        lengths.push(graph.lengths(&[e])[0]);
        let p = graph.symbol(Symbol::Parameter(level));
        let (a, b) = (graph.add(e, p), graph.sub(e, p));
        e = graph.mul(a, b);
    }
    assert_eq!(graph.lengths(&[x, e]), [1, u64::MAX]);
    for pair in lengths.windows(2).take_while(|pair| pair[1] < u64::MAX) {
        assert!(pair[1] >= 2 * pair[0], "{pair:?}");
    }
}
