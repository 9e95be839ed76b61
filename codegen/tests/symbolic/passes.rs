//! Each pass by itself, on every mechanism of the library; and what `RULES.md` says
//! of the passes.

use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{Equations, Matrix, derive};
use bricard_codegen::internals::expr::{ExprId, Graph, Symbol};
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::optimise::{
    Pass, Program, Slot, alone, interpret, optimise, verify,
};
use std::fs;
use std::path::{Path, PathBuf};

/// How many states each pass is run in.
const STATES: u32 = 4;

/// What round-off may do to an entry, against the largest of its array: a thousand
/// roundings of terms that cancel to a thousandth. An identity that is wrong is wrong
/// by the size of a term.
const ROUND_OFF: f64 = 1e-10;

/// A state in which nothing is small and no two symbols are alike.
fn state(number: u32) -> impl Fn(Symbol) -> f64 {
    let turn = f64::from(number) * 0.77;
    move |symbol| match symbol {
        Symbol::Time => 0.4 + turn,
        Symbol::Coordinate(i) => 0.6 + turn + 0.31 * f64::from(i),
        Symbol::Velocity(i) => 1.3 - turn - 0.23 * f64::from(i),
        Symbol::Parameter(i) => 1.1 + 0.17 * f64::from(i),
        Symbol::Input(i) => 0.9 + 0.13 * f64::from(i),
        Symbol::Acceleration(_)
        | Symbol::Multiplier(_)
        | Symbol::Weight(_)
        | Symbol::Tabulated(_)
        | Symbol::Follows(_) => 1.0,
    }
}

fn matrix(array: &'static str, rows: &Matrix) -> Vec<(Slot, ExprId)> {
    let mut entries = Vec::new();
    for (row, columns) in rows.iter().enumerate() {
        for (column, &e) in columns.iter().enumerate() {
            entries.push((Slot { array, row, column }, e));
        }
    }
    entries
}

fn vector(array: &'static str, entries: &[ExprId]) -> Vec<(Slot, ExprId)> {
    let columns: Matrix = entries.iter().map(|&e| vec![e]).collect();
    matrix(array, &columns)
}

/// Everything that the functions of a mechanism compute.
fn wanted(equations: &Equations) -> Vec<(Slot, ExprId)> {
    let mut wanted = matrix("mass", equations.mass.as_ref().expect("a short mechanism"));
    wanted.extend(vector("force", &equations.force));
    wanted.extend(vector("residual", &equations.residual));
    wanted.extend(vector("speed", &equations.speed));
    wanted.extend(matrix("jacobian", &equations.jacobian));
    wanted.extend(vector("bias", &equations.bias));
    wanted
}

/// The largest size of an entry in the same array.
fn scale(array: &str, values: &[(Slot, f64)]) -> f64 {
    let same = values.iter().filter(|(slot, _)| slot.array == array);
    same.map(|(_, value)| value.abs()).fold(1.0, f64::max)
}

fn check(what: &str, graph: &Graph, wanted: &[(Slot, ExprId)], program: &Program) {
    assert_eq!(verify(program), Ok(()), "{what}");
    for number in 0..STATES {
        let at = state(number);
        let exact: Vec<(Slot, f64)> = wanted
            .iter()
            .map(|(slot, e)| (*slot, graph.evaluate(*e, &at)))
            .collect();
        let found = interpret(program, &|symbol| Some(at(symbol)));
        for (slot, exact_value) in &exact {
            let computed = found.iter().find(|(written, _)| written == slot);
            let value = computed.map_or(0.0, |(_, value)| *value);
            let bound = ROUND_OFF * scale(slot.array, &exact);
            assert!(
                (value - exact_value).abs() <= bound || !exact_value.is_finite(),
                "{what}, state {number}, {slot:?}: {value} instead of {exact_value}"
            );
        }
    }
}

