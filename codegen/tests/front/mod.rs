//! The front end: from text to a checked mechanism, and the messages on the way.

mod accepted;
mod build;
mod documentation;
mod eliminated;
mod files;
mod forms;
mod functions;
mod grammar;
mod legality;
mod library;
mod lints;
mod lists;
mod mechanisms;
mod messages;
mod model;
mod names;
mod pages;
mod parts;
mod robustness;
mod rotation;
mod scale;
mod shapes;
mod starts;
mod statements;
mod surface;
mod units;
mod unread;
mod wrong;

use bricard_codegen::internals::analyse;
use bricard_codegen::internals::expr::Symbol;
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::{CompileSettings, Diagnostics};

/// A mechanism of two coordinates `q` and `w` without units, and more statements.
fn with(statements: &str) -> String {
    format!("mechanism Test {{ coord q; coord w; kinetic der(q)^2 + der(w)^2; {statements} }}")
}

/// What a build script sets: numbers for constants, and parameters that it freezes.
fn settings(constants: &[(&str, f64)], frozen: &[&str]) -> CompileSettings {
    let constants = constants
        .iter()
        .map(|(name, value)| (name.to_string(), *value));
    let mut settings = CompileSettings::default();
    settings.constants = constants.collect();
    settings.frozen = frozen.iter().map(ToString::to_string).collect();
    settings
}

/// The mechanism of a description that is right.
fn accept(source: &str) -> Mechanism {
    match analyse(source, &CompileSettings::default()) {
        Ok((mechanism, _)) => mechanism,
        Err(errors) => panic!("{}", errors.render("test.mech", source)),
    }
}

/// The findings about a description that is wrong.
fn refuse(source: &str) -> Diagnostics {
    match analyse(source, &CompileSettings::default()) {
        Ok(_) => panic!("this was accepted: {source}"),
        Err(errors) => errors,
    }
}

/// Refuses a description with a message that contains some words.
fn refuse_saying(source: &str, words: &str) {
    let message = refuse(source).render("test.mech", source);
    assert!(message.contains(words), "no `{words}` in\n{message}");
}

/// Refuses each of some statements with a message that contains some words: in each line of a
/// table the statements, `⇒`, the words.
fn refuse_each(with: fn(&str) -> String, table: &str) {
    for line in table.trim().lines() {
        let (statements, words) = line.split_once(" ⇒ ").expect("a line has both");
        refuse_saying(&with(statements.trim()), words);
    }
}

/// The warnings about a description that is right, rendered.
fn warnings(source: &str) -> String {
    match analyse(source, &CompileSettings::default()) {
        Ok((_, warnings)) => warnings.render("test.mech", source),
        Err(errors) => panic!("{}", errors.render("test.mech", source)),
    }
}

/// A state in which no two symbols have simple values.
fn state(symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Time => 0.37,
        Symbol::Coordinate(i) => 0.51 + 0.29 * f64::from(i),
        Symbol::Velocity(i) => -0.83 + 0.47 * f64::from(i),
        Symbol::Parameter(i) => 1.31 + 0.61 * f64::from(i),
        Symbol::Input(i) => 2.17 - 0.31 * f64::from(i),
        Symbol::Acceleration(_)
        | Symbol::Multiplier(_)
        | Symbol::Weight(_)
        | Symbol::Tabulated(_)
        | Symbol::Follows(_) => {
            unreachable!("no description has {symbol:?}")
        }
    }
}

/// The value of an output in that state.
fn output(mechanism: &Mechanism, name: &str) -> f64 {
    let found = mechanism
        .outputs
        .iter()
        .find(|output| output.quantity.name == name);
    let found = found.unwrap_or_else(|| panic!("no output `{name}`"));
    mechanism.graph.evaluate(found.value, &state)
}

/// The value of a formula of `q`, `w` and their velocities in that state.
fn value(formula: &str) -> f64 {
    output(&accept(&with(&format!("output y = {formula};"))), "y")
}

/// Two values are equal up to round-off.
fn assert_close(found: f64, expected: f64) {
    /// A few hundred roundings.
    const ROUND_OFF: f64 = 1e-13;
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(error < ROUND_OFF, "{found} instead of {expected}");
}
