//! A scene as a mechanism, with its constraints and without.
//!
//! In:  a [`Scene`], independent coordinates and velocities to begin with.
//! Out: [`Planted`] and [`Reduced`].

use super::smooth::{MOST, Path, Slope, Smooth};
use super::{POINTS, Scene};
use crate::descriptions::curves::Curves;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Canvas, ConstraintRow, Energy, Initial, Interface, Mechanism, Position, Quantity, Start, State,
    Structure, Terms,
};
use core::array::from_fn;
use std::sync::{Arc, Mutex};

/// A scene with its constraints: `N` coordinates, `R` rows.
#[derive(Clone, Debug)]
pub struct Planted<const N: usize, const R: usize> {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Independent coordinates and velocities at the start.
    pub start: ([f64; MOST], [f64; MOST]),
    /// What is known of it.
    pub structure: &'static Structure,
}

/// A scene in its `N` independent coordinates.
#[derive(Clone, Debug)]
pub struct Reduced<const N: usize> {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Independent coordinates and velocities at the start.
    pub start: ([f64; MOST], [f64; MOST]),
    /// What is known of it.
    pub structure: &'static Structure,
}

const COORDINATE: Quantity = Quantity {
    name: "q",
    unit: "",
    docs: "",
};
const COORDINATES: [Quantity; MOST] = [COORDINATE; MOST];
const ROW: ConstraintRow = ConstraintRow {
    text: "planted",
    line: 0,
    holonomic: true,
};
const ROWS: [ConstraintRow; MOST] = [ROW; MOST];

/// The structure of a scene with so many coordinates and rows. Each is made once.
pub fn trial_structure(n: usize, rows: usize, conservative: bool) -> &'static Structure {
    type Key = (usize, usize, bool);
    static KNOWN: Mutex<Vec<(Key, &'static Structure)>> = Mutex::new(Vec::new());
    let key = (n, rows, conservative);
    let mut known = KNOWN.lock().expect("nothing panics here");
    if let Some((_, structure)) = known.iter().find(|(other, _)| *other == key) {
        return structure;
    }
    let other = Curves::<f64>::default();
    let structure = Structure {
        name: "Planted",
        coordinates: &COORDINATES[..n],
        constraints: &ROWS[..rows],
        parameters: &[],
        outputs: &[],
        events: &[],
        constant_mass: false,
        conservative,
        scleronomic: conservative,
        ..*other.structure()
    };
    let structure: &'static Structure = Box::leak(Box::new(structure));
    known.push((key, structure));
    structure
}

/// The coordinates as variables, and time.
fn slopes<const N: usize>(state: &State<f64, N>) -> ([Slope; MOST], Slope) {
    let variable = |i: usize| match i < N {
        true => Slope::variable(state.q[i], i),
        false => Slope::of(0.0),
    };
    (from_fn(variable), Slope::variable(state.t, MOST))
}

/// The straight path with the velocity, and time.
fn paths<const N: usize>(state: &State<f64, N>) -> ([Path; MOST], Path) {
    let along = |i: usize| match i < N {
        true => Path([state.q[i], state.v[i], 0.0]),
        false => Path::of(0.0),
    };
    (from_fn(along), Path([state.t, 1.0, 0.0]))
}

/// Mass matrix and forces of points of unit mass: the columns of `slopes` are ∂φ, those
/// of `paths` φ″, the potential behind them.
fn inertia<const N: usize, const R: usize>(
    slopes: &[Slope],
    paths: &[Path],
    out: &mut Terms<f64, N, R>,
) {
    let points = slopes.len() - 1;
    out.force = SVector::from_fn(|i, _| -slopes[points].by[i]);
    out.mass.fill(0.0);
    for (slope, path) in slopes[..points].iter().zip(paths) {
        let row: SVector<f64, N> = SVector::from_fn(|i, _| slope.by[i]);
        out.mass += row * row.transpose();
        out.force -= row * path.0[2];
    }
}

fn energy(paths: &[Path]) -> Energy<f64> {
    let points = paths.len() - 1;
    let squares = paths[..points].iter().map(|path| path.0[1] * path.0[1]);
    let (kinetic, potential) = (0.5 * squares.sum::<f64>(), paths[points].0[0]);
    Energy {
        kinetic,
        potential,
        balance: kinetic + potential,
        power: 0.0,
    }
}

