//! The ring of sines and cosines: reduction keeps the value and brings no angle.

use super::recipe::{self, evaluated};
use super::{agree, config};
use bricard_codegen::internals::expr::{ExprId, Function, Graph, Node, Number, Symbol};
use bricard_codegen::internals::optimise::{Slot, in_trig_ring, optimise, verify};
use proptest::prelude::*;

/// The arguments of all sines and cosines.
fn angles(graph: &Graph, e: ExprId) -> Vec<ExprId> {
    let angle = |e: ExprId| match graph.node(e) {
        Node::Function(Function::Sin | Function::Cos, angle) => Some(*angle),
        _ => None,
    };
    graph
        .reachable(&[e])
        .into_iter()
        .filter_map(angle)
        .collect()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn reduction_keeps_the_value(recipe in recipe::any(), values in recipe::values()) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let reduced = in_trig_ring(&mut graph, e);
        let exact = recipe.jet(&values, 0);
        let [reduced, plain] = [reduced, e].map(|e| evaluated(&graph, e, &values));
        if exact.is_sound() && reduced.is_sound() {
            let round_off = reduced.value_error + plain.value_error;
            agree(reduced.value, plain.value, round_off)?;
        }
    }

    #[test]
    fn reduction_brings_no_new_angle(
        recipe in recipe::trigonometric(),
        values in recipe::values(),
    ) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let reduced = in_trig_ring(&mut graph, e);
        let had = angles(&graph, e);
        for angle in angles(&graph, reduced) {
            let angle = evaluated(&graph, angle, &values);
            let known = had.iter().any(|&other| {
                let other = evaluated(&graph, other, &values);
                let slack = 16.0 * (angle.value_error + other.value_error) + f64::MIN_POSITIVE;
                !angle.is_sound() || (angle.value.abs() - other.value.abs()).abs() <= slack
            });
            prop_assert!(known, "the angle of value {} is new", angle.value);
        }
    }

    #[test]
    fn reduction_has_nothing_left_to_do_the_second_time(recipe in recipe::trigonometric()) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let once = in_trig_ring(&mut graph, e);
        prop_assert_eq!(in_trig_ring(&mut graph, once), once);
    }
}

/// Polynomials in sines and cosines of two angles, with negative powers, of small coefficients:
/// what rotations about oblique axes are made of.
fn quotients() -> impl Strategy<Value = Vec<([i32; 4], i32)>> {
    let power = prop_oneof![3 => Just(0), 2 => Just(2), 2 => Just(-2), 1 => -3..=3];
    let powers = [power.clone(), power.clone(), power.clone(), power];
    proptest::collection::vec((powers, -2..=2), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..config() })]

    #[test]
    fn quotients_of_squares_keep_their_values(terms in quotients(), values in recipe::values()) {
        let mut graph = Graph::new();
        let angles = [Symbol::Coordinate(0), Symbol::Coordinate(1)].map(|s| graph.symbol(s));
        let mut factors = Vec::new();
        for angle in angles {
            factors.extend([Function::Sin, Function::Cos].map(|f| graph.function(f, angle)));
        }
        let mut parts = Vec::new();
        for (powers, coefficient) in &terms {
            let powers = factors.iter().zip(powers).filter(|(_, n)| **n != 0);
            let powers: Vec<(ExprId, i32)> = powers.map(|(factor, n)| (*factor, *n)).collect();
            parts.push((graph.power_product(&powers), Number::integer(i64::from(*coefficient))));
        }
        let e = graph.weighted_sum(Number::ZERO, &parts);
        let reduced = in_trig_ring(&mut graph, e);
        let [reduced, plain] = [reduced, e].map(|e| evaluated(&graph, e, &values));
        if reduced.is_sound() && plain.is_sound() {
            agree(reduced.value, plain.value, reduced.value_error + plain.value_error)?;
        }
    }
}

/// `sin²x/sin²y + cos²y cos²x/sin²y + cos²x = 1/sin²y`.
#[test]
fn what_a_quotient_leaves_is_added_to_what_is_there() {
    let mut graph = Graph::new();
    let [y, x] = [Symbol::Coordinate(0), Symbol::Coordinate(1)].map(|s| graph.symbol(s));
    let [sy, sx] = [y, x].map(|angle| graph.function(Function::Sin, angle));
    let [cy, cx] = [y, x].map(|angle| graph.function(Function::Cos, angle));
    let [first, second, third] = [
        graph.power_product(&[(sx, 2), (sy, -2)]),
        graph.power_product(&[(cx, 2), (cy, 2), (sy, -2)]),
        graph.powi(cx, 2),
    ];
    let sum = graph.sum([first, second, third]);
    let reduced = in_trig_ring(&mut graph, sum);
    let (x, y) = (0.3_f64, 0.7_f64);
    let value = graph.evaluate(reduced, &|symbol| match symbol {
        Symbol::Coordinate(0) => y,
        _ => x,
    });
    assert!((value - y.sin().powi(-2)).abs() < 1e-14, "{value}");
}