/// The descriptions of the library.
fn library() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mechanisms");
    let entries = fs::read_dir(folder).expect("the library of mechanisms");
    let paths = entries.flatten().map(|entry| entry.path());
    paths
        .filter(|path| path.extension().is_some_and(|e| e == "mech"))
        .collect()
}

/// Every mechanism of the library, derived.
fn derived() -> impl Iterator<Item = (String, Mechanism, Equations)> {
    library().into_iter().map(|path| {
        let name = path.display().to_string();
        let source = fs::read_to_string(&path).expect("a description");
        match analyse(&source, &CompileSettings::default()) {
            Ok((mut mechanism, _)) => {
                let equations = derive(&mut mechanism).expect("equations of a usual length");
                (name, mechanism, equations)
            }
            Err(errors) => panic!("{}", errors.render(&name, &source)),
        }
    })
}

#[test]
fn every_pass_alone_keeps_the_value_of_every_entry_of_the_library() {
    for (name, mut mechanism, equations) in derived() {
        let laws: Vec<ExprId> = mechanism.inputs.iter().map(|input| input.law).collect();
        let wanted = wanted(&equations);
        for pass in Pass::ALL {
            let program = alone(pass, &mut mechanism.graph, &laws, &wanted);
            check(
                &format!("{name}, {}", pass.name()),
                &mechanism.graph,
                &wanted,
                &program,
            );
        }
    }
}

#[test]
fn all_passes_together_keep_the_value_of_every_entry_of_the_library() {
    for (name, mut mechanism, equations) in derived() {
        let laws: Vec<ExprId> = mechanism.inputs.iter().map(|input| input.law).collect();
        let wanted = wanted(&equations);
        let program = optimise(&mut mechanism.graph, &laws, &wanted);
        check(&name, &mechanism.graph, &wanted, &program);
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src/optimise")
}

fn rules() -> String {
    fs::read_to_string(folder().join("RULES.md")).expect("the list of rules")
}

#[test]
fn every_pass_has_a_section_of_rules() {
    let rules = rules();
    for pass in Pass::ALL {
        let heading = format!("\n## {}\n", pass.name());
        assert!(rules.contains(&heading), "no section `{}`", pass.name());
    }
}

#[test]
fn every_rule_names_a_function_that_exists() {
    let mut count = 0;
    for line in rules().lines().filter(|line| line.contains(".rs::")) {
        let Some(place) = line.rsplit('`').find(|part| part.contains(".rs::")) else {
            continue;
        };
        let (file, function) = place.split_once("::").expect("a file and a function");
        let text = fs::read_to_string(folder().join(file)).expect(file);
        let found = ["fn ", "pub enum "].iter().any(|word| {
            [" ", "(", "<"]
                .iter()
                .any(|end| text.contains(&format!("{word}{function}{end}")))
        });
        assert!(found, "there is no `{function}` in {file}: {line}");
        count += 1;
    }
    assert!(count > 30, "only {count} rules");
}

#[test]
fn every_function_that_rewrites_is_named_by_a_rule() {
    let rules = rules();
    let rewriting = [
        (
            "ring/mod.rs",
            ["add_reduced", "times", "times_power", "expand_node"].as_slice(),
        ),
        (
            "schedule.rs",
            ["sum", "weighted", "product", "repeated"].as_slice(),
        ),
        ("collect.rs", ["collect_factors"].as_slice()),
        ("share.rs", ["share_pairs"].as_slice()),
        ("dead.rs", ["without_dead"].as_slice()),
        ("signs.rs", ["into_numbers", "turn"].as_slice()),
        ("solve/algebra.rs", ["product", "sum", "inverse"].as_slice()),
        ("solve/saddle.rs", ["inverse_entries"].as_slice()),
    ];
    for (file, functions) in rewriting {
        for function in functions {
            let place = format!("`{file}::{function}`");
            assert!(rules.contains(&place), "no rule at {place}");
        }
    }
}
