//! Random expressions, and two readings of them: as an expression of the graph,
//! and as plain arithmetic that knows nothing of the graph.

use super::jet::Jet;
use bricard_codegen::internals::expr::{
    Comparison, ExprId, Function, Function2, Graph, Node, Number, Symbol,
};
use proptest::prelude::*;
use std::collections::BTreeMap;

/// The symbols that random expressions are made of.
pub const SYMBOLS: [Symbol; 6] = [
    Symbol::Coordinate(0),
    Symbol::Coordinate(1),
    Symbol::Velocity(0),
    Symbol::Velocity(1),
    Symbol::Parameter(0),
    Symbol::Time,
];

/// An expression that has not met the graph's rewriting yet.
#[derive(Clone, Debug)]
pub enum Recipe {
    Ratio(i32, i32),
    Symbol(usize),
    Sum(Vec<(Recipe, i32)>),
    Product(Vec<(Recipe, i32)>),
    Function(Function, Box<Recipe>),
    Function2(Function2, Box<[Recipe; 2]>),
    Select(Comparison, Box<[Recipe; 4]>),
}

impl Recipe {
    /// The expression, through the graph's constructors.
    pub fn build(&self, graph: &mut Graph) -> ExprId {
        match self {
            Recipe::Ratio(n, d) => {
                let number = Number::ratio(i128::from(*n), i128::from(*d));
                graph.number(number.expect("denominators are not zero"))
            }
            Recipe::Symbol(i) => graph.symbol(SYMBOLS[*i]),
            Recipe::Sum(terms) => {
                let terms: Vec<_> = terms
                    .iter()
                    .map(|(x, weight)| (x.build(graph), Number::integer(i64::from(*weight))))
                    .collect();
                graph.weighted_sum(Number::ZERO, &terms)
            }
            Recipe::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|(x, n)| (x.build(graph), *n)).collect();
                graph.power_product(&factors)
            }
            Recipe::Function(function, x) => {
                let x = x.build(graph);
                graph.function(*function, x)
            }
            Recipe::Function2(function, parts) => {
                let [x, y] = parts.each_ref().map(|part| part.build(graph));
                graph.function2(*function, x, y)
            }
            Recipe::Select(comparison, parts) => {
                let [a, b, then, otherwise] = parts.each_ref().map(|part| part.build(graph));
                graph.select(*comparison, a, b, then, otherwise)
            }
        }
    }

    /// Its value and its derivative by one symbol, operation by operation.
    pub fn jet(&self, values: &[f64; SYMBOLS.len()], by: usize) -> Jet {
        let of = |x: &Recipe| x.jet(values, by);
        match self {
            Recipe::Ratio(n, d) => Jet::ratio(*n, *d),
            Recipe::Symbol(i) => Jet::exact(values[*i], if *i == by { 1.0 } else { 0.0 }),
            Recipe::Sum(terms) => terms.iter().fold(Jet::ZERO, |sum, (x, weight)| {
                sum.add(of(x).mul(Jet::exact(f64::from(*weight), 0.0)))
            }),
            Recipe::Product(factors) => factors
                .iter()
                .fold(Jet::exact(1.0, 0.0), |product, (x, n)| {
                    product.mul(of(x).powi(*n))
                }),
            Recipe::Function(function, x) => of(x).function(*function),
            Recipe::Function2(function, parts) => {
                let [x, y] = parts.each_ref().map(of);
                x.function2(*function, y)
            }
            Recipe::Select(comparison, parts) => Jet::choose(*comparison, parts.each_ref().map(of)),
        }
    }
}

