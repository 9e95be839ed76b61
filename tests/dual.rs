//! Expressions evaluated on dual numbers: derivatives that share nothing with the
//! symbolic rules.

use bricard_codegen::internals::expr::{
    Comparison, ExprId, Function, Function2, Graph, Node, Number, Symbol,
};
use num_dual::DualNum;
use std::collections::BTreeMap;

/// A dual number over `f64`.
pub trait Dual: DualNum<Primitive = f64> + Copy {}
impl<D: DualNum<Primitive = f64> + Copy> Dual for D {}

/// The value of an expression, with as many derivatives as the numbers carry.
pub fn evaluate<D: Dual>(graph: &Graph, root: ExprId, values: &dyn Fn(Symbol) -> D) -> D {
    let mut known: BTreeMap<ExprId, D> = BTreeMap::new();
    let number = |number: &Number| D::from(number.to_f64());
    for e in graph.reachable(&[root]) {
        let of = |x: &ExprId| known[x];
        let value = match graph.node(e) {
            Node::Number(value) => number(value),
            Node::Pi => D::from(std::f64::consts::PI),
            Node::Symbol(symbol) => values(*symbol),
            Node::Sum(constant, terms) => {
                terms.iter().fold(number(constant), |sum, (x, weight)| {
                    sum + of(x) * number(weight)
                })
            }
            Node::Product(factors) => factors
                .iter()
                .fold(D::one(), |product, (x, n)| product * of(x).powi(*n)),
            Node::Function(function, x) => call(*function, of(x)),
            Node::Function2(function, x, y) => call2(*function, of(x), of(y)),
            Node::Select(comparison, [a, b, then, otherwise]) => {
                let (a, b) = (of(a), of(b));
                let holds = match comparison.comparison {
                    Comparison::Less => a < b,
                    Comparison::LessEqual => a <= b,
                    Comparison::Equal => a == b,
                    Comparison::NotEqual => a != b,
                };
                of(if holds { then } else { otherwise })
            }
        };
        known.insert(e, value);
    }
    known[&root]
}

/// A function of the language, with as many derivatives as the number carries; at a kink those
/// of one side.
pub fn call<D: Dual>(function: Function, x: D) -> D {
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sqrt => x.sqrt(),
        Function::Abs => x.abs(),
        Function::Sign => x.signum(),
        Function::Table(_) => unreachable!("no long table is among these"),
    }
}

fn call2<D: Dual>(function: Function2, x: D, y: D) -> D {
    match function {
        Function2::Atan2 => x.atan2(y),
        Function2::Min => {
            if y < x {
                y
            } else {
                x
            }
        }
        Function2::Max => {
            if x < y {
                y
            } else {
                x
            }
        }
        Function2::Pow => (x.ln() * y).exp(),
    }
}
