//! Every constraint of a mechanism written twice: the same motion.

use super::{Passing, Reduction};
use bricard_runtime::{Energy, Mechanism, Position, State, Structure, Terms};

/// `M` with `R` rows, given as a mechanism of `2R` rows, the copies scaled.
#[derive(Clone, Copy, Debug, Default)]
pub struct Twice<M, const R: usize>(pub M);

/// What the second copy of every constraint is multiplied by.
const SCALE: f64 = 7.0;

impl<M, const N: usize, const R: usize, const D: usize> Mechanism<f64, N, D> for Twice<M, R>
where
    M: Mechanism<f64, N, R>,
{
    fn structure(&self) -> &'static Structure {
        self.0.structure()
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, D>) {
        let mut once: Terms<f64, N, R> = Terms::default();
        self.0.terms(state, &mut once);
        (out.mass, out.force) = (once.mass, once.force);
        for row in 0..R {
            out.jacobian.row_mut(row).copy_from(&once.jacobian.row(row));
            out.jacobian
                .row_mut(row + R)
                .copy_from(&(once.jacobian.row(row) * SCALE));
            out.bias[row] = once.bias[row];
            out.bias[row + R] = once.bias[row] * SCALE;
        }
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, D>) {
        let mut once: Position<f64, N, R> = Position::default();
        self.0.position(state, &mut once);
        out.mass = once.mass;
        for row in 0..R {
            out.jacobian.row_mut(row).copy_from(&once.jacobian.row(row));
            out.jacobian
                .row_mut(row + R)
                .copy_from(&(once.jacobian.row(row) * SCALE));
            out.residual[row] = once.residual[row];
            out.residual[row + R] = once.residual[row] * SCALE;
            out.drift[row] = once.drift[row];
            out.drift[row + R] = once.drift[row] * SCALE;
        }
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        self.0.energy(state)
    }
}

impl<M, const N: usize, const R: usize, const D: usize> Passing<N, D> for Twice<M, R>
where
    M: Passing<N, R>,
{
    fn reduction(&self) -> Reduction {
        self.0.reduction()
    }

    fn state(&self, t: f64, angle: f64, rate: f64) -> State<f64, N> {
        self.0.state(t, angle, rate)
    }

    fn singular(&self) -> (f64, f64) {
        self.0.singular()
    }
}