impl<const N: usize, const R: usize> Mechanism<f64, N, R> for Planted<N, R> {
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        let count = self.scene.count();
        let ((q, t), (along, now)) = (slopes(state), paths(state));
        let mut points = ([Slope::of(0.0); POINTS], [Path::of(0.0); POINTS]);
        self.scene.points(&q, &mut points.0);
        self.scene.points(&along, &mut points.1);
        inertia(&points.0[..=count], &points.1[..=count], out);
        let mut rows = ([Slope::of(0.0); MOST], [Path::of(0.0); MOST]);
        self.scene.rows(&q, t, &mut rows.0);
        self.scene.rows(&along, now, &mut rows.1);
        for i in 0..R {
            out.bias[i] = -rows.1[i].0[2];
            for j in 0..N {
                out.jacobian[(i, j)] = rows.0[i].by[j];
            }
        }
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        let (q, t) = slopes(state);
        let mut points = [Slope::of(0.0); POINTS];
        self.scene.points(&q, &mut points);
        out.mass.fill(0.0);
        for slope in &points[..self.scene.count()] {
            let row: SVector<f64, N> = SVector::from_fn(|i, _| slope.by[i]);
            out.mass += row * row.transpose();
        }
        let mut rows = [Slope::of(0.0); MOST];
        self.scene.rows(&q, t, &mut rows);
        for (i, row) in rows.iter().enumerate().take(R) {
            (out.residual[i], out.drift[i]) = (row.value, row.by[MOST]);
            for j in 0..N {
                out.jacobian[(i, j)] = row.by[j];
            }
        }
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        let mut points = [Path::of(0.0); POINTS];
        self.scene.points(&paths(state).0, &mut points);
        energy(&points[..=self.scene.count()])
    }
}

impl<const N: usize> Mechanism<f64, N, 0> for Reduced<N> {
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, 0>) {
        let count = self.scene.count();
        let ((x, t), (along, now)) = (slopes(state), paths(state));
        let mut points = ([Slope::of(0.0); POINTS], [Path::of(0.0); POINTS]);
        self.scene.points(&self.scene.lift(&x, t), &mut points.0);
        self.scene
            .points(&self.scene.lift(&along, now), &mut points.1);
        inertia(&points.0[..=count], &points.1[..=count], out);
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        let (along, now) = paths(state);
        let mut points = [Path::of(0.0); POINTS];
        self.scene
            .points(&self.scene.lift(&along, now), &mut points);
        energy(&points[..=self.scene.count()])
    }
}

/// Coordinates and velocities of the whole at independent ones.
fn lifted<const N: usize>(scene: &Scene, state: &State<f64, N>) -> [Path; MOST] {
    let (along, now) = paths(state);
    scene.lift(&along, now)
}

macro_rules! no_inputs {
    () => {
        fn parameter(&self, _index: usize) -> Option<f64> {
            None
        }

        fn set_parameter(&mut self, _index: usize, _value: f64) -> bool {
            false
        }

        fn set_input(&mut self, _index: usize, _value: Option<f64>) -> bool {
            false
        }

        fn draw(&self, _state: &State<f64, N>, _canvas: &mut dyn Canvas<f64>) {}
    };
}

impl<const N: usize, const R: usize> Interface<f64, N> for Planted<N, R> {
    no_inputs!();

    fn start(&self) -> Start<f64, N> {
        let (x, v) = self.start;
        let along = from_fn(|i| Path([x[i], v[i], 0.0]));
        let whole = self.scene.lift(&along, Path([0.0, 1.0, 0.0]));
        let guess = |value| Initial { value, held: false };
        Start {
            q: from_fn(|i| guess(whole[i].0[0])),
            v: from_fn(|i| guess(whole[i].0[1])),
        }
    }

    fn outputs(&self, state: &State<f64, N>, values: &mut [f64]) {
        let q = from_fn(|i| if i < N { state.q[i] } else { 0.0 });
        self.scene.off(&q, state.t, values);
    }

    fn events(&self, _state: &State<f64, N>, _values: &mut [f64]) {}
}

impl<const N: usize> Interface<f64, N> for Reduced<N> {
    no_inputs!();

    fn start(&self) -> Start<f64, N> {
        let (x, v) = self.start;
        let held = |value| Initial { value, held: true };
        Start {
            q: from_fn(|i| held(x[i])),
            v: from_fn(|i| held(v[i])),
        }
    }

    fn outputs(&self, state: &State<f64, N>, values: &mut [f64]) {
        let all = self.scene.sizes().0;
        for (i, path) in lifted(&self.scene, state)[..all].iter().enumerate() {
            (values[i], values[all + i]) = (path.0[0], path.0[1]);
        }
    }

    fn events(&self, state: &State<f64, N>, values: &mut [f64]) {
        let x = from_fn(|i| if i < N { state.q[i] } else { 0.0 });
        self.scene.crossings(&x, values);
    }
}
