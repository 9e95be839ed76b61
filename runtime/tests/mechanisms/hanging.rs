//! A chain of rods in space whose ends are fixed: large, and nothing is special about it.

use super::structure;
use bricard_runtime::{
    ConstraintRow, Energy, Mechanism, Position, Quantity, State, Structure, Terms,
};
use core::cell::Cell;

/// Rods.
pub const RODS: usize = 50;
/// Coordinates: three of each centre, four Euler parameters.
pub const N: usize = 7 * RODS;
/// Constraint equations: the norms of the parameters, three at each of the joints.
pub const R: usize = RODS + 3 * (RODS + 1);

static COORDINATES: [Quantity; N] = {
    let mut coordinates = [super::LENGTH; N];
    let mut i = 3 * RODS;
    while i < N {
        coordinates[i].unit = "";
        i += 1;
    }
    coordinates
};

static HANGING: Structure = structure(&COORDINATES, &[ROW; R]);

const ROW: ConstraintRow = ConstraintRow {
    text: "joint",
    line: 1,
    holonomic: true,
};

/// Rods of length and mass one, from the origin to a place at 0.8 of their length along y.
#[derive(Clone, Debug, Default)]
pub struct Hanging {
    /// How often positions were evaluated.
    pub evaluations: Cell<usize>,
}

/// Where a coordinate of a rod is: `kind` 0 to 2 of the centre, 3 to 6 of the parameters.
pub const fn place(kind: usize, rod: usize) -> usize {
    kind * RODS + rod
}

/// Half of the first axis of a body with Euler parameters, and its derivatives by them.
fn half([a, b, c, d]: [f64; 4]) -> ([f64; 3], [[f64; 4]; 3]) {
    let half = [
        (a * a + b * b - c * c - d * d) / 2.0,
        b * c + a * d,
        b * d - a * c,
    ];
    let slopes = [[a, b, -c, -d], [d, c, b, a], [-c, d, -a, b]];
    (half, slopes)
}

impl Mechanism<f64, N, R> for Hanging {
    fn structure(&self) -> &'static Structure {
        &HANGING
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        let mut at = Box::new(Position::default());
        self.position(state, &mut at);
        (out.mass, out.jacobian) = (at.mass, at.jacobian);
        out.bias.fill(0.0);
        for rod in 0..RODS {
            out.force[place(2, rod)] = -super::GRAVITY;
            let rates: [f64; 4] = core::array::from_fn(|k| state.v[place(3 + k, rod)]);
            out.bias[rod] = -2.0 * rates.iter().map(|x| x * x).sum::<f64>();
            // What is quadratic has twice its value at the rates as second derivative.
            let (half, _) = half(rates);
            for (k, half) in half.iter().enumerate() {
                let first = RODS + 3 * rod + k;
                out.bias[first] -= 2.0 * half;
                out.bias[first + 3] -= 2.0 * half;
            }
        }
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        self.evaluations.set(self.evaluations.get() + 1);
        let mut ends = [[0.0; 3]; RODS + 1];
        ends[RODS][1] = -0.8 * RODS as f64;
        for rod in 0..RODS {
            let e: [f64; 4] = core::array::from_fn(|k| state.q[place(3 + k, rod)]);
            for (i, entry) in e.iter().enumerate() {
                out.mass[(place(3 + i, rod), place(3 + i, rod))] = 0.3;
                out.jacobian[(rod, place(3 + i, rod))] = 2.0 * entry;
            }
            out.residual[rod] = e.iter().map(|x| x * x).sum::<f64>() - 1.0;
            let (half, slopes) = half(e);
            for k in 0..3 {
                let (centre, first) = (place(k, rod), RODS + 3 * rod + k);
                out.mass[(centre, centre)] = 1.0;
                for (row, sign) in [(first, -1.0), (first + 3, 1.0)] {
                    // At a joint, the end of a rod minus the beginning of the next one.
                    out.jacobian[(row, centre)] = sign;
                    for (i, slope) in slopes[k].iter().enumerate() {
                        out.jacobian[(row, place(3 + i, rod))] = *slope;
                    }
                }
                ends[rod][k] -= state.q[centre] - half[k];
                ends[rod + 1][k] += state.q[centre] + half[k];
            }
        }
        for (joint, gap) in ends.iter().enumerate() {
            (0..3).for_each(|k| out.residual[RODS + 3 * joint + k] = gap[k]);
        }
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        let (centres, parameters) = state.v.as_slice().split_at(3 * RODS);
        let squares = |rates: &[f64]| rates.iter().map(|x| x * x).sum::<f64>();
        let kinetic = (squares(centres) + 0.3 * squares(parameters)) / 2.0;
        let heights = (0..RODS).map(|rod| state.q[place(2, rod)]);
        let potential = super::GRAVITY * heights.sum::<f64>();
        super::supplied(kinetic, potential, 0.0)
    }
}
