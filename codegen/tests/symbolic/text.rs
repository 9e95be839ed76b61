//! What each pass makes of small expressions, as text.

use bricard_codegen::internals::expr::{Comparison, ExprId, Function, Graph, Number, Symbol};
use bricard_codegen::internals::optimise::{Pass, Program, Slot, alone, optimise};

/// `x`, `y`, `z`.
fn letters(graph: &mut Graph) -> [ExprId; 3] {
    [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)))
}

fn named(symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => ["x", "y", "z"][i as usize].to_string(),
        Symbol::Input(_) => "u".to_string(),
        Symbol::Time => "t".to_string(),
        other => format!("{other:?}"),
    }
}

fn wanted(expressions: &[ExprId]) -> Vec<(Slot, ExprId)> {
    let places = expressions.iter().enumerate();
    places
        .map(|(row, e)| (Slot::of_vector("out", row), *e))
        .collect()
}

/// The lines of a program.
fn lines(program: &Program) -> Vec<String> {
    program.text(&named).lines().map(str::to_string).collect()
}

/// What a pass alone makes of expressions.
#[track_caller]
fn check(pass: Pass, make: impl Fn(&mut Graph) -> Vec<ExprId>, expected: &[&str]) {
    let mut graph = Graph::new();
    let expressions = make(&mut graph);
    let program = alone(pass, &mut graph, &[], &wanted(&expressions));
    assert_eq!(lines(&program), expected, "{}", pass.name());
}

#[test]
fn the_ring_replaces_a_squared_sine() {
    let make = |graph: &mut Graph| {
        let [x, y, _] = letters(graph);
        let (sin, cos) = (
            graph.function(Function::Sin, x),
            graph.function(Function::Cos, x),
        );
        let squares = [sin, cos].map(|e| graph.powi(e, 2));
        let one = graph.add(squares[0], squares[1]);
        vec![graph.mul(one, y)]
    };
    check(Pass::Ring, make, &["out[1] = y"]);
}

#[test]
fn a_schedule_computes_shared_expressions_once_and_divides_once() {
    let make = |graph: &mut Graph| {
        let [x, y, z] = letters(graph);
        let sin = graph.function(Function::Sin, x);
        let below = [y, z].map(|e| graph.powi(e, -1));
        let quotient = graph.mul(below[0], below[1]);
        vec![graph.mul(sin, quotient), graph.sub(sin, y)]
    };
    let expected = [
        "%1 = sin(x)",
        "%2 = y*z",
        "%3 = %1/%2",
        "%4 = %1 - y",
        "out[1] = %3",
        "out[2] = %4",
    ];
    check(Pass::Schedule, make, &expected);
}

#[test]
fn entries_that_are_zero_are_not_computed() {
    let make = |graph: &mut Graph| {
        let [x, ..] = letters(graph);
        let nothing = graph.sub(x, x);
        vec![nothing, x]
    };
    check(Pass::Schedule, make, &["out[2] = x"]);
}

#[test]
fn common_factors_are_collected() {
    let make = |graph: &mut Graph| {
        let [x, y, z] = letters(graph);
        let terms = [graph.mul(x, y), graph.mul(x, z)];
        vec![graph.add(terms[0], terms[1])]
    };
    let expected = ["%1 = y + z", "%2 = x*%1", "out[1] = %2"];
    check(Pass::Collect, make, &expected);
}

#[test]
fn pairs_of_factors_are_shared_between_products() {
    let make = |graph: &mut Graph| {
        let [x, y, z] = letters(graph);
        let pair = graph.mul(x, y);
        let sin = graph.function(Function::Sin, z);
        vec![graph.mul(pair, z), graph.mul(pair, sin)]
    };
    let expected = [
        "%1 = x*y",
        "%2 = z*%1",
        "%3 = sin(z)",
        "%4 = %1*%3",
        "out[1] = %2",
        "out[2] = %4",
    ];
    check(Pass::Share, make, &expected);
}

#[test]
fn factors_are_put_into_sums_where_their_products_are_known() {
    let make = |graph: &mut Graph| {
        let [x, y, z] = letters(graph);
        let [sin_y, sin_z] = [y, z].map(|angle| graph.function(Function::Sin, angle));
        let [first, second] = [graph.mul(y, sin_y), graph.mul(z, sin_z)];
        let sum = graph.add(first, second);
        vec![graph.mul(x, y), graph.mul(x, z), graph.mul(x, sum)]
    };
    let expected = [
        "%1 = x*y",
        "%2 = x*z",
        "%3 = sin(y)",
        "%4 = %1*%3",
        "%5 = sin(z)",
        "%6 = %2*%5",
        "%7 = %4 + %6",
        "out[1] = %1",
        "out[2] = %2",
        "out[3] = %7",
    ];
    check(Pass::Distribute, make, &expected);
    // A product that is read elsewhere is computed all the same.
    let read = |graph: &mut Graph| {
        let mut wanted = make(graph);
        let [_, y, _] = letters(graph);
        let sin_y = graph.function(Function::Sin, y);
        wanted.push(graph.mul(y, sin_y));
        wanted
    };
    let expected = [
        "%1 = x*y",
        "%2 = x*z",
        "%3 = sin(y)",
        "%4 = y*%3",
        "%5 = sin(z)",
        "%6 = z*%5",
        "%7 = %4 + %6",
        "%8 = x*%7",
        "out[1] = %1",
        "out[2] = %2",
        "out[3] = %8",
        "out[4] = %4",
    ];
    check(Pass::Distribute, read, &expected);
}

#[test]
fn a_text_tells_numbers_choices_and_inputs() {
    let mut graph = Graph::new();
    let [x, y, _] = letters(&mut graph);
    let input = graph.symbol(Symbol::Input(0));
    let time = graph.symbol(Symbol::Time);
    let law = graph.powi(time, 2);
    let half = graph.number(Number::ratio(1, 2).expect("two is not zero"));
    let scaled = graph.mul(half, x);
    let choice = graph.select(Comparison::Less, x, y, scaled, input);
    let program = optimise(&mut graph, &[law], &wanted(&[choice]));
    let expected = [
        "%1 = x*(1/2)",
        "%2 = t*t",
        "%3 = u, else %2",
        "%4 = if x < y then %1 else %3",
        "out[1] = %4",
    ];
    assert_eq!(lines(&program), expected);
}

#[test]
fn a_text_of_a_matrix_tells_rows_and_columns() {
    let mut graph = Graph::new();
    let [x, y, _] = letters(&mut graph);
    let slot = |row, column| Slot {
        array: "mass",
        row,
        column,
    };
    let wanted = [(slot(0, 0), x), (slot(1, 1), y)];
    let program = optimise(&mut graph, &[], &wanted);
    assert_eq!(lines(&program), ["mass[1,1] = x", "mass[2,2] = y"]);
    assert_eq!(
        program.to_string(),
        "mass[1,1] = Coordinate(0)\nmass[2,2] = Coordinate(1)\n"
    );
}
