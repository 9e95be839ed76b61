//! Expression graph to program.
//!
//! In:  expressions and the slots they are wanted in.
//! Out: a [`Program`] that computes each shared expression once, in the order of
//!      the graph. Weights become products, powers become multiplications,
//!      negative powers become one quotient. Entries that are exactly zero are
//!      left out: output arrays begin as zeros.

use super::program::{Operation, Program, Slot, Value};
use crate::expr::{ExprId, Number};
use crate::model::{Graph, Node, Symbol};
use rustc_hash::FxHashMap;

/// Schedules the wanted expressions; `laws` are the default laws of the inputs.
pub fn schedule(graph: &Graph, laws: &[ExprId], wanted: &[(Slot, ExprId)]) -> Program {
    let wanted: Vec<_> = wanted.iter().filter(|(_, e)| !graph.is_zero(*e)).collect();
    let mut roots: Vec<ExprId> = wanted.iter().map(|(_, e)| *e).collect();
    let inputs = |e: &ExprId| match graph.node(*e) {
        Node::Symbol(Symbol::Input(i)) => laws.get(*i as usize).copied(),
        _ => None,
    };
    let used: Vec<ExprId> = graph.reachable(&roots).iter().filter_map(inputs).collect();

    let mut scheduler = Scheduler {
        graph,
        laws,
        program: Program::default(),
        known: FxHashMap::default(),
    };
    // Laws come first: an input may have a smaller id than its law.
    scheduler.place_all(&used);
    roots.sort_unstable();
    scheduler.place_all(&roots);
    let Scheduler {
        mut program, known, ..
    } = scheduler;
    program.outputs = wanted
        .into_iter()
        .map(|(slot, e)| (*slot, known[e]))
        .collect();
    super::dead::without_dead(&program)
}

struct Scheduler<'a> {
    graph: &'a Graph,
    laws: &'a [ExprId],
    program: Program,
    known: FxHashMap<ExprId, Value>,
}

impl Scheduler<'_> {
    fn place_all(&mut self, roots: &[ExprId]) {
        for e in self.graph.reachable(roots) {
            if !self.known.contains_key(&e) {
                let value = self.place(e);
                self.known.insert(e, value);
            }
        }
    }

    fn place(&mut self, e: ExprId) -> Value {
        let operation = match self.graph.node(e) {
            Node::Number(value) => return self.number(*value),
            Node::Pi => Operation::Pi,
            Node::Symbol(Symbol::Input(i)) => Operation::Input(*i, self.law(*i)),
            Node::Symbol(symbol) => Operation::Symbol(*symbol),
            Node::Sum(constant, terms) => return self.sum(*constant, terms),
            Node::Product(factors) => return self.product(factors),
            Node::Function(function, x) => Operation::Function(*function, self.known[x]),
            Node::Function2(function, x, y) => {
                Operation::Function2(*function, self.known[x], self.known[y])
            }
            Node::Select(comparison, parts) => {
                Operation::Select(*comparison, parts.map(|x| self.known[&x]))
            }
        };
        self.program.push(operation)
    }

    fn law(&mut self, input: u32) -> Value {
        let law = self
            .laws
            .get(input as usize)
            .and_then(|law| self.known.get(law));
        match law {
            Some(&law) => law,
            None => self.number(Number::ZERO),
        }
    }

    /// A number; the sign stays outside of it.
    fn number(&mut self, value: Number) -> Value {
        if !value.is_negative() {
            return self.program.push(Operation::Number(value));
        }
        let size = self.program.push(Operation::Number(-value));
        self.program.push(Operation::Sum(vec![(true, size)]))
    }

    fn sum(&mut self, constant: Number, terms: &[(ExprId, Number)]) -> Value {
        let mut signed: Vec<(bool, Value)> = Vec::new();
        for (x, weight) in terms {
            let negative = weight.is_negative();
            let size = if negative { -*weight } else { *weight };
            signed.push((negative, self.weighted(*x, size)));
        }
        if !constant.is_zero() {
            let size = if constant.is_negative() {
                -constant
            } else {
                constant
            };
            signed.push((constant.is_negative(), self.number(size)));
        }
        // A leading minus costs an operation that any positive term in front saves.
        signed.sort_by_key(|(negative, _)| *negative);
        match signed[..] {
            [(false, only)] => only,
            _ => self.program.push(Operation::Sum(signed)),
        }
    }

    /// `weight · x`; the weight joins the factors of a product.
    fn weighted(&mut self, x: ExprId, weight: Number) -> Value {
        if weight.is_one() {
            return self.known[&x];
        }
        let weight = self.number(weight);
        let mut factors = vec![weight];
        match self.program.operation(self.known[&x]) {
            Operation::Product(inner) => factors.extend(inner),
            _ => factors.push(self.known[&x]),
        }
        self.program.push(Operation::Product(factors))
    }

    fn product(&mut self, powers: &[(ExprId, i32)]) -> Value {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (base, exponent) in powers {
            let side = if *exponent > 0 {
                &mut above
            } else {
                &mut below
            };
            side.extend(self.repeated(self.known[base], exponent.unsigned_abs()));
        }
        let numerator = self.multiplied(above);
        if below.is_empty() {
            return numerator;
        }
        let denominator = self.multiplied(below);
        self.program
            .push(Operation::Quotient(numerator, denominator))
    }

    /// The factors of `base ^ exponent`: up to three times the base, else by
    /// repeated squaring.
    fn repeated(&mut self, base: Value, exponent: u32) -> Vec<Value> {
        if exponent <= 3 {
            return vec![base; exponent as usize];
        }
        let square = self.program.push(Operation::Product(vec![base, base]));
        let mut factors = self.repeated(square, exponent / 2);
        if exponent % 2 == 1 {
            factors.push(base);
        }
        factors
    }

    fn multiplied(&mut self, factors: Vec<Value>) -> Value {
        match factors[..] {
            [] => self.number(Number::ONE),
            [only] => only,
            _ => self.program.push(Operation::Product(factors)),
        }
    }
}
