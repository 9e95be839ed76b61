//! A mechanism in numbers: constraints, their derivatives and the mass matrix at
//! positions.
//!
//! In:  a mechanism and its equations.
//! Out: values at places that hold the constraints, or do not.

use super::least_squares::{ValuesAndJacobian, minimise};
use crate::derive::{Equations, Matrix};
use crate::expr::ExprId;
use crate::model::{Constraint, Graph, Mechanism, Symbol};
use std::cell::OnceCell;

/// Mechanisms with more coordinates or equations are not looked at.
const MOST_ROWS: usize = 64;
/// Nor are those whose energies and constraints have more terms.
const MOST_TERMS: usize = 6000;
/// How much parameters are varied, and the seed of that.
const VARIATION: f64 = 0.1;
const VARIED: u64 = 77;
/// Random positions that are looked at.
const POSITIONS: u64 = 3;
/// An equation holds if its error is smaller than this, relative to what its terms
/// change by when every coordinate changes by its size, or by one.
const HOLDS: f64 = 1e-8;
/// What a coordinate at the start is next to nothing below, relative to others.
const NEXT_TO_NOTHING: f64 = 1e-3;

/// A mechanism and those of its equations that the lints are about.
#[derive(Clone, Debug)]
pub struct Numbers<'a> {
    /// The mechanism.
    pub mechanism: &'a Mechanism,
    /// Its graph.
    graph: &'a Graph,
    /// The constraints, and behind them the equations of the start where they are looked at.
    rows: Vec<Row<'a>>,
    inertia: Inertia<'a>,
    parameters: Vec<f64>,
    /// Random positions, once somebody asked for them.
    samples: OnceCell<Vec<Place>>,
}

/// What `M` is found from.
#[derive(Clone, Copy, Debug)]
enum Inertia<'a> {
    /// Its entries.
    Entries(&'a Matrix),
    /// `M q̈`.
    Product(&'a [ExprId]),
}

impl<'a> Inertia<'a> {
    fn of(equations: &'a Equations) -> Option<Self> {
        let entries = equations.mass.as_ref().map(Self::Entries);
        entries.or_else(|| equations.inertia.as_deref().map(Self::Product))
    }
}

/// A constraint or an equation of the start.
#[derive(Clone, Copy, Debug)]
struct Row<'a> {
    constraint: &'a Constraint,
    /// The row of `A`.
    slopes: &'a [ExprId],
    /// `b` of the velocity level `A q̇ + b = 0`; a position that is given at the start says
    /// nothing about velocities.
    drift: Option<ExprId>,
}

/// A time and a position.
#[derive(Clone, Debug)]
pub struct Place {
    /// The time (s).
    pub t: f64,
    /// The coordinates.
    pub q: Vec<f64>,
}

fn constraints<'a>(mechanism: &'a Mechanism, equations: &'a Equations) -> Vec<Row<'a>> {
    let rows = mechanism.constraints.iter().zip(&equations.jacobian);
    let row = |((constraint, slopes), drift): ((_, &'a Vec<ExprId>), &ExprId)| Row {
        constraint,
        slopes,
        drift: Some(*drift),
    };
    rows.zip(&equations.drift).map(row).collect()
}

/// The equations of the start that are held, in the order in which they were written.
fn of_the_start<'a>(mechanism: &'a Mechanism, equations: &'a Equations) -> Vec<Row<'a>> {
    let mut positions = equations.start_positions.slopes.iter();
    let velocities = &equations.start_velocities;
    let mut velocities = velocities.slopes.iter().zip(&velocities.errors);
    let row = |constraint: &'a Constraint| {
        let (slopes, drift) = match constraint.holonomic {
            true => (positions.next()?, None),
            false => velocities.next().map(|(a, b)| (a, Some(*b)))?,
        };
        Some(Row {
            constraint,
            slopes,
            drift,
        })
    };
    mechanism.start_equations.iter().filter_map(row).collect()
}

impl<'a> Numbers<'a> {
    /// Prepares a mechanism; `None` if it is too large.
    pub fn of_motion(mechanism: &'a Mechanism, equations: &'a Equations) -> Option<Self> {
        Self::of(mechanism, equations, constraints(mechanism, equations))
    }

    /// Prepares a mechanism with the equations of its start; `None` if it is too large.
    pub fn of_start(mechanism: &'a Mechanism, equations: &'a Equations) -> Option<Self> {
        let mut rows = constraints(mechanism, equations);
        rows.extend(of_the_start(mechanism, equations));
        Self::of(mechanism, equations, rows)
    }

