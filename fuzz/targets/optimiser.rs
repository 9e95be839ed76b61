//! Any expressions: their optimised program is sound, costs no more and computes the
//! same values.

#![no_main]
#![allow(dead_code)]

#[path = "../../tests/dual.rs"]
mod dual;
#[path = "../../codegen/tests/symbolic/jet.rs"]
mod jet;
#[path = "../../codegen/tests/symbolic/recipe.rs"]
mod recipe;

use bricard_codegen::internals::expr::{Comparison, ExprId, Function, Function2, Graph, Node};
use bricard_codegen::internals::optimise::{
    Slot, cost, in_trig_ring, interpret, optimise, plain, verify,
};
use libfuzzer_sys::fuzz_target;
use recipe::{Recipe, SYMBOLS, evaluated, is_finite, value_of};

/// Nodes of an expression that is read from bytes.
const LARGEST: usize = 60;

/// What value and exact value may differ by, in units of the bound on round-off.
const ROUND_OFF: f64 = 64.0;

/// Powers of powers beyond this overflow the arithmetic that programs are compared with.
const STEEPEST: i32 = 64;

/// Whether all powers in an expression are moderate.
fn is_moderate(graph: &Graph, root: ExprId) -> bool {
    graph
        .reachable(&[root])
        .into_iter()
        .all(|e| match graph.node(e) {
            Node::Product(factors) => factors
                .iter()
                .all(|(_, n)| n.unsigned_abs() <= STEEPEST.unsigned_abs()),
            _ => true,
        })
}

/// Bytes, read as choices; zeros when there are no more.
struct Choices<'a> {
    bytes: std::slice::Iter<'a, u8>,
    left: usize,
}

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        self.bytes.next().copied().unwrap_or(0)
    }

    fn below(&mut self, bound: usize) -> usize {
        usize::from(self.byte()) % bound
    }

    fn weight(&mut self) -> i32 {
        i32::from(self.byte() % 7) - 3
    }

    fn recipe(&mut self) -> Recipe {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            return Recipe::Symbol(0);
        }
        match self.byte() % 8 {
            0 | 1 => Recipe::Symbol(self.below(SYMBOLS.len())),
            2 => {
                let numerator = i32::from(self.byte()) - 128;
                Recipe::Ratio(numerator, 1 + i32::from(self.byte() % 9))
            }
            3 => Recipe::Sum(self.several()),
            4 => Recipe::Product(self.several()),
            5 => {
                let function = Function::ALL[self.below(Function::ALL.len())].0;
                Recipe::Function(function, Box::new(self.recipe()))
            }
            6 => {
                let all = [
                    Function2::Atan2,
                    Function2::Min,
                    Function2::Max,
                    Function2::Pow,
                ];
                let function = all[self.below(all.len())];
                Recipe::Function2(function, Box::new([self.recipe(), self.recipe()]))
            }
            _ => {
                let all = [
                    Comparison::Less,
                    Comparison::LessEqual,
                    Comparison::Equal,
                    Comparison::NotEqual,
                ];
                let comparison = all[self.below(all.len())];
                let parts = std::array::from_fn(|_| self.recipe());
                Recipe::Select(comparison, Box::new(parts))
            }
        }
    }

    fn several(&mut self) -> Vec<(Recipe, i32)> {
        (0..1 + self.below(3))
            .map(|_| (self.recipe(), self.weight()))
            .collect()
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut choices = Choices {
        bytes: bytes.iter(),
        left: LARGEST,
    };
    let values: [f64; SYMBOLS.len()] =
        std::array::from_fn(|_| (f64::from(choices.byte()) - 128.0) / 40.0);
    let mut graph = Graph::new();
    let count = 1 + choices.below(3);
    let recipes: Vec<Recipe> = (0..count).map(|_| choices.recipe()).collect();
    let roots: Vec<ExprId> = recipes.iter().map(|r| r.build(&mut graph)).collect();
    let is_fit = |e: &ExprId| is_finite(&graph, *e) && is_moderate(&graph, *e);
    if !roots.iter().all(is_fit) {
        return;
    }
    let slot = |row| Slot {
        array: "out",
        row,
        column: 0,
    };
    let wanted: Vec<_> = roots
        .iter()
        .enumerate()
        .map(|(row, e)| (slot(row), *e))
        .collect();
    let before = plain(&graph, &wanted);
    let after = optimise(&mut graph, &[], &wanted);
    assert_eq!(verify(&after), Ok(()));
    assert!(
        cost(&after).weight() <= cost(&before).weight(),
        "costs more than before"
    );
    // Multiplied out, an expression has the round-off of the terms it is then made of.
    let mut round_off = |e: ExprId| {
        let multiplied_out = in_trig_ring(&mut graph, e);
        [e, multiplied_out].map(|e| evaluated(&graph, e, &values))
    };
    let expected: Vec<_> = wanted.iter().map(|(_, e)| round_off(*e)).collect();
    let value = |symbol| Some(value_of(symbol, &values)).filter(|x| !x.is_nan());
    for (program, name) in [(&before, "plain"), (&after, "optimised")] {
        let outputs = interpret(program, &value);
        for ((slot, _), [exact, multiplied_out]) in wanted.iter().zip(&expected) {
            let found = outputs
                .iter()
                .find(|(place, _)| place == slot)
                .map_or(0.0, |(_, x)| *x);
            if exact.is_sound() && multiplied_out.is_sound() && found.is_finite() {
                let round_off = exact.value_error + multiplied_out.value_error;
                let bound = ROUND_OFF * round_off + f64::MIN_POSITIVE;
                let off = (found - exact.value).abs();
                assert!(
                    off <= bound,
                    "{name}: {found:e} is not {:e} ± {bound:e} at {values:?} of {recipes:?}",
                    exact.value
                );
            }
        }
    }
});
