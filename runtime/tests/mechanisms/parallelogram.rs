//! A parallelogram with a third crank that is redundant: the rank is 5 of 6 rows
//! everywhere, and 4 at the change point.

use super::{ANGLE, GRAVITY, LENGTH, Passing, Reduction, structure};
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{Energy, Mechanism, Position, State, Structure, Terms};

/// Coordinates: three crank angles, and `x`, `y`, `φ` of the coupler, whose points
/// at distances `PLACES` the cranks carry.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parallelogram;

const CRANK: f64 = 0.4;
const PLACES: [f64; 3] = [0.0, 0.7, 0.3];
const CRANK_INERTIA: f64 = 0.14;
const CRANK_MOMENT: f64 = 0.2;
const BAR_MASS: f64 = 1.0;
const BAR_INERTIA: f64 = 0.1;

static STRUCTURE: Structure = structure(&[ANGLE, ANGLE, ANGLE, LENGTH, LENGTH, ANGLE], &[]);

impl Parallelogram {
    fn mass() -> SMatrix<f64, 6, 6> {
        let (a, b) = (CRANK_INERTIA, BAR_MASS);
        SMatrix::from_diagonal(&[a, a, a, b, b, BAR_INERTIA].into())
    }

    fn jacobian(q: &SVector<f64, 6>) -> SMatrix<f64, 6, 6> {
        let mut rows = SMatrix::zeros();
        let (sp, cp) = q[5].sin_cos();
        for (k, place) in PLACES.into_iter().enumerate() {
            let (s, c) = q[k].sin_cos();
            rows[(2 * k, k)] = CRANK * s;
            rows[(2 * k + 1, k)] = -CRANK * c;
            rows[(2 * k, 3)] = 1.0;
            rows[(2 * k + 1, 4)] = 1.0;
            rows[(2 * k, 5)] = -place * sp;
            rows[(2 * k + 1, 5)] = place * cp;
        }
        rows
    }
}

impl Mechanism<f64, 6, 6> for Parallelogram {
    fn structure(&self) -> &'static Structure {
        &STRUCTURE
    }

    fn terms(&self, state: &State<f64, 6>, out: &mut Terms<f64, 6, 6>) {
        let (q, v) = (&state.q, &state.v);
        out.mass = Self::mass();
        for k in 0..3 {
            out.force[k] = -GRAVITY * CRANK_MOMENT * q[k].cos();
        }
        out.force[4] = -GRAVITY * BAR_MASS;
        out.jacobian = Self::jacobian(q);
        let (sp, cp) = q[5].sin_cos();
        for (k, place) in PLACES.into_iter().enumerate() {
            let (s, c) = q[k].sin_cos();
            let (a, b) = (v[k] * v[k], v[5] * v[5]);
            out.bias[2 * k] = -CRANK * c * a + place * cp * b;
            out.bias[2 * k + 1] = -CRANK * s * a + place * sp * b;
        }
    }

    fn position(&self, state: &State<f64, 6>, out: &mut Position<f64, 6, 6>) {
        let q = &state.q;
        out.mass = Self::mass();
        out.jacobian = Self::jacobian(q);
        let (sp, cp) = q[5].sin_cos();
        for (k, place) in PLACES.into_iter().enumerate() {
            let (s, c) = q[k].sin_cos();
            out.residual[2 * k] = q[3] + place * cp - place - CRANK * c;
            out.residual[2 * k + 1] = q[4] + place * sp - CRANK * s;
        }
    }

    fn energy(&self, state: &State<f64, 6>) -> Energy<f64> {
        let q = &state.q;
        let kinetic = 0.5 * state.v.dot(&(Self::mass() * state.v));
        let cranks = q[0].sin() + q[1].sin() + q[2].sin();
        let potential = GRAVITY * (CRANK_MOMENT * cranks + BAR_MASS * q[4]);
        super::supplied(kinetic, potential, 0.0)
    }
}

impl Passing<6, 6> for Parallelogram {
    fn reduction(&self) -> Reduction {
        Reduction {
            constant: 3.0 * CRANK_INERTIA + BAR_MASS * CRANK * CRANK,
            ripple: 0.0,
            weight: GRAVITY * (3.0 * CRANK_MOMENT + BAR_MASS * CRANK),
            drive: 0.0,
            damping: 0.0,
        }
    }

    fn state(&self, t: f64, angle: f64, rate: f64) -> State<f64, 6> {
        let (s, c) = angle.sin_cos();
        let (x, y) = (CRANK * c, CRANK * s);
        State::new(
            t,
            [angle, angle, angle, x, y, 0.0].into(),
            [rate, rate, rate, -y * rate, x * rate, 0.0].into(),
        )
    }

    fn singular(&self) -> (f64, f64) {
        let rest = 80.0_f64.to_radians();
        (0.0, -self.reduction().rate_after_rest(rest, 0.0))
    }
}