    fn of(mechanism: &'a Mechanism, equations: &'a Equations, rows: Vec<Row<'a>>) -> Option<Self> {
        let n = mechanism.coordinates.len();
        let energies = mechanism.kinetic.iter().map(|summand| summand.value);
        let residuals = rows.iter().map(|row| row.constraint.residual);
        let roots: Vec<ExprId> = energies.chain(residuals).collect();
        let terms = mechanism.graph.reachable(&roots).len();
        if n.max(rows.len()) > MOST_ROWS || terms > MOST_TERMS {
            return None;
        }
        let mut numbers = Self {
            mechanism,
            graph: &mechanism.graph,
            rows,
            inertia: Inertia::of(equations)?,
            parameters: Vec::new(),
            samples: OnceCell::new(),
        };
        let defaults = mechanism.parameters.iter().map(|p| p.default);
        let defaults: Vec<ExprId> = defaults.collect();
        let nowhere = Place {
            t: 0.0,
            q: vec![0.0; n],
        };
        numbers.parameters = numbers.with_inputs(&defaults, &nowhere, &[], (&[], None));
        Some(numbers)
    }

    /// The same mechanism with other values of its parameters.
    pub fn varied(&self) -> Numbers<'a> {
        let mut random = Random(VARIED);
        let varied = self.parameters.iter().map(|value| match *value {
            0.0 => VARIATION * random.next(),
            value => value * (1.0 + VARIATION * random.next()),
        });
        Numbers {
            parameters: varied.collect(),
            samples: OnceCell::new(),
            ..self.clone()
        }
    }

    /// These numbers with a graph that has more expressions.
    pub fn grown<'b>(&'b self, graph: &'b Graph) -> Numbers<'b> {
        Numbers {
            graph,
            ..self.clone()
        }
    }

    /// A constraint, or an equation of the start behind them.
    pub fn constraint(&self, row: usize) -> &'a Constraint {
        self.rows[row].constraint
    }

    /// Values of expressions at a place, at rest.
    pub fn values(&self, roots: &[ExprId], place: &Place) -> Vec<f64> {
        self.moving(roots, place, &[])
    }

    /// Values of expressions at a place, at velocities; those behind the last are zero.
    /// Inputs are at their laws.
    pub fn moving(&self, roots: &[ExprId], place: &Place, v: &[f64]) -> Vec<f64> {
        self.accelerating(roots, place, v, None)
    }

    /// Values of expressions at a place, at velocities, with the acceleration of index `unit` equal
    /// to one, if an index is given, and all others zero.
    fn accelerating(
        &self,
        roots: &[ExprId],
        place: &Place,
        v: &[f64],
        unit: Option<u32>,
    ) -> Vec<f64> {
        let laws = self.mechanism.inputs.iter().map(|input| input.law);
        let laws: Vec<ExprId> = laws.collect();
        let inputs = match laws.as_slice() {
            [] => Vec::new(),
            laws => self.with_inputs(laws, place, v, (&[], unit)),
        };
        self.with_inputs(roots, place, v, (&inputs, unit))
    }

    fn with_inputs(
        &self,
        roots: &[ExprId],
        place: &Place,
        v: &[f64],
        (inputs, unit): (&[f64], Option<u32>),
    ) -> Vec<f64> {
        let value = |symbol| match symbol {
            // An infinite law is found fault with where it stands.
            Symbol::Input(i) => match inputs.get(i as usize) {
                Some(input) if input.is_finite() => *input,
                _ => 0.0,
            },
            Symbol::Time => place.t,
            Symbol::Coordinate(i) => place.q[i as usize],
            Symbol::Velocity(i) => v.get(i as usize).copied().unwrap_or(0.0),
            Symbol::Parameter(i) => self.parameters[i as usize],
            Symbol::Acceleration(i) if unit == Some(i) => 1.0,
            _ => 0.0,
        };
        self.graph.evaluate_all(roots, &value)
    }

    fn matrix(&self, rows: &[&[ExprId]], place: &Place) -> Vec<Vec<f64>> {
        let values = self.values(&rows.concat(), place);
        let width = self.mechanism.coordinates.len().max(1);
        values.chunks(width).map(<[f64]>::to_vec).collect()
    }

    /// `M` at a place.
    pub fn mass(&self, place: &Place) -> Vec<Vec<f64>> {
        match self.inertia {
            Inertia::Entries(mass) => {
                let rows: Vec<&[ExprId]> = mass.iter().map(Vec::as_slice).collect();
                self.matrix(&rows, place)
            }
            // `M q̈` for a unit acceleration is a column of `M` and, by symmetry, its row.
            Inertia::Product(product) => {
                let row = |unit| self.accelerating(product, place, &[], Some(unit));
                (0..).map(row).take(product.len()).collect()
            }
        }
    }

    /// `A` at a place.
    pub fn jacobian(&self, place: &Place) -> Vec<Vec<f64>> {
        let rows: Vec<&[ExprId]> = self.rows.iter().map(|row| row.slopes).collect();
        self.matrix(&rows, place)
    }

    /// The rows that say something about velocities, and at a place what they say: those
    /// of `A`, and `b` of `A q̇ + b = 0`.
    pub fn velocity_level(&self, place: &Place) -> (Vec<usize>, Vec<Vec<f64>>, Vec<f64>) {
        let rows = self.rows.iter().enumerate();
        let chosen = rows.filter_map(|(i, row)| Some((i, row.slopes, row.drift?)));
        let (places, slopes_and_drift): (Vec<usize>, Vec<(&[ExprId], ExprId)>) = chosen
            .map(|(i, slopes, drift)| (i, (slopes, drift)))
            .unzip();
        let (slopes, drift): (Vec<&[ExprId]>, Vec<ExprId>) = slopes_and_drift.into_iter().unzip();
        (
            places,
            self.matrix(&slopes, place),
            self.values(&drift, place),
        )
    }

    /// The equations for positions among `rows`, linearised in the coordinates
    /// `free`.
    pub fn values_and_jacobian(
        &self,
        rows: &[usize],
        free: &[usize],
        place: &Place,
    ) -> ValuesAndJacobian {
        let chosen = || rows.iter().map(|&row| &self.rows[row]);
        let mut wanted: Vec<ExprId> = chosen().map(|row| row.constraint.residual).collect();
        for row in chosen() {
            wanted.extend(free.iter().map(|&j| row.slopes[j]));
        }
        let mut values = self.values(&wanted, place);
        let slopes = values.split_off(rows.len());
        let slopes = (0..rows.len()).map(|i| slopes[i * free.len()..][..free.len()].to_vec());
        (values, slopes.collect())
    }

    /// The equations for positions.
    pub fn positions(&self) -> Vec<usize> {
        let rows = 0..self.rows.len();
        rows.filter(|&row| self.constraint(row).holonomic).collect()
    }

    /// The equations for velocities.
    pub fn velocities(&self) -> Vec<usize> {
        let rows = 0..self.rows.len();
        rows.filter(|&row| !self.constraint(row).holonomic)
            .collect()
    }

    /// `a` and `b` of a row `a·q̇ + b = 0` at a place.
    pub fn coefficients(&self, row: usize, place: &Place) -> Vec<f64> {
        let Row { slopes, drift, .. } = self.rows[row];
        let roots: Vec<ExprId> = slopes.iter().copied().chain(drift).collect();
        self.values(&roots, place)
    }

    /// Moves free coordinates until equations hold, as far as that is possible.
    pub fn assemble(&self, rows: &[usize], free: &[usize], from: &Place) -> Option<Place> {
        let at = |x: &[f64]| {
            let mut place = from.clone();
            free.iter().zip(x).for_each(|(&j, x)| place.q[j] = *x);
            place
        };
        let guess: Vec<f64> = free.iter().map(|&j| from.q[j]).collect();
        let functions = |x: &[f64]| self.values_and_jacobian(rows, free, &at(x));
        minimise(&guess, &functions).map(|x| at(&x))
    }

    /// The errors of equations at a place, and whether they hold.
    pub fn errors(&self, rows: &[usize], place: &Place) -> (Vec<f64>, bool) {
        let all: Vec<usize> = (0..place.q.len()).collect();
        let (values, slopes) = self.values_and_jacobian(rows, &all, place);
        let slopes_at = |at: &Place| self.values_and_jacobian(rows, &all, at).1;
        let is_small = |value: f64, size: f64| value.abs() <= HOLDS * size.max(HOLDS);
        let holds = self.are_small(&values, &is_small, (&slopes, &place.q), &slopes_at);
        (values, holds)
    }

    /// Whether the errors of equations that are linearised so at a place are small beside their
    /// terms, there or nearby: where the derivatives of an equation nearly vanish, it is as
    /// accurate as elsewhere.
    pub fn are_small(
        &self,
        errors: &[f64],
        is_small: &dyn Fn(f64, f64) -> bool,
        (slopes, unknowns): (&[Vec<f64>], &[f64]),
        slopes_at: &dyn Fn(&Place) -> Vec<Vec<f64>>,
    ) -> bool {
        let size = |row: &Vec<f64>| -> f64 {
            let terms = row.iter().zip(unknowns);
            terms.map(|(a, x)| a.abs() * x.abs().max(1.0)).sum()
        };
        let all = |sizes: &[f64]| {
            errors
                .iter()
                .zip(sizes)
                .all(|(e, size)| is_small(*e, *size))
        };
        let mut sizes: Vec<f64> = slopes.iter().map(size).collect();
        if all(&sizes) {
            return true;
        }
        for seed in 1..=2 {
            let nearby = slopes_at(&self.random(seed));
            for (most, size) in sizes.iter_mut().zip(nearby.iter().map(size)) {
                if size.is_finite() {
                    *most = most.max(size);
                }
            }
        }
        all(&sizes)
    }

    /// The position of the start block, not assembled, with what is held in it.
    pub fn start(&self) -> (Place, Vec<bool>) {
        let n = self.mechanism.coordinates.len();
        let mut place = Place {
            t: 0.0,
            q: vec![0.0; n],
        };
        let mut held = vec![false; n];
        for start in self.mechanism.starts.iter().filter(|start| !start.velocity) {
            place.q[start.coordinate] = self.values(&[start.value], &place)[0];
            held[start.coordinate] = start.held;
        }
        (place, held)
    }

    /// The position of the start block, assembled; `None` where it can't be.
    pub fn assembled(&self) -> Option<Place> {
        let (guess, held) = self.start();
        let rows = self.positions();
        if rows.is_empty() {
            return Some(guess);
        }
        let free: Vec<usize> = (0..held.len()).filter(|&i| !held[i]).collect();
        let end = self.assemble(&rows, &free, &guess)?;
        self.errors(&rows, &end).1.then_some(end)
    }

    /// The velocities of the start block at its position, if the constraints hold with them as
    /// they are.
    pub fn beginning(&self, place: &Place) -> Option<Vec<f64>> {
        let mut v = vec![0.0; place.q.len()];
        let starts = self.mechanism.starts.iter();
        for start in starts.filter(|start| start.velocity) {
            v[start.coordinate] = self.values(&[start.value], place)[0];
        }
        let (_, jacobian, drift) = self.velocity_level(place);
        let rate = |row: &[f64]| row.iter().zip(&v).map(|(a, v)| a * v).sum::<f64>();
        let mut speeds = jacobian.iter().zip(&drift).map(|(row, b)| rate(row) + b);
        speeds.all(|speed| speed == 0.0).then_some(v)
    }

    /// Random positions near the start at which the constraints hold; fewer than
    /// asked for where none is found.
    pub fn samples(&self) -> &[Place] {
        self.samples.get_or_init(|| self.new_samples())
    }

    fn new_samples(&self) -> Vec<Place> {
        let (rows, free) = (
            self.positions(),
            (0..self.mechanism.coordinates.len()).collect::<Vec<_>>(),
        );
        let assembled = |place: Place| match rows.as_slice() {
            [] => Some(place),
            rows => self
                .assemble(rows, &free, &place)
                .filter(|place| self.errors(rows, place).1),
        };
        self.random_positions().filter_map(assembled).collect()
    }

    /// Some random positions near the start, at which the constraints need not hold.
    pub fn random_positions(&self) -> impl Iterator<Item = Place> {
        (1..=POSITIONS).map(|seed| self.random(seed))
    }

    /// A random position near the start.
    pub fn random(&self, seed: u64) -> Place {
        let (mut place, _) = self.start();
        let mut random = Random(seed);
        let sizes: Vec<f64> = (0..place.q.len()).map(|i| self.size(&place.q, i)).collect();
        for (q, size) in place.q.iter_mut().zip(sizes) {
            *q += 0.4 * size * random.next();
        }
        place.t = 0.5 + 0.5 * random.next();
        place
    }

    /// How large a coordinate is: what it is at a position, or, where that is next to nothing,
    /// one radian, or the largest with its unit.
    fn size(&self, q: &[f64], i: usize) -> f64 {
        let coordinates = &self.mechanism.coordinates;
        let unit = &coordinates[i].unit;
        let alike = coordinates.iter().zip(q).filter(|(c, _)| c.unit == *unit);
        let angle = if unit == "rad" { 1.0 } else { 0.0 };
        let largest = alike.fold(angle, |most: f64, (_, q)| most.max(q.abs()));
        match q[i].abs() {
            _ if largest == 0.0 => 1.0,
            own if own < NEXT_TO_NOTHING * largest => largest,
            own => own,
        }
    }
}

/// Numbers between −1 and 1 (Knuth's linear congruential generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        for _ in 0..3 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
        }
        let high = u32::try_from(self.0 >> 32).unwrap_or(0);
        f64::from(high) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}
