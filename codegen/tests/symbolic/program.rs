//! Programs against the expressions they came from.

use super::recipe::{self, Recipe, SYMBOLS, evaluated, value_of};
use super::{agree, config};
use bricard_codegen::internals::expr::{ExprId, Function, Graph, Number, Symbol};
use bricard_codegen::internals::optimise::{
    Operation, Program, Slot, cost, interpret, optimise, plain, verify,
};
use proptest::prelude::*;

fn slots(expressions: &[ExprId]) -> Vec<(Slot, ExprId)> {
    let slot = |(row, e): (usize, &ExprId)| {
        (
            Slot {
                array: "out",
                row,
                column: 0,
            },
            *e,
        )
    };
    expressions.iter().enumerate().map(slot).collect()
}

fn built(recipes: &[Recipe], graph: &mut Graph) -> Vec<(Slot, ExprId)> {
    let expressions: Vec<ExprId> = recipes.iter().map(|recipe| recipe.build(graph)).collect();
    slots(&expressions)
}

/// Several expressions that share parts with each other, as rows of matrices do.
fn several() -> impl Strategy<Value = Vec<Recipe>> {
    let shared = proptest::collection::vec(recipe::any(), 1..4);
    shared.prop_flat_map(|parts| {
        let pick = proptest::collection::vec((0..parts.len(), -3..=3), 1..4);
        let row = (pick, any::<bool>()).prop_map(move |(picks, is_sum)| {
            let parts = picks.iter().map(|&(i, n)| (parts[i].clone(), n)).collect();
            if is_sum {
                Recipe::Sum(parts)
            } else {
                Recipe::Product(parts)
            }
        });
        proptest::collection::vec(row, 1..5)
    })
}

fn run(program: &Program, values: &[f64; SYMBOLS.len()]) -> Vec<(Slot, f64)> {
    interpret(program, &|symbol| {
        Some(value_of(symbol, values)).filter(|x| !x.is_nan())
    })
}

