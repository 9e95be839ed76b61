//! Where splines go on with another polynomial.
//!
//! In:  expressions.
//! Out: switching functions that are zero at these places. Nothing depends on their sides: a spline
//! and its first two derivatives are continuous, so it is enough that no step goes across the jump
//! of the third.
//!
//! Each spline gets one function, which is zero at all of its knots: the distance from the
//! nearest by the mean distance between knots, with signs in turn.

use super::hold::Switches;
use crate::expr::{Comparison, Entry, ExprId, Function, Lookup, Number};
use crate::model::{Graph, Node};
use rustc_hash::FxHashMap;

/// The knots of a spline, and what it is a function of.
#[derive(Clone, PartialEq)]
struct Chain {
    of: ExprId,
    knots: Vec<ExprId>,
}

impl Graph {
    /// Adds the knots of all splines in some expressions to the switching functions, as long
    /// as there is room for so many: without them a step across a knot is less accurate, and
    /// no more than that.
    pub(super) fn add_knots(&mut self, roots: &[ExprId], switches: &mut Switches, room: usize) {
        let mut chains: FxHashMap<ExprId, Chain> = FxHashMap::default();
        let mut splines: Vec<(ExprId, Chain)> = Vec::new();
        let mut functions: Vec<(ExprId, ExprId)> = Vec::new();
        for e in self.reachable(roots) {
            match *self.node(e) {
                Node::Function(Function::Table(lookup), x)
                    if lookup.is_differentiable() && !self.is_fixed(x) =>
                {
                    let entry = Entry::Knot;
                    let distance = self.function(Function::Table(Lookup { entry, ..lookup }), x);
                    let places = &lookup.table.places;
                    let ends = [places[0], places[places.len() - 1]];
                    let ends = ends.map(|place| self.number(Number::float(place)));
                    functions.push((self.in_spacings(distance, ends, places.len()), x));
                }
                Node::Select(test, [x, knot, _, rest]) if test.smooth && !self.is_fixed(x) => {
                    // Those that come later contain those before.
                    let inner = chains.get(&rest).filter(|inner| inner.of == x);
                    let inner = inner.map_or(&[][..], |inner| &inner.knots);
                    let knots = [&[knot], inner].concat();
                    splines.retain(|(part, chain)| *part != rest || chain.of != x);
                    let chain = Chain { of: x, knots };
                    splines.push((e, chain.clone()));
                    chains.insert(e, chain);
                }
                _ => {}
            }
        }
        for (_, Chain { of, knots }) in splines {
            let distance = self.zigzag(of, &knots);
            let ends = [knots[0], knots[knots.len() - 1]];
            functions.push((self.in_spacings(distance, ends, knots.len()), of));
        }
        for (function, of) in functions {
            if switches.list.len() < room {
                switches.add(function, of);
            }
        }
    }

    /// A distance, divided by the mean distance of neighbours among so many places, of which the
    /// first and the last are given.
    fn in_spacings(
        &mut self,
        distance: ExprId,
        [first, last]: [ExprId; 2],
        count: usize,
    ) -> ExprId {
        let length = self.sub(last, first);
        let gaps = self.integer((count - 1) as i64);
        let spacing = self.div(length, gaps);
        self.div(distance, spacing)
    }

    /// The distance from the nearest of some places in rising order, above the first one
    /// positive, above the second one negative, and so on.
    fn zigzag(&mut self, x: ExprId, places: &[ExprId]) -> ExprId {
        let mut result = self.integer(0);
        for (i, &place) in places.iter().enumerate().rev() {
            let (one, other) = match i % 2 {
                0 => (Number::ONE, Number::MINUS_ONE),
                _ => (Number::MINUS_ONE, Number::ONE),
            };
            let distance = self.weighted_sum(Number::ZERO, &[(x, one), (place, other)]);
            result = match places.get(i + 1) {
                None => distance,
                Some(&next) => {
                    let half = Number::float(0.5);
                    let middle = self.weighted_sum(Number::ZERO, &[(place, half), (next, half)]);
                    self.select(Comparison::Less, x, middle, distance, result)
                }
            };
        }
        result
    }
}
