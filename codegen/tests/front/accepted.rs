//! Descriptions as a reader of the language's rules would write them, each about one
//! rule: `tests/accepted`. They pass without an error, and mean what is written beside.
//!
//! An output `a` has the value of the output `a_is`; `NAME.mech` has the equations of
//! motion of `NAME_by_hand.mech`.

use super::accept;
use bricard_codegen::internals::derive::derive;
use bricard_codegen::internals::expr::Symbol;
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::{CompileSettings, compile_source};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The least number of descriptions.
const FILES: usize = 15;

/// States at which values are compared.
const STATES: u32 = 5;

/// What two ways to write one thing may differ by, relative to the larger of it and one.
const ROUND_OFF: f64 = 1e-12;

const BY_HAND: &str = "_by_hand";

/// The descriptions by name.
fn descriptions() -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/accepted");
    let entries = fs::read_dir(folder).expect("the folder of accepted descriptions");
    let read = |entry: std::io::Result<fs::DirEntry>| {
        let path = entry.expect("an entry").path();
        let name = path
            .file_stem()
            .map(|name| name.to_string_lossy().into_owned());
        let text = fs::read_to_string(&path).expect("a description");
        (name.unwrap_or_default(), text)
    };
    entries.map(read).collect()
}

/// Values between 0.2 and 1.2, no two of them in a simple ratio.
fn value(symbol: Symbol, state: u32) -> f64 {
    let (kind, index) = match symbol {
        Symbol::Time => (1, 0),
        Symbol::Coordinate(i) => (2, i),
        Symbol::Velocity(i) => (3, i),
        Symbol::Parameter(i) => (4, i),
        Symbol::Input(i) => (5, i),
        other => unreachable!("no description has {other:?}"),
    };
    let seed = f64::from(kind) * 0.754_877_666 + f64::from(index) * 0.569_840_291;
    0.2 + (seed + f64::from(state) * 0.618_033_989).fract()
}

fn same(name: &str, what: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{name}: {what}");
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs() / expected.abs().max(1.0);
        assert!(
            error < ROUND_OFF,
            "{name}: {what} {k} is {found}, by hand {expected}"
        );
    }
}

/// Compares every output with the one beside it; how many there were.
fn compare_outputs(name: &str, m: &Mechanism) -> usize {
    let mut compared = 0;
    for output in &m.outputs {
        let column = &output.quantity.name;
        let (base, suffix) = column.split_at(column.find(['.', '[']).unwrap_or(column.len()));
        let beside = format!("{base}_is{suffix}");
        let Some(other) = m.outputs.iter().find(|o| o.quantity.name == beside) else {
            continue;
        };
        compared += 1;
        for state in 0..STATES {
            let at = |e| m.graph.evaluate(e, &|symbol| value(symbol, state));
            same(name, column, &[at(output.value)], &[at(other.value)]);
        }
    }
    compared
}

/// Every number of the equations of motion in a state, by what it is.
fn equations(mut m: Mechanism, state: u32) -> Vec<(&'static str, Vec<f64>)> {
    let e = derive(&mut m).expect("equations of a usual length");
    let outputs = m.outputs.iter().map(|output| output.value);
    let kinds = [
        ("M", e.inertial()),
        ("p1", e.force),
        ("g", e.residual),
        ("A", e.jacobian.concat()),
        ("b", e.drift),
        ("p2", e.bias),
        ("output", outputs.collect()),
        ("energy", vec![e.energies.kinetic, e.energies.potential]),
    ];
    let at = |roots: &[_]| m.graph.evaluate_all(roots, &|symbol| value(symbol, state));
    kinds.map(|(what, roots)| (what, at(&roots))).to_vec()
}

#[test]
fn what_a_reader_of_the_rules_would_write_is_accepted_and_means_what_stands_beside() {
    let all = descriptions();
    assert!(all.len() >= FILES, "{} descriptions", all.len());
    for (name, source) in &all {
        let m = accept(source);
        let compared = compare_outputs(name, &m);
        let alone = source.contains("_is =") == (compared > 0);
        assert!(alone, "{name}: an output has nothing beside it");
    }
}

#[test]
fn a_shorthand_gives_the_equations_that_are_written_by_hand() {
    let all = descriptions();
    let pairs = all.iter().filter_map(|(name, hand)| {
        let name = name.strip_suffix(BY_HAND)?;
        Some((name, &all[name], hand))
    });
    let pairs: Vec<_> = pairs.collect();
    assert!(pairs.len() >= 5, "{} pairs", pairs.len());
    for (name, short, hand) in pairs {
        for state in 0..STATES {
            let sides = equations(accept(short), state)
                .into_iter()
                .zip(equations(accept(hand), state));
            for ((what, found), (_, expected)) in sides {
                same(name, what, &found, &expected);
            }
        }
    }
}

#[test]
fn generated_functions_write_to_what_they_are_given_or_leave_it_unnamed() {
    for (name, source) in descriptions() {
        let compiled = compile_source(&source, &name, &name, &CompileSettings::default());
        let code = compiled.map(|compiled| compiled.code);
        let code = code.unwrap_or_else(|errors| panic!("{}", errors.render(&name, &source)));
        for function in code.split("fn ").skip(1) {
            let named = function.contains(" out: &mut");
            let written = function.contains("out.") || function.contains("out[");
            assert!(
                !named || written,
                "{name}: the compiler warns of\nfn {function}"
            );
        }
    }
}
