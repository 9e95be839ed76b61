//! Switching functions for what jumps or kinks along a motion.
//!
//! In:  expressions with comparisons, `abs`, `sign`, `min`, `max`.
//! Out: equal expressions, in which each of these depends on the sign of a switching function,
//!      and the list of those functions.
//!
//! A comparison `a < b` has the switching function `b − a`. Comparisons of the same
//! difference share one. What depends on parameters alone never changes along a motion
//! and stays as it is; so does what tells equal from unequal, which no step can find.

use crate::expr::{Comparison, Entry, ExprId, Function, Function2, Lookup, Number, Side, Test};
use crate::model::{Discontinuity, Graph, Node, Symbol};
use rustc_hash::FxHashMap;

/// A function whose sign decides something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// The function.
    pub function: ExprId,
    /// The expression that it was first met in.
    pub met_in: ExprId,
    /// What happens where the function is zero to what depends on its sign.
    pub discontinuity: Discontinuity,
}

/// Switching functions, each once.
#[derive(Clone, Debug, Default)]
pub struct Switches {
    /// The functions, in the order in which they were met.
    pub list: Vec<Switch>,
    known: FxHashMap<ExprId, ExprId>,
}

impl Switches {
    /// Adds a function that nothing depends on, unless it is there: steps end where it is zero.
    pub(super) fn add(&mut self, function: ExprId, met_in: ExprId) {
        if self.list.iter().all(|switch| switch.function != function) {
            self.list.push(Switch {
                function,
                met_in,
                discontinuity: Discontinuity::Knot,
            });
        }
    }
}

impl Graph {
    /// Makes what jumps or kinks in an expression depend on switching functions.
    pub fn hold(&mut self, root: ExprId, switches: &mut Switches) -> ExprId {
        for e in self.reachable(&[root]) {
            if !switches.known.contains_key(&e) {
                let held = self.hold_node(e, switches);
                switches.known.insert(e, held);
            }
        }
        switches.known[&root]
    }

    /// Makes what jumps or kinks in one node depend on switching functions, after its children.
    fn hold_node(&mut self, e: ExprId, switches: &mut Switches) -> ExprId {
        let of = |x: &ExprId| switches.known[x];
        let zero = self.integer(0);
        let node = self.node(e).clone();
        match &node {
            Node::Select(test, [a, b, then, otherwise]) if test.held.is_none() && !test.smooth => {
                let ordered = matches!(test.comparison, Comparison::Less | Comparison::LessEqual);
                let [a, b, then, otherwise] = [a, b, then, otherwise].map(of);
                let held = match ordered {
                    true => self.side(switches, (a, b), e, Discontinuity::Jump),
                    false => None,
                };
                self.select(Test { held, ..*test }, a, b, then, otherwise)
            }
            Node::Function(Function::Abs, x) => {
                let x = of(x);
                let opposite = self.neg(x);
                self.select_less(switches, (x, zero), e, [opposite, x])
            }
            Node::Function(Function::Sign, x) => {
                let x = of(x);
                let (one, minus) = (self.integer(1), self.integer(-1));
                let held = self.side(switches, (zero, x), e, Discontinuity::Jump);
                let [less, at_most] =
                    [Comparison::Less, Comparison::LessEqual].map(|comparison| Test {
                        held,
                        ..comparison.into()
                    });
                // Where no side is held, the sign of zero is zero.
                let rest = self.select(at_most, zero, x, zero, minus);
                self.select(less, zero, x, one, rest)
            }
            Node::Function(Function::Table(lookup), x) if lookup.jumps() => {
                let x = of(x);
                let held = self.interval(switches, *lookup, x, e);
                self.function(Function::Table(Lookup { held, ..*lookup }), x)
            }
            Node::Function2(Function2::Min, x, y) => {
                let (x, y) = (of(x), of(y));
                self.select_less(switches, (y, x), e, [y, x])
            }
            Node::Function2(Function2::Max, x, y) => {
                let (x, y) = (of(x), of(y));
                self.select_less(switches, (x, y), e, [y, x])
            }
            _ => {
                let known = &switches.known;
                self.rebuild(e, &|child| known[&child])
            }
        }
    }

    /// `if a < b then … else …`, where both branches are equal for equal `a` and `b`.
    fn select_less(
        &mut self,
        switches: &mut Switches,
        (a, b): (ExprId, ExprId),
        met_in: ExprId,
        [then, otherwise]: [ExprId; 2],
    ) -> ExprId {
        let held = self.side(switches, (a, b), met_in, Discontinuity::Kink);
        let test = Test {
            held,
            ..Comparison::Less.into()
        };
        self.select(test, a, b, then, otherwise)
    }

    /// The first of the switching functions that tell an interval of a table; none if the interval
    /// never changes.
    fn interval(
        &mut self,
        switches: &mut Switches,
        lookup: Lookup,
        x: ExprId,
        met_in: ExprId,
    ) -> Option<u32> {
        if self.is_fixed(x) {
            return None;
        }
        let bits = 0..lookup.table.bits();
        let functions: Vec<_> = bits
            .map(|bit| {
                let entry = Entry::Side(bit);
                self.function(Function::Table(Lookup { entry, ..lookup }), x)
            })
            .collect();
        let list = &mut switches.list;
        let known = list
            .iter()
            .position(|switch| switch.function == functions[0]);
        let first = known.unwrap_or_else(|| {
            let first = list.len();
            list.extend(functions.iter().map(|&function| Switch {
                function,
                met_in,
                discontinuity: Discontinuity::Kink,
            }));
            first
        });
        Some(u32::try_from(first).unwrap_or(u32::MAX))
    }

    /// Whether an expression is the same all along a motion.
    pub(super) fn is_fixed(&self, e: ExprId) -> bool {
        let fixed = |symbol: &Symbol| matches!(symbol, Symbol::Parameter(_));
        self.symbols(e).iter().all(fixed)
    }

    /// The side of a switching function on which `a < b`; none if it never changes.
    fn side(
        &mut self,
        switches: &mut Switches,
        (a, b): (ExprId, ExprId),
        met_in: ExprId,
        discontinuity: Discontinuity,
    ) -> Option<Side> {
        let difference =
            self.weighted_sum(Number::ZERO, &[(b, Number::ONE), (a, Number::MINUS_ONE)]);
        if self.is_fixed(difference) {
            return None;
        }
        let opposite = self.neg(difference);
        let is = |function| move |switch: &Switch| switch.function == function;
        let list = &mut switches.list;
        let (place, above) = match list.iter().position(is(difference)) {
            Some(place) => (place, true),
            None => match list.iter().position(is(opposite)) {
                Some(place) => (place, false),
                None => {
                    list.push(Switch {
                        function: difference,
                        met_in,
                        discontinuity: Discontinuity::Kink,
                    });
                    (list.len() - 1, true)
                }
            },
        };
        let worst = list[place].discontinuity.min(discontinuity);
        list[place].discontinuity = worst;
        let index = u32::try_from(place).unwrap_or(u32::MAX);
        Some(if above {
            Side::Above(index)
        } else {
            Side::Below(index)
        })
    }
}
