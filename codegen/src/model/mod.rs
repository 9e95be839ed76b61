//! A checked mechanism: what the description says, in expressions.
//!
//! In:  the syntax tree, from [`crate::syntax`].
//! Out: [`Mechanism`]: names resolved, arrays and loops unrolled, `der` carried
//!      out, vectors split into scalar rows, everything legal.
//!
//! Not here: mechanics. Mass matrix and constraint Jacobian are `derive`'s.

mod analysis;
mod arithmetic;
mod bare;
mod call;
mod check;
mod choice;
mod constant;
mod data;
mod declare;
mod declared;
mod element;
mod evaluate;
mod function;
mod language;
mod linear;
mod lower;
mod lowering;
mod member;
mod messages;
mod order;
mod part;
mod picture;
mod rotation;
mod scope;
mod shape;
mod start;
mod state;
mod statement;
mod symbol;
mod table;
mod unit;
mod unit_names;
mod unread;
mod validity;
mod value;

pub use evaluate::EXPRESSIONS_MAX;
pub(crate) use language::other_functions;
pub use lower::lower;
pub(crate) use scope::built_in;
pub use symbol::{Graph, Node, Symbol};
pub(crate) use unit_names::{scaled_units, units};

use crate::diagnostic::Span;
use crate::expr::{ExprId, Table};

/// A mechanism whose every part has been checked.
#[derive(Clone, Debug, Default)]
pub struct Mechanism {
    /// The name after `mechanism`.
    pub name: String,
    /// Its doc comment.
    pub docs: String,
    /// The graph that all expressions below live in.
    pub graph: Graph,
    /// Generalized coordinates, arrays unrolled; their index is the one of
    /// `Symbol::Coordinate` and `Symbol::Velocity`.
    pub coordinates: Vec<Quantity>,
    /// How many of them, the last ones, are integrals of states of the first order: the
    /// velocity of such a coordinate is the state, its mass one, and the force at it the
    /// rate of the state. No formula contains the coordinate itself, and no energy the
    /// state.
    pub states: usize,
    /// Run-time parameters, in order of declaration.
    pub parameters: Vec<Parameter>,
    /// Constants that were folded, for the documentation of the emitted code.
    pub constants: Vec<Constant>,
    /// External signals.
    pub inputs: Vec<Input>,
    /// Summands of the kinetic energy.
    pub kinetic: Vec<Summand>,
    /// Summands of the potential energy.
    pub potential: Vec<Summand>,
    /// Summands of the Rayleigh dissipation function.
    pub dissipation: Vec<Summand>,
    /// Applied forces.
    pub forces: Vec<Force>,
    /// Constraint equations, one for each scalar row.
    pub constraints: Vec<Constraint>,
    /// Entries of the `start` block.
    pub starts: Vec<Start>,
    /// Equations of the `start` block that are no values of coordinates and velocities.
    pub start_equations: Vec<Constraint>,
    /// Equations of the `start` block that are guesses, and no values of coordinates and
    /// velocities.
    pub start_guesses: Vec<Constraint>,
    /// Observables, vectors unrolled (`p.x`, `p.y`).
    pub outputs: Vec<Output>,
    /// Event functions.
    pub events: Vec<Event>,
    /// The picture.
    pub shapes: Vec<Shape>,
    /// The coordinates that were declared, where some of them were eliminated; empty
    /// where all are among `coordinates`.
    pub described: Vec<Described>,
    /// Files that the description reads.
    pub files: Vec<std::path::PathBuf>,
    /// Tables that code holds as data.
    pub tables: Vec<&'static Table>,
    /// What decides the forces along a motion by its sign; found when the equations of
    /// motion are derived.
    pub switches: Vec<Switch>,
}

/// A switching function and how it changes along a motion.
#[derive(Clone, Debug)]
pub struct Switch {
    /// The function.
    pub value: ExprId,
    /// Its rate, of the accelerations.
    pub rate: ExprId,
    /// What it decides, as the description writes it.
    pub text: String,
    /// Where it was written: the statement.
    pub span: Span,
    /// What the forces do where it is zero.
    pub discontinuity: Discontinuity,
    /// Whether it is a function of the time alone.
    pub of_time: bool,
}

/// What forces do where a switching function is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Discontinuity {
    /// They may jump.
    Jump,
    /// They are continuous, but for the slope.
    Kink,
    /// They go on with another polynomial of a spline: nothing depends on the side.
    Knot,
}

/// A coordinate as the description declares it, in terms of those that were kept.
#[derive(Clone, Debug)]
pub struct Described {
    /// Name, unit, docs.
    pub quantity: Quantity,
    /// The constraint that gives it, if it was eliminated.
    pub given_by: Option<Constraint>,
    /// Its value.
    pub position: ExprId,
    /// Its velocity.
    pub velocity: ExprId,
    /// Its acceleration, of the accelerations of those that were kept.
    pub acceleration: ExprId,
    /// The generalized reaction force at it, of all constraints that were written;
    /// likewise.
    pub reaction: ExprId,
}

/// A named quantity with the unit and the doc comment it was given.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// The name as written: `q1`, `theta[0]`.
    pub name: String,
    /// The unit as written, empty if there is none.
    pub unit: String,
    /// The doc comment, empty if there is none.
    pub docs: String,
    /// Where it was declared.
    pub span: Span,
}

