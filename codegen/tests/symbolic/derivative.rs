//! Derivatives against dual numbers.

use super::recipe::{self, SYMBOLS, evaluated, value_of};
use super::{agree, config};
use crate::dual;
use bricard_codegen::internals::expr::{Function, Function2, Graph, Symbol};
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

/// What a derivative may differ by from dual numbers where nothing cancels.
const RELATIVE: f64 = 1e-13;

/// Inside the domain of a function, away from where it loses digits.
fn domain(function: Function) -> (f64, f64) {
    match function {
        Function::Asin | Function::Acos => (-0.95, 0.95),
        Function::Ln | Function::Sqrt => (0.05, 20.0),
        Function::Tan => (-1.4, 1.4),
        _ => (-2.0, 2.0),
    }
}

fn close(found: f64, exact: f64) -> bool {
    (found - exact).abs() <= RELATIVE * exact.abs()
}

#[test]
fn every_function_has_the_derivative_and_value_of_dual_numbers() {
    for (function, name) in Function::ALL {
        let mut graph = Graph::new();
        let x = graph.symbol(Symbol::Time);
        let value = graph.function(function, x);
        let slope = graph.differentiate(value, Symbol::Time);
        let (low, high) = domain(function);
        for i in 0..1000 {
            let at = low + (high - low) * (f64::from(i) + 0.37) / 1000.0;
            let exact = dual::call(function, Dual64::from_re(at).derivative());
            let found = graph.evaluate_all(&[value, slope], &|_| at);
            assert!(
                close(found[0], exact.re),
                "{name}({at}): {} not {}",
                found[0],
                exact.re
            );
            assert!(
                close(found[1], exact.eps),
                "{name}'({at}): {} not {}",
                found[1],
                exact.eps
            );
        }
    }
}

#[test]
fn functions_of_two_arguments_have_the_partial_derivatives_of_dual_numbers() {
    let (first, second) = (Symbol::Coordinate(0), Symbol::Coordinate(1));
    type Oracle = fn(Dual64, Dual64) -> Dual64;
    let cases: [(Function2, Oracle); 4] = [
        (Function2::Atan2, |x, y| x.atan2(y)),
        (Function2::Min, |x, y| if x.re < y.re { x } else { y }),
        (Function2::Max, |x, y| if x.re < y.re { y } else { x }),
        (Function2::Pow, |x, y| (x.ln() * y).exp()),
    ];
    for (function, oracle) in cases {
        let mut graph = Graph::new();
        let (x, y) = (graph.symbol(first), graph.symbol(second));
        let value = graph.function2(function, x, y);
        let slopes = [first, second].map(|symbol| graph.differentiate(value, symbol));
        for i in 0..1000 {
            let (a, b) = (
                0.1 + f64::from(i % 37) / 11.0,
                0.1 + f64::from(i % 29) / 13.0,
            );
            if a == b {
                continue;
            }
            let found = graph.evaluate_all(&slopes, &|s| if s == first { a } else { b });
            let by_first = oracle(Dual64::new(a, 1.0), Dual64::new(b, 0.0)).eps;
            let by_second = oracle(Dual64::new(a, 0.0), Dual64::new(b, 1.0)).eps;
            assert!(
                close(found[0], by_first),
                "{function:?} at ({a}, {b}): {found:?}"
            );
            assert!(
                close(found[1], by_second),
                "{function:?} at ({a}, {b}): {found:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn random_expressions_have_the_derivatives_of_dual_numbers(
        recipe in recipe::any(),
        values in recipe::values(),
        by in 0..SYMBOLS.len(),
    ) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let slope = graph.differentiate(e, SYMBOLS[by]);
        let exact = recipe.jet(&values, by);
        let (value, slope) = (evaluated(&graph, e, &values), evaluated(&graph, slope, &values));
        if exact.is_sound() {
            agree(value.value, exact.value, value.value_error + exact.value_error)?;
            agree(slope.value, exact.slope, slope.value_error + exact.slope_error)?;
        }
    }

    #[test]
    fn one_sweep_back_gives_the_derivatives_by_all_coordinates_and_velocities(
        recipe in recipe::any(),
        values in recipe::values(),
    ) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let found = graph.gradient(e);
        for (by, symbol) in SYMBOLS.iter().enumerate() {
            let moves = matches!(symbol, Symbol::Coordinate(_) | Symbol::Velocity(_));
            let Some(&slope) = found.get(symbol) else {
                prop_assert!(!moves || !graph.depends_on(e, *symbol), "{symbol:?} is left out");
                continue;
            };
            let exact = recipe.jet(&values, by);
            let slope = evaluated(&graph, slope, &values);
            if exact.is_sound() {
                agree(slope.value, exact.slope, slope.value_error + exact.slope_error)?;
            }
        }
    }

    #[test]
    fn a_time_derivative_is_the_sum_of_the_partial_ones_times_their_rates(
        recipe in recipe::trigonometric(),
        values in recipe::values(),
    ) {
        let mut graph = Graph::new();
        let e = recipe.build(&mut graph);
        prop_assume!(recipe::is_finite(&graph, e));
        let rate = graph.time_derivative(e);
        let moves = |s: &Symbol| matches!(s, Symbol::Velocity(_));
        if graph.symbols(e).iter().any(moves) {
            prop_assert!(rate.is_err(), "a velocity has no rate without an acceleration");
            return Ok(());
        }
        let rate = rate.expect("nothing but time, coordinates and parameters");
        let mut exact = graph.integer(0);
        for (symbol, speed) in [
            (Symbol::Time, None),
            (Symbol::Coordinate(0), Some(Symbol::Velocity(0))),
            (Symbol::Coordinate(1), Some(Symbol::Velocity(1))),
        ] {
            let partial = graph.differentiate(e, symbol);
            let speed = speed.map_or(graph.integer(1), |speed| graph.symbol(speed));
            let term = graph.mul(partial, speed);
            exact = graph.add(exact, term);
        }
        let [rate, exact] = [rate, exact].map(|e| evaluated(&graph, e, &values));
        if exact.is_sound() {
            agree(rate.value, exact.value, rate.value_error + exact.value_error)?;
        }
    }
}

#[test]
fn evaluation_gives_each_symbol_its_own_value() {
    let mut graph = Graph::new();
    let mut values = [0.0; SYMBOLS.len()];
    for (i, value) in values.iter_mut().enumerate() {
        *value = f64::from(1 << i);
    }
    let symbols = SYMBOLS.map(|symbol| graph.symbol(symbol));
    let sum = graph.sum(symbols);
    assert_eq!(
        graph.evaluate(sum, &|symbol| value_of(symbol, &values)),
        63.0
    );
}
