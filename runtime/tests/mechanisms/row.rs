//! Parallelograms in a row, in x and y of their corners: any number of loops.

use super::structure;
use bricard_runtime::{
    ConstraintRow, Energy, Mechanism, Position, Quantity, State, Structure, Terms,
};

/// `LOOPS` parallelograms of massless rods of length one, with masses of one at the upper
/// corners: `2·LOOPS + 2` coordinates, a constraint for each of the `2·LOOPS + 1` rods.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row<const LOOPS: usize>;

/// The sizes of a row.
pub const fn sizes(loops: usize) -> (usize, usize) {
    (2 * loops + 2, 2 * loops + 1)
}

const CONSTRAINT: ConstraintRow = ConstraintRow {
    text: "rod",
    line: 1,
    holonomic: true,
};

/// What a rod leads to: the corner where it ends, and the one where it begins, if that is
/// none of the ground.
fn ends(row: usize, loops: usize) -> (usize, Option<usize>) {
    match row.checked_sub(loops + 1) {
        None => (row, None),
        Some(coupler) => (coupler + 1, Some(coupler)),
    }
}

macro_rules! rows {
    ($($loops:literal)*) => {
        $(impl Mechanism<f64, { sizes($loops).0 }, { sizes($loops).1 }> for Row<$loops> {
            fn structure(&self) -> &'static Structure {
                static COORDINATES: [Quantity; sizes($loops).0] =
                    [super::LENGTH; sizes($loops).0];
                static ROW: Structure = structure(&COORDINATES, &[CONSTRAINT; sizes($loops).1]);
                &ROW
            }

            fn terms(
                &self,
                state: &State<f64, { sizes($loops).0 }>,
                out: &mut Terms<f64, { sizes($loops).0 }, { sizes($loops).1 }>,
            ) {
                out.mass.fill_diagonal(1.0);
                for corner in 0..=$loops {
                    out.force[2 * corner + 1] = -super::GRAVITY;
                }
                for row in 0..sizes($loops).1 {
                    let (to, from) = ends(row, $loops);
                    let mut square = 0.0;
                    for k in 0..2 {
                        let at = |values: &[f64]| {
                            values[2 * to + k] - from.map_or(0.0, |from| values[2 * from + k])
                        };
                        let ground = if from.is_none() && k == 0 { row as f64 } else { 0.0 };
                        let along = at(state.q.as_slice()) - ground;
                        out.jacobian[(row, 2 * to + k)] = 2.0 * along;
                        if let Some(from) = from {
                            out.jacobian[(row, 2 * from + k)] = -2.0 * along;
                        }
                        square += at(state.v.as_slice()).powi(2);
                    }
                    out.bias[row] = -2.0 * square;
                }
            }

            fn position(
                &self,
                state: &State<f64, { sizes($loops).0 }>,
                out: &mut Position<f64, { sizes($loops).0 }, { sizes($loops).1 }>,
            ) {
                out.mass.fill_diagonal(1.0);
                for row in 0..sizes($loops).1 {
                    let (to, from) = ends(row, $loops);
                    out.residual[row] = -1.0;
                    for k in 0..2 {
                        let ground = if k == 0 { row as f64 } else { 0.0 };
                        let begin = from.map_or(ground, |from| state.q[2 * from + k]);
                        let along = state.q[2 * to + k] - begin;
                        out.residual[row] += along * along;
                        out.jacobian[(row, 2 * to + k)] = 2.0 * along;
                        if let Some(from) = from {
                            out.jacobian[(row, 2 * from + k)] = -2.0 * along;
                        }
                    }
                }
            }

            fn energy(&self, state: &State<f64, { sizes($loops).0 }>) -> Energy<f64> {
                let kinetic = state.v.norm_squared() / 2.0;
                let heights = state.q.iter().skip(1).step_by(2);
                let potential = super::GRAVITY * heights.sum::<f64>();
                super::supplied(kinetic, potential, 0.0)
            }
        })*
    };
}

rows! { 3 40 160 }
