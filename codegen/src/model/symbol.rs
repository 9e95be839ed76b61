//! The symbols in the expressions of a mechanism, and derivatives along its motion.
//!
//! In:  expressions of [`crate::expr`].
//! Out: [`Symbol`], graphs over it, derivatives along the motion.

use crate::expr::{self, Direction, ExprId, Symbolic};
use std::collections::BTreeMap;

/// All expressions of one mechanism.
pub type Graph = expr::Graph<Symbol>;
/// One of them.
pub type Node = expr::Node<Symbol>;

/// What an expression of a mechanism may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Symbol {
    /// Time.
    Time,
    /// A coordinate, by index.
    Coordinate(u32),
    /// The velocity of a coordinate, by index.
    Velocity(u32),
    /// A run-time parameter, by index.
    Parameter(u32),
    /// An external signal, by index.
    Input(u32),
    /// The acceleration of a coordinate, by index: given, where equations of motion
    /// are linearised.
    Acceleration(u32),
    /// The multiplier of a constraint row, by index: given likewise.
    Multiplier(u32),
    /// The weight of a constraint row in the metric, by index: given, where the mass
    /// matrix alone is singular.
    Weight(u32),
    /// One while an external signal follows its law, zero while it is held, by the
    /// signal's index.
    Follows(u32),
    /// A number of a table that loops of generated code read, by index.
    Tabulated(u32),
}

impl Symbolic for Symbol {
    fn has_accent(self) -> bool {
        matches!(self, Symbol::Velocity(_))
    }
}

impl Symbol {
    /// Its place in the array of those of its kind, if there is one at run time.
    pub(crate) fn entry(self) -> Option<usize> {
        match self {
            Symbol::Coordinate(i)
            | Symbol::Velocity(i)
            | Symbol::Acceleration(i)
            | Symbol::Multiplier(i)
            | Symbol::Weight(i)
            | Symbol::Tabulated(i) => Some(i as usize),
            Symbol::Time | Symbol::Parameter(_) | Symbol::Input(_) | Symbol::Follows(_) => None,
        }
    }

    /// Whether it is in the state of a motion.
    pub(crate) fn is_of_state(self) -> bool {
        self == Symbol::Time || self.moves()
    }

    /// Whether it is a coordinate or a velocity.
    fn moves(self) -> bool {
        matches!(self, Symbol::Coordinate(_) | Symbol::Velocity(_))
    }
}

impl Graph {
    /// `∂e/∂symbol` for all coordinates and velocities in an expression.
    pub fn gradient(&mut self, e: ExprId) -> BTreeMap<Symbol, ExprId> {
        let one = self.integer(1);
        self.pulled_back(&[(e, one)])
    }

    /// `Σ r ∂e/∂symbol` over expressions `e` with rates `r`, for all coordinates and
    /// velocities in them: what forces on places come to.
    pub fn pulled_back(&mut self, rated: &[(ExprId, ExprId)]) -> BTreeMap<Symbol, ExprId> {
        self.adjoints(rated, &Symbol::moves)
    }

    /// The expression with every velocity set to zero.
    pub fn at_rest(&mut self, e: ExprId) -> ExprId {
        let zero = self.integer(0);
        self.substitute(e, &|symbol| {
            matches!(symbol, Symbol::Velocity(_)).then_some(zero)
        })
    }

    /// `∂e/∂t + Σ ∂e/∂q_i q̇_i`, or the symbol that has no rate: a velocity (its
    /// rate is an acceleration) or an input.
    pub fn time_derivative(&mut self, e: ExprId) -> Result<ExprId, Symbol> {
        let symbols = self.symbols(e);
        let rateless = |s: &&Symbol| matches!(s, Symbol::Velocity(_) | Symbol::Input(_));
        if let Some(&symbol) = symbols.iter().find(rateless) {
            return Err(symbol);
        }
        let mut direction = self.frozen_flow(symbols);
        Ok(self.derivative_along(e, &mut direction))
    }

    /// The direction of motion at frozen velocities: `ṫ = 1`, each coordinate
    /// among the symbols at its velocity, all else at rest.
    pub fn frozen_flow(&mut self, symbols: impl IntoIterator<Item = Symbol>) -> Direction<Symbol> {
        let mut seeds = Vec::new();
        for symbol in symbols {
            match symbol {
                Symbol::Time => seeds.push((symbol, self.integer(1))),
                Symbol::Coordinate(i) => seeds.push((symbol, self.symbol(Symbol::Velocity(i)))),
                _ => {}
            }
        }
        Direction::new(seeds)
    }
}