/// Each output has the value of its expression; one left out is a zero.
fn check(
    program: &Program,
    graph: &Graph,
    wanted: &[(Slot, ExprId)],
    values: &[f64; SYMBOLS.len()],
) -> Result<(), TestCaseError> {
    let outputs = run(program, values);
    for (slot, e) in wanted {
        let exact = evaluated(graph, *e, values);
        let found = outputs
            .iter()
            .find(|(written, _)| written == slot)
            .map_or(0.0, |(_, x)| *x);
        if exact.is_sound() && found.is_finite() {
            agree(found, exact.value, exact.value_error)?;
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_scheduled_program_computes_its_expressions(
        recipes in several(),
        values in recipe::values(),
    ) {
        let mut graph = Graph::new();
        let wanted = built(&recipes, &mut graph);
        prop_assume!(wanted.iter().all(|(_, e)| recipe::is_finite(&graph, *e)));
        let program = plain(&graph, &wanted);
        prop_assert_eq!(verify(&program), Ok(()));
        check(&program, &graph, &wanted, &values)?;
    }

    #[test]
    fn an_optimised_program_computes_its_expressions_and_costs_no_more(
        recipes in several(),
        values in recipe::values(),
    ) {
        let mut graph = Graph::new();
        let wanted = built(&recipes, &mut graph);
        prop_assume!(wanted.iter().all(|(_, e)| recipe::is_finite(&graph, *e)));
        let before = plain(&graph, &wanted);
        let after = optimise(&mut graph, &[], &wanted);
        prop_assert_eq!(verify(&after), Ok(()));
        prop_assert!(cost(&after).weight() <= cost(&before).weight());
        let sound = wanted.iter().all(|(_, e)| evaluated(&graph, *e, &values).is_sound());
        if sound {
            check(&after, &graph, &wanted, &values)?;
        }
    }

    #[test]
    fn equal_expressions_give_equal_programs(recipes in several()) {
        let program = || {
            let mut graph = Graph::new();
            let wanted = built(&recipes, &mut graph);
            let finite = wanted.iter().all(|(_, e)| recipe::is_finite(&graph, *e));
            finite.then(|| optimise(&mut graph, &[], &wanted))
        };
        let (Some(first), Some(second)) = (program(), program()) else { return Ok(()) };
        prop_assert!(first.operations().eq(second.operations()));
        prop_assert_eq!(first.outputs, second.outputs);
    }
}

#[test]
fn an_input_follows_its_law_until_it_is_held() {
    let mut graph = Graph::new();
    let input = graph.symbol(Symbol::Input(0));
    let time = graph.symbol(Symbol::Time);
    let law = graph.powi(time, 2);
    let wanted = slots(&[graph.add(input, time)]);
    let program = optimise(&mut graph, &[law], &wanted);
    let value = |held: Option<f64>| {
        interpret(&program, &|symbol| match symbol {
            Symbol::Input(_) => held,
            _ => Some(3.0),
        })[0]
            .1
    };
    assert_eq!(value(None), 12.0);
    assert_eq!(value(Some(5.0)), 8.0);
}

#[test]
fn entries_that_are_zero_are_not_computed() {
    let mut graph = Graph::new();
    let (zero, time) = (graph.integer(0), graph.symbol(Symbol::Time));
    let program = optimise(&mut graph, &[], &slots(&[zero, time]));
    assert_eq!(program.outputs.len(), 1);
    assert_eq!(program.outputs[0].0.row, 1);
}

#[test]
fn a_shared_expression_is_computed_once() {
    let mut graph = Graph::new();
    let [x, y] = [Symbol::Coordinate(0), Symbol::Coordinate(1)].map(|s| graph.symbol(s));
    let sum = graph.add(x, y);
    let (square, cube) = (graph.powi(sum, 2), graph.powi(sum, 3));
    let program = optimise(&mut graph, &[], &slots(&[square, cube]));
    assert_eq!(cost(&program).sums, 1);
    assert_eq!(cost(&program).products, 2);
}

/// How often a program changes a sign and does nothing else.
fn sign_changes(program: &Program) -> usize {
    let changes = |operation: &Operation| match operation {
        Operation::Sum(terms) => terms.len() == 1,
        _ => false,
    };
    let operations = program.operations();
    operations
        .filter(|(_, operation)| changes(operation))
        .count()
}

#[test]
fn a_number_takes_the_sign_of_its_product_where_that_is_free() {
    let mut graph = Graph::new();
    let [x, y, z] = [
        Symbol::Coordinate(0),
        Symbol::Coordinate(1),
        Symbol::Velocity(0),
    ]
    .map(|s| graph.symbol(s));
    let half = graph.number(Number::Exact(1, 2));
    let product = graph.mul(half, x);
    let negative = graph.neg(product);
    let times = graph.mul(product, y);
    let sum = graph.add(times, z);
    let alone = optimise(&mut graph, &[], &slots(&[negative, sum]));
    assert_eq!(sign_changes(&alone), 0, "{alone}");
    // It is written with both signs.
    let both = optimise(&mut graph, &[], &slots(&[negative, product, sum]));
    assert_eq!(sign_changes(&both), 1, "{both}");
    // A function of it would have to change it back.
    let power = graph.function(Function::Exp, product);
    let inside = optimise(&mut graph, &[], &slots(&[negative, power]));
    assert_eq!(sign_changes(&inside), 1, "{inside}");
}

/// A row of bodies: the first half of the outputs asks for each body and the next one,
/// the second half again in the same order.
#[test]
fn outputs_that_read_the_same_coordinates_follow_one_another() {
    const BODIES: u32 = 6;
    let mut graph = Graph::new();
    let mut pair = |i: u32, symbol: fn(u32) -> Symbol| {
        let (a, b) = (graph.symbol(symbol(i)), graph.symbol(symbol(i + 1)));
        graph.mul(a, b)
    };
    let first = (0..BODIES).map(|i| pair(i, Symbol::Coordinate));
    let mut wanted: Vec<ExprId> = first.collect();
    wanted.extend((0..BODIES).map(|i| pair(i, Symbol::Velocity)));
    let program = optimise(&mut graph, &[], &slots(&wanted));
    let rows: Vec<usize> = program.outputs.iter().map(|(slot, _)| slot.row).collect();
    let bodies: Vec<usize> = rows.iter().map(|row| row % BODIES as usize).collect();
    let forth = bodies.is_sorted();
    let back = bodies.iter().rev().is_sorted();
    assert!(forth || back, "{rows:?}");
}