/// A run-time parameter and its default.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Name, unit, docs.
    pub quantity: Quantity,
    /// The default: an expression of numbers alone.
    pub default: ExprId,
}

/// A constant, folded.
#[derive(Clone, Debug)]
pub struct Constant {
    /// Name, unit, docs.
    pub quantity: Quantity,
    /// Its value: an expression of numbers alone.
    pub value: ExprId,
}

/// An external signal and its default law.
#[derive(Clone, Debug)]
pub struct Input {
    /// Name, unit, docs.
    pub quantity: Quantity,
    /// The law, of time, coordinates, velocities and parameters.
    pub law: ExprId,
}

/// A summand of an energy.
#[derive(Clone, Copy, Debug)]
pub struct Summand {
    /// The expression.
    pub value: ExprId,
    /// Where it was written.
    pub span: Span,
}

/// `force F on x`: virtual work `Σ F_k δx_k`; on an angular velocity virtual power.
#[derive(Clone, Debug)]
pub struct Force {
    /// Components of the force.
    pub force: Vec<ExprId>,
    /// Components of the point, or the coordinate, angle or length; or of a velocity.
    pub on: Vec<ExprId>,
    /// Whether it is a velocity, which is linear in those of the coordinates.
    pub on_velocity: bool,
    /// Where it was written.
    pub span: Span,
}

/// One scalar constraint equation.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// Left side minus right side: `g` of a holonomic constraint; of a velocity
    /// constraint an expression linear in the velocities.
    pub residual: ExprId,
    /// Whether it restricts positions (else velocities).
    pub holonomic: bool,
    /// The equation as written, with `[x]`, `[y]`, `[z]` behind it for a row of
    /// a vector equation and the values of the loop indices, if any.
    pub text: String,
    /// Name and unit of its multiplier, if the constraint has a name.
    pub multiplier: Option<Quantity>,
    /// Where it was written.
    pub span: Span,
}

/// An entry of the `start` block.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Index of the coordinate.
    pub coordinate: usize,
    /// Whether it is the velocity that is given.
    pub velocity: bool,
    /// The value, of parameters and numbers.
    pub value: ExprId,
    /// `=` (held) or `~` (a guess).
    pub held: bool,
    /// Where it was written.
    pub span: Span,
}

/// An observable.
#[derive(Clone, Debug)]
pub struct Output {
    /// Name, unit, docs.
    pub quantity: Quantity,
    /// The value.
    pub value: ExprId,
    /// Whether it is one of accelerations.
    pub accelerated: bool,
}

/// An event function.
#[derive(Clone, Debug)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// The function whose zeros are wanted.
    pub value: ExprId,
    /// Which sign changes count.
    pub direction: Direction,
    /// Where it was written.
    pub span: Span,
}

/// Which sign changes of an event function count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
    /// Both.
    Crossing,
}

/// A point `(x, y, z)`, `z = 0` in the plane.
pub type Point = [ExprId; 3];

/// A part of the picture.
#[derive(Clone, Debug)]
pub enum Shape {
    /// An open polygon through the points.
    Line(Vec<Point>),
    /// A circle of a radius about a centre.
    Circle(Point, ExprId),
    /// A closed, filled polygon.
    Polygon(Vec<Point>),
    /// A point whose path is wanted.
    Trace(Point),
}

impl Shape {
    /// Its numbers: points one after the other, the radius last.
    pub fn numbers(&self) -> Vec<ExprId> {
        match self {
            Shape::Line(points) | Shape::Polygon(points) => points.concat(),
            Shape::Circle(centre, radius) => centre.iter().chain([radius]).copied().collect(),
            Shape::Trace(point) => point.to_vec(),
        }
    }
}

impl Mechanism {
    /// A mechanism with nothing in it but its name.
    fn named(name: &str, docs: &str) -> Self {
        Self {
            name: name.to_string(),
            docs: docs.to_string(),
            ..Self::default()
        }
    }

    /// How many coordinates are declared as such.
    pub fn freedoms(&self) -> usize {
        self.coordinates.len() - self.states
    }

    /// A symbol as the description writes it: `q1`, `der(q1)`, `L1`, `t`.
    pub fn symbol_text(&self, symbol: Symbol) -> String {
        let coordinate = |i: u32| &self.coordinates[i as usize].name;
        match symbol {
            Symbol::Time => "t".to_string(),
            Symbol::Coordinate(i) => coordinate(i).clone(),
            Symbol::Velocity(i) if i as usize >= self.freedoms() => coordinate(i).clone(),
            Symbol::Velocity(i) => format!("der({})", coordinate(i)),
            Symbol::Parameter(i) => self.parameters[i as usize].quantity.name.clone(),
            Symbol::Input(i) => self.inputs[i as usize].quantity.name.clone(),
            Symbol::Acceleration(i) if i as usize >= self.freedoms() => {
                format!("der({})", coordinate(i))
            }
            Symbol::Acceleration(i) => format!("der(der({}))", coordinate(i)),
            Symbol::Multiplier(i) => format!("lambda[{i}]"),
            Symbol::Weight(i) => format!("w[{i}]"),
            Symbol::Tabulated(i) => format!("number[{i}]"),
            Symbol::Follows(i) => {
                format!("follows({})", self.inputs[i as usize].quantity.name)
            }
        }
    }
}
