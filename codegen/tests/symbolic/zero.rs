//! What is zero everywhere is told from what is small, or zero here and there.

use super::{config, recipe};
use bricard_codegen::internals::expr::{Comparison, ExprId, Function, Graph, Number, Symbol};
use proptest::prelude::*;

const X: Symbol = Symbol::Coordinate(0);
const Y: Symbol = Symbol::Parameter(0);

/// `(a + b)² − a² − 2ab − b²`.
fn binomial(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let sum = graph.add(a, b);
    let [whole, first, second] = [sum, a, b].map(|x| graph.powi(x, 2));
    let product = graph.mul(a, b);
    let (minus, twice) = (Number::MINUS_ONE, Number::integer(-2));
    let terms = [
        (whole, Number::ONE),
        (first, minus),
        (second, minus),
        (product, twice),
    ];
    graph.weighted_sum(Number::ZERO, &terms)
}

/// `cos²(x) + sin²(x)`.
fn one(graph: &mut Graph, x: ExprId) -> ExprId {
    let squares = [Function::Sin, Function::Cos].map(|function| {
        let value = graph.function(function, x);
        graph.powi(value, 2)
    });
    graph.sum(squares)
}

/// Whether it has a value where symbols are small, and where they are not.
fn is_defined(graph: &Graph, e: ExprId) -> bool {
    let values = [0.05, -0.1, 0.6, 0.9].map(|value| graph.evaluate(e, &|_| value));
    recipe::is_finite(graph, e) && values.iter().all(|value| value.is_finite())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn an_identity_is_zero_and_with_a_rest_it_is_not(
        a in recipe::trigonometric(),
        b in recipe::trigonometric(),
        digits in 1_u32..6,
    ) {
        let mut graph = Graph::new();
        let (a, b) = (a.build(&mut graph), b.build(&mut graph));
        let zero = binomial(&mut graph, a, b);
        prop_assume!(is_defined(&graph, zero));
        prop_assert!(graph.is_zero_everywhere(zero));
        let rest = Number::ratio(1, 10_i128.pow(digits)).expect("no division by zero");
        let square = graph.powi(a, 2);
        let rest = graph.weighted_sum(rest, &[(square, rest)]);
        let small = graph.add(zero, rest);
        prop_assert!(!graph.is_zero_everywhere(small));
    }
}

#[test]
fn small_coefficients_are_not_round_off() {
    let mut graph = Graph::new();
    let (x, tiny) = (graph.symbol(X), Number::ratio(1, 10_i128.pow(20)));
    let small = graph.scale(x, tiny.expect("no division by zero"));
    assert!(!graph.is_zero_everywhere(small));
    let zero = graph.integer(0);
    assert!(graph.is_zero_everywhere(zero));
}

#[test]
fn what_is_zero_in_parts_of_its_domain_is_not_zero() {
    let mut graph = Graph::new();
    let x = graph.symbol(X);
    let far = graph.integer(5);
    let zero = graph.integer(0);
    let piece = graph.select(Comparison::Less, x, far, zero, x);
    assert!(!graph.is_zero_everywhere(piece));
    let size = graph.function(Function::Abs, x);
    let square = graph.powi(x, 2);
    let root = graph.function(Function::Sqrt, square);
    let same = graph.sub(size, root);
    assert!(!graph.is_zero_everywhere(same));
}

#[test]
fn what_is_defined_in_half_of_its_domain_is_looked_at_there() {
    let mut graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let ratio = graph.div(x, y);
    let root = graph.function(Function::Sqrt, ratio);
    let square = graph.powi(root, 2);
    let difference = graph.sub(square, ratio);
    assert!(graph.is_zero_everywhere(difference));
    let one = one(&mut graph, ratio);
    let rest = graph.sub(one, root);
    assert!(!graph.is_zero_everywhere(rest));
}

#[test]
fn what_is_defined_nowhere_is_not_zero() {
    let mut graph = Graph::new();
    let x = graph.symbol(X);
    let square = graph.powi(x, 2);
    let negative = graph.weighted_sum(Number::MINUS_ONE, &[(square, Number::MINUS_ONE)]);
    let root = graph.function(Function::Sqrt, negative);
    let one = one(&mut graph, root);
    let two = one_again(&mut graph, root);
    let difference = graph.sub(one, two);
    assert!(!graph.is_zero_everywhere(difference));
}

/// `1 = cos²(2x) + sin²(2x)`, another expression.
fn one_again(graph: &mut Graph, x: ExprId) -> ExprId {
    let double = graph.scale(x, Number::integer(2));
    one(graph, double)
}
