//! Canonical forms: what is equal is one expression.

use super::{config, recipe};
use bricard_codegen::internals::expr::{ExprId, Function, Graph, Number, Symbol};
use proptest::prelude::*;

fn three(graph: &mut Graph) -> [ExprId; 3] {
    [Symbol::Coordinate(0), Symbol::Coordinate(1), Symbol::Time].map(|s| graph.symbol(s))
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn an_expression_minus_itself_is_zero(recipe in recipe::any()) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let difference = graph.sub(e, e);
        prop_assert!(graph.is_zero(difference));
    }

    #[test]
    fn the_order_of_terms_and_factors_does_not_matter(
        a in recipe::any(),
        b in recipe::any(),
        c in recipe::any(),
    ) {
        let mut graph = Graph::new();
        let [a, b, c] = [a, b, c].map(|recipe| recipe.build(&mut graph));
        prop_assert_eq!(graph.sum([a, b, c]), graph.sum([c, a, b]));
        prop_assert_eq!(graph.product([a, b, c]), graph.product([c, a, b]));
    }

    #[test]
    fn building_the_same_again_adds_nothing(recipe in recipe::any()) {
        let mut graph = Graph::new();
        let first = recipe.build(&mut graph);
        let size = graph.len();
        prop_assert_eq!(recipe.build(&mut graph), first);
        prop_assert_eq!(graph.len(), size);
    }

    #[test]
    fn children_are_older_than_their_parents(recipe in recipe::any()) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        for parent in graph.reachable(&[e]) {
            prop_assert!(graph.node(parent).children().iter().all(|child| *child < parent));
        }
    }

    #[test]
    fn substituting_nothing_changes_nothing(recipe in recipe::any()) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assert_eq!(graph.substitute(e, &|_| None), e);
    }

    #[test]
    fn two_graphs_of_one_recipe_are_equal_node_by_node(recipe in recipe::any()) {
        let (mut left, mut right) = (Graph::new(), Graph::new());
        let (a, b) = (recipe.build(&mut left), recipe.build(&mut right));
        prop_assert_eq!(a, b);
        prop_assert_eq!(left.len(), right.len());
        for e in left.reachable(&[a]) {
            prop_assert_eq!(left.node(e), right.node(e));
        }
    }
}

#[test]
fn like_terms_are_collected() {
    let mut graph = Graph::new();
    let [x, y, _] = three(&mut graph);
    let two_x = graph.scale(x, Number::integer(2));
    let sum = graph.sum([x, y, two_x]);
    let three_x = graph.scale(x, Number::integer(3));
    assert_eq!(sum, graph.add(three_x, y));
}

#[test]
fn powers_of_equal_bases_are_collected() {
    let mut graph = Graph::new();
    let [x, y, _] = three(&mut graph);
    let product = graph.product([x, y, x]);
    let square = graph.powi(x, 2);
    assert_eq!(product, graph.mul(y, square));
    let back = graph.div(product, x);
    assert_eq!(back, graph.mul(x, y));
}

#[test]
fn a_number_is_moved_out_of_a_product() {
    let mut graph = Graph::new();
    let [x, y, _] = three(&mut graph);
    let two_x = graph.scale(x, Number::integer(2));
    let half_y = graph.scale(y, Number::ratio(1, 2).expect("a ratio"));
    assert_eq!(graph.mul(two_x, half_y), graph.mul(x, y));
}

#[test]
fn even_functions_forget_the_sign_of_their_argument_and_odd_ones_carry_it_out() {
    let mut graph = Graph::new();
    let [x, y, _] = three(&mut graph);
    let (difference, opposite) = (graph.sub(x, y), graph.sub(y, x));
    let cases = [(x, graph.neg(x)), (difference, opposite)];
    for (positive, negative) in cases {
        for function in [Function::Cos, Function::Cosh, Function::Abs] {
            assert_eq!(
                graph.function(function, positive),
                graph.function(function, negative)
            );
        }
        for function in [
            Function::Sin,
            Function::Tan,
            Function::Asin,
            Function::Atan,
            Function::Sinh,
            Function::Tanh,
            Function::Sign,
        ] {
            let minus = graph.function(function, negative);
            let plus = graph.function(function, positive);
            assert_eq!(graph.neg(minus), plus, "{function:?}");
        }
    }
}

#[test]
fn the_square_of_a_square_root_is_what_stands_under_it() {
    let mut graph = Graph::new();
    let [x, ..] = three(&mut graph);
    let root = graph.function(Function::Sqrt, x);
    assert_eq!(graph.mul(root, root), x);
    assert_eq!(graph.powi(root, 4), graph.powi(x, 2));
}

#[test]
fn half_powers_are_square_roots_and_whole_powers_are_products() {
    let mut graph = Graph::new();
    let [x, ..] = three(&mut graph);
    let root = graph.function(Function::Sqrt, x);
    let exponent = |n, d| Number::ratio(n, d).expect("a ratio");
    let half = graph.number(exponent(1, 2));
    assert_eq!(graph.pow(x, half), root);
    let three_halves = graph.number(exponent(3, 2));
    assert_eq!(graph.pow(x, three_halves), graph.mul(x, root));
    let minus_two = graph.integer(-2);
    assert_eq!(graph.pow(x, minus_two), graph.powi(x, -2));
}

#[test]
fn functions_of_numbers_are_folded_where_the_value_is_rational() {
    let mut graph = Graph::new();
    for (function, x, value) in [
        (Function::Sin, 0, 0),
        (Function::Cos, 0, 1),
        (Function::Exp, 0, 1),
        (Function::Ln, 1, 0),
        (Function::Sqrt, 49, 7),
        (Function::Abs, -3, 3),
        (Function::Sign, -3, -1),
        (Function::Sign, 0, 0),
        (Function::Acos, 1, 0),
    ] {
        let x = graph.integer(x);
        let folded = graph.function(function, x);
        assert_eq!(
            graph.as_number(folded),
            Some(Number::integer(value)),
            "{function:?}"
        );
    }
}