#[test]
fn the_squares_of_sine_and_cosine_add_up_to_one() {
    let mut graph = Graph::new();
    let [x, y] = [Symbol::Coordinate(0), Symbol::Coordinate(1)].map(|s| graph.symbol(s));
    let angle = graph.sub(x, y);
    let (sin, cos) = (
        graph.function(Function::Sin, angle),
        graph.function(Function::Cos, angle),
    );
    let squares = [graph.powi(sin, 2), graph.powi(cos, 2)];
    let sum = graph.sum(squares);
    let reduced = in_trig_ring(&mut graph, sum);
    assert_eq!(graph.as_number(reduced), Some(Number::ONE));
}

#[test]
fn the_squared_length_of_a_turned_vector_is_that_of_the_vector() {
    let mut graph = Graph::new();
    let [angle, a, b] = [Symbol::Time, Symbol::Parameter(0), Symbol::Parameter(1)]
        .map(|symbol| graph.symbol(symbol));
    let (sin, cos) = (
        graph.function(Function::Sin, angle),
        graph.function(Function::Cos, angle),
    );
    let [ac, bs, sa, bc] = [[a, cos], [b, sin], [sin, a], [b, cos]].map(|p| graph.product(p));
    let (x, y) = (graph.sub(ac, bs), graph.add(sa, bc));
    let squares = [graph.powi(x, 2), graph.powi(y, 2)];
    let turned = graph.sum(squares);
    let squares = [graph.powi(a, 2), graph.powi(b, 2)];
    let still = graph.sum(squares);
    assert_eq!(in_trig_ring(&mut graph, turned), still);
}

/// `sin³ x` as `sin x − sin x cos² x` would lose all of its digits near zero.
#[test]
fn powers_of_a_sine_are_not_written_as_differences() {
    let mut graph = Graph::new();
    let [x, y, a] = [
        Symbol::Coordinate(0),
        Symbol::Coordinate(1),
        Symbol::Parameter(0),
    ]
    .map(|symbol| graph.symbol(symbol));
    let [sin, other] = [x, y].map(|angle| graph.function(Function::Sin, angle));
    for powers in [
        vec![(sin, 2)],
        vec![(sin, 3)],
        vec![(sin, 4)],
        vec![(a, 1), (sin, 5)],
        vec![(sin, 2), (other, 2)],
        vec![(a, -1), (sin, 3), (other, 4)],
    ] {
        let product = graph.power_product(&powers);
        let minus = graph.neg(product);
        assert_eq!(in_trig_ring(&mut graph, product), product, "{powers:?}");
        assert_eq!(in_trig_ring(&mut graph, minus), minus, "{powers:?}");
    }
}

/// What would be infinite is left for the run to find, with the time and the state.
#[test]
fn the_inverse_of_what_turns_out_to_be_zero_stays_as_it_was_written() {
    let mut graph = Graph::new();
    let x = graph.symbol(Symbol::Coordinate(0));
    let (sin, cos) = (
        graph.function(Function::Sin, x),
        graph.function(Function::Cos, x),
    );
    let squares = [graph.powi(sin, 2), graph.powi(cos, 2)];
    let sum = graph.sum(squares);
    let one = graph.number(Number::ONE);
    let zero = graph.sub(sum, one);
    let inverse = graph.powi(zero, -3);
    assert_eq!(in_trig_ring(&mut graph, inverse), inverse);
    let place = Slot {
        array: "out",
        row: 0,
        column: 0,
    };
    let program = optimise(&mut graph, &[], &[(place, inverse)]);
    assert_eq!(verify(&program), Ok(()));
}

#[test]
fn a_coefficient_that_overflows_leaves_an_expression_as_it_was() {
    let mut graph = Graph::new();
    let [x, y] = [Symbol::Coordinate(0), Symbol::Coordinate(1)].map(|s| graph.symbol(s));
    let large = Number::float(1e300);
    let sum = graph.weighted_sum(Number::ZERO, &[(x, large), (y, Number::ONE)]);
    let square = graph.powi(sum, 2);
    assert_eq!(in_trig_ring(&mut graph, square), square);
}
