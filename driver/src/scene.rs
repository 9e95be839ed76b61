//! What can be seen of a mechanism.
//!
//! In:  a mechanism, rows of a run.
//! Out: [`Scene`]: what is drawn, and where it is in each row.
//!
//! Not here: how it looks.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Canvas, State, Structure, Whole};

/// What can be seen of a mechanism, and how it is set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The values of the parameters, in the order of the structure.
    pub parameters: Vec<f64>,
    /// What is drawn, in the order of the description.
    pub shapes: Vec<Drawn>,
    /// For each row the numbers of all shapes, one after the other: three for each point
    /// (m), and the radius behind that of a circle (m).
    pub frames: Vec<Vec<f64>>,
}

/// A shape that is drawn in each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// A line through a number of points.
    Line(usize),
    /// A circle about a point.
    Circle,
    /// A polygon with a number of corners.
    Polygon(usize),
    /// A point whose path is wanted.
    Trace,
}

/// Draws a mechanism in each of some rows (see [`heads`](crate::heads)).
#[inline(never)]
pub(crate) fn scene<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    rows: &[Vec<f64>],
) -> Scene {
    let count = mechanism.structure().parameters.len();
    let parameters = (0..count).map(|i| mechanism.parameter(i).unwrap_or(f64::NAN));
    let mut scene = Scene {
        parameters: parameters.collect(),
        ..Scene::default()
    };
    for row in rows {
        let mut sheet = Sheet::default();
        mechanism.draw(&shown_in(row, mechanism.structure()), &mut sheet);
        scene.shapes = sheet.shapes;
        scene.frames.push(sheet.numbers);
    }
    scene
}

/// The state that a row shows; the integrals of states of the first order, on which no
/// picture depends, are not in it.
#[inline(never)]
fn shown_in<const N: usize>(row: &[f64], structure: &Structure) -> State<f64, N> {
    let at = |i: usize| row.get(i).copied().unwrap_or(0.0);
    let freedoms = structure.freedoms().len();
    let place = |i: usize| if i < freedoms { at(1 + i) } else { 0.0 };
    State {
        t: at(0),
        q: SVector::from_fn(|i, _| place(i)),
        v: SVector::from_fn(|i, _| at(1 + freedoms + i)),
    }
}

/// Takes the numbers of shapes down.
#[derive(Default)]
struct Sheet {
    shapes: Vec<Drawn>,
    numbers: Vec<f64>,
}

impl Canvas<f64> for Sheet {
    fn line(&mut self, points: &[[f64; 3]]) {
        self.shapes.push(Drawn::Line(points.len()));
        self.numbers.extend(points.iter().flatten());
    }

    fn circle(&mut self, centre: [f64; 3], radius: f64) {
        self.shapes.push(Drawn::Circle);
        self.numbers.extend(centre);
        self.numbers.push(radius);
    }

    fn polygon(&mut self, points: &[[f64; 3]]) {
        self.shapes.push(Drawn::Polygon(points.len()));
        self.numbers.extend(points.iter().flatten());
    }

    fn trace(&mut self, point: [f64; 3]) {
        self.shapes.push(Drawn::Trace);
        self.numbers.extend(point);
    }
}