/// The value of an expression of the graph with a bound on its round-off.
pub fn evaluated(graph: &Graph, root: ExprId, values: &[f64; SYMBOLS.len()]) -> Jet {
    let mut known: BTreeMap<ExprId, Jet> = BTreeMap::new();
    let number = |n: &Number| Jet::exact(n.to_f64(), 0.0).mul(Jet::exact(1.0, 0.0));
    for e in graph.reachable(&[root]) {
        let of = |x: &ExprId| known[x];
        let value = match graph.node(e) {
            Node::Number(n) => number(n),
            Node::Pi => Jet::exact(std::f64::consts::PI, 0.0),
            Node::Symbol(symbol) => Jet::exact(value_of(*symbol, values), 0.0),
            Node::Sum(constant, terms) => {
                terms.iter().fold(number(constant), |sum, (x, weight)| {
                    sum.add(of(x).mul(number(weight)))
                })
            }
            Node::Product(factors) => factors
                .iter()
                .fold(Jet::exact(1.0, 0.0), |product, (x, n)| {
                    product.mul(of(x).powi(*n))
                }),
            Node::Function(function, x) => of(x).function(*function),
            Node::Function2(function, x, y) => of(x).function2(*function, of(y)),
            Node::Select(test, parts) => Jet::choose(test.comparison, parts.each_ref().map(of)),
        };
        known.insert(e, value);
    }
    known[&root]
}

/// Whether every number in an expression is finite. Division by the number zero is
/// refused in descriptions; the graph marks it by an infinite number.
pub fn is_finite(graph: &Graph, root: ExprId) -> bool {
    graph
        .reachable(&[root])
        .into_iter()
        .all(|e| match graph.node(e) {
            Node::Number(number) => number.is_finite(),
            Node::Sum(constant, terms) => {
                constant.is_finite() && terms.iter().all(|(_, weight)| weight.is_finite())
            }
            _ => true,
        })
}

/// The value of a symbol; NaN for one that random expressions do not have.
pub fn value_of(symbol: Symbol, values: &[f64; SYMBOLS.len()]) -> f64 {
    SYMBOLS
        .iter()
        .position(|s| *s == symbol)
        .map_or(f64::NAN, |i| values[i])
}

/// Values of the symbols.
pub fn values() -> impl Strategy<Value = [f64; SYMBOLS.len()]> {
    proptest::array::uniform6(-3.0..3.0_f64)
}

/// Random expressions of everything the graph has.
pub fn any() -> impl Strategy<Value = Recipe> {
    tree(|inner| {
        let comparison = proptest::sample::select(
            &[
                Comparison::Less,
                Comparison::LessEqual,
                Comparison::Equal,
                Comparison::NotEqual,
            ][..],
        );
        let choice = (
            comparison,
            [inner.clone(), inner.clone(), inner.clone(), inner.clone()],
        )
            .prop_map(|(comparison, parts)| Recipe::Select(comparison, Box::new(parts)));
        let function2 = proptest::sample::select(
            &[
                Function2::Atan2,
                Function2::Min,
                Function2::Max,
                Function2::Pow,
            ][..],
        );
        let call2 = (function2, [inner.clone(), inner.clone()])
            .prop_map(|(function, parts)| Recipe::Function2(function, Box::new(parts)));
        let all = Function::ALL.map(|(function, _)| function).to_vec();
        prop_oneof![3 => call(all, inner), 1 => call2, 1 => choice].boxed()
    })
}

/// Random polynomials in symbols, sines and cosines: what linkages are made of.
pub fn trigonometric() -> impl Strategy<Value = Recipe> {
    tree(|inner| call(vec![Function::Sin, Function::Cos], inner))
}

fn tree(calls: fn(BoxedStrategy<Recipe>) -> BoxedStrategy<Recipe>) -> BoxedStrategy<Recipe> {
    let leaf = prop_oneof![
        3 => (0..SYMBOLS.len()).prop_map(Recipe::Symbol),
        1 => (-9..=9, 1..=9).prop_map(|(n, d)| Recipe::Ratio(n, d)),
    ];
    leaf.prop_recursive(5, 40, 4, move |inner| {
        let inner = inner.boxed();
        let term = (inner.clone(), -3..=3);
        let factor = (inner.clone(), prop_oneof![4 => 1..=3, 1 => -2..=0]);
        prop_oneof![
            2 => proptest::collection::vec(term, 1..4).prop_map(Recipe::Sum),
            2 => proptest::collection::vec(factor, 1..4).prop_map(Recipe::Product),
            2 => calls(inner),
        ]
    })
    .boxed()
}

fn call(functions: Vec<Function>, inner: BoxedStrategy<Recipe>) -> BoxedStrategy<Recipe> {
    (proptest::sample::select(functions), inner)
        .prop_map(|(function, x)| Recipe::Function(function, Box::new(x)))
        .boxed()
}
