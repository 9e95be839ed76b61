//! The descriptions that are tested: those of the library, and fixtures that hold
//! what no mechanism of the library has.

use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{
    Equations, Linearisation, Matrix, derive, linearise, mass_matrix,
};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model;
use bricard_runtime::{Interface, Mechanism, Real, Visitor, Whole};
use bricard_testkit::Random;

/// A description, checked and derived.
pub struct Derived {
    pub name: String,
    pub mechanism: model::Mechanism,
    pub equations: Equations,
    /// `M`, also where equations do without its entries.
    pub mass: Matrix,
    pub linearised: Linearisation,
}

/// Values of every symbol of a mechanism.
#[derive(Clone, Debug)]
pub struct Point {
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub parameters: Vec<f64>,
    pub inputs: Vec<f64>,
    /// Whether inputs follow their laws: `inputs` are then the values of these.
    pub follows: bool,
    pub accelerations: Vec<f64>,
    pub multipliers: Vec<f64>,
}

/// Checks and derives a description.
pub fn derived(name: &str, source: &str) -> Derived {
    let analysed = analyse(source, &CompileSettings::default());
    let (mut mechanism, _) =
        analysed.unwrap_or_else(|errors| panic!("{}", errors.render(name, source)));
    let equations = derive(&mut mechanism).expect("equations of a usual length");
    let mass = mass_matrix(&mut mechanism, &equations);
    let linearised = linearise(&mut mechanism, &equations).expect("derivatives likewise");
    Derived {
        name: name.to_string(),
        mechanism,
        equations,
        mass,
        linearised,
    }
}

/// The names of the mechanisms of the library and of the fixtures.
pub fn names() -> impl Iterator<Item = &'static str> {
    bricard::NAMES
        .iter()
        .chain(bricard_fixtures::NAMES)
        .copied()
}

/// The mechanism of the library whose motion is a thousand times faster than that of
/// the others, and whose deflections are as much smaller.
const FAST: &str = "flexible_slider_crank";

/// By what times are multiplied, so that as much happens in one mechanism as in another.
pub fn time_scale(name: &str) -> f64 {
    if name == FAST { 0.01 } else { 1.0 }
}

/// Whether random states with values of about one are sensible. A steel beam bent by metres
/// has forces whose round-off is larger than all other terms.
pub fn is_of_unit_size(name: &str) -> bool {
    name != FAST
}

/// The mechanisms with more constraint equations than are ever independent.
pub const REDUNDANT: [&str; 4] = ["bennett", "spherical_four_bar", "three_cranks", "loosened"];

/// Whether the constraint equations of a mechanism are independent anywhere.
pub fn has_regular_states(name: &str) -> bool {
    !REDUNDANT.contains(&name)
}

/// The mechanisms whose springs ask explicit methods for steps a hundred times shorter.
const STIFF: [&str; 2] = [FAST, "flyball_governor"];

/// By what fixed steps are multiplied, so that explicit methods are stable.
pub fn step_scale(name: &str) -> f64 {
    if STIFF.contains(&name) { 0.01 } else { 1.0 }
}

/// The description of a mechanism.
pub fn source(name: &str) -> &'static str {
    let found = bricard::source(name).or_else(|| bricard_fixtures::source(name));
    found.unwrap_or_else(|| panic!("{name} is in no catalogue"))
}

/// The mechanisms of the library and the fixtures.
pub fn everything() -> impl Iterator<Item = Derived> {
    names().map(|name| derived(name, source(name)))
}

/// Asks a compiled mechanism whose type is forgotten, so that the test is compiled once for
/// each pair of sizes, and the simulation not at all where the library has that pair.
pub trait Inspect<T: Real> {
    /// What it answers.
    type Output;

    /// Asks it.
    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<T, N, R>,
    ) -> Self::Output;
}

struct Erased<I>(I);

impl<T: Real, I: Inspect<T>> Visitor<T> for Erased<I> {
    type Output = I::Output;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> I::Output
    where
        M: Mechanism<T, N, R> + Interface<T, N> + Clone + 'static,
    {
        self.0.inspect::<N, R>(&mut mechanism)
    }
}

/// Inspects the compiled mechanism of a name, fixtures included.
pub fn inspect<T: Real, I: Inspect<T>>(name: &str, inspector: I) -> I::Output {
    let inspected = if bricard::NAMES.contains(&name) {
        bricard::visit(name, Erased(inspector))
    } else {
        bricard_fixtures::visit(name, Erased(inspector))
    };
    inspected.unwrap_or_else(|| panic!("{name} is in no catalogue"))
}

impl Derived {
    /// `N`, the number of coordinates.
    pub fn n(&self) -> usize {
        self.mechanism.coordinates.len()
    }

    /// The values of parameters that the description gives.
    pub fn defaults(&self) -> Vec<f64> {
        let value = |e: ExprId| self.mechanism.graph.constant_value(e).unwrap_or(f64::NAN);
        self.mechanism
            .parameters
            .iter()
            .map(|p| value(p.default))
            .collect()
    }

    /// Random values of everything; parameters near their defaults.
    pub fn point(&self, random: &mut Random) -> Point {
        let defaults = self.defaults();
        Point {
            t: random.between(-2.0, 2.0),
            q: random.vector(self.n(), -3.0, 3.0),
            v: random.vector(self.n(), -3.0, 3.0),
            parameters: defaults
                .iter()
                .map(|x| x * random.between(0.5, 1.5))
                .collect(),
            inputs: random.vector(self.mechanism.inputs.len(), -3.0, 3.0),
            follows: false,
            accelerations: random.vector(self.n(), -3.0, 3.0),
            multipliers: random.vector(self.equations.residual.len(), -3.0, 3.0),
        }
    }

    /// The value of an expression.
    pub fn value(&self, e: ExprId, point: &Point) -> f64 {
        self.mechanism
            .graph
            .evaluate(e, &|symbol| point.value(symbol))
    }

    pub fn vector(&self, entries: &[ExprId], point: &Point) -> Vec<f64> {
        self.mechanism
            .graph
            .evaluate_all(entries, &|symbol| point.value(symbol))
    }

    pub fn matrix(&self, rows: &[Vec<ExprId>], point: &Point) -> Vec<Vec<f64>> {
        rows.iter().map(|row| self.vector(row, point)).collect()
    }

    /// Whether time itself occurs in the mass matrix.
    pub fn mass_knows_time(&self) -> bool {
        let graph = &self.mechanism.graph;
        let entries = self.mass.iter().flatten();
        entries
            .into_iter()
            .any(|e| graph.depends_on(*e, Symbol::Time))
    }
}

impl Point {
    pub fn value(&self, symbol: Symbol) -> f64 {
        match symbol {
            Symbol::Time => self.t,
            Symbol::Coordinate(i) => self.q[i as usize],
            Symbol::Velocity(i) => self.v[i as usize],
            Symbol::Parameter(i) => self.parameters[i as usize],
            Symbol::Input(i) => self.inputs[i as usize],
            Symbol::Acceleration(i) => self.accelerations[i as usize],
            Symbol::Multiplier(i) => self.multipliers[i as usize],
            Symbol::Weight(_) | Symbol::Tabulated(_) => unreachable!("equations have none"),
            Symbol::Follows(_) => f64::from(self.follows),
        }
    }
}
