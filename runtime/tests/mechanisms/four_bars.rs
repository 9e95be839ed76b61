//! Parallelogram loops in a row: `B` loops share `B + 1` cranks. Two are Phong &
//! Hoang (2012), Example 2. At a singular position the rank falls by `B`.

use super::{ANGLE, GRAVITY, Passing, Reduction, structure};
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{Energy, Mechanism, Position, State, Structure, Terms};

/// Cranks `0, 2, 4, …` of length `CRANK` and couplers `1, 3, …` of length `BAR`
/// between them, all of one mass.
#[derive(Clone, Copy, Debug, Default)]
pub struct FourBars;

const CRANK: f64 = 0.4;
const BAR: f64 = 0.7;
const MASS: f64 = 1.0;
const J: f64 = 0.1;
/// Inertia that couples a crank with the coupler that hangs on it.
const COUPLING: f64 = MASS * CRANK * BAR / 2.0;

static STRUCTURE: Structure = structure(&[ANGLE; 81], &[]);

/// How many couplers hang on the crank at an even index.
fn couplers<const N: usize>(crank: usize) -> f64 {
    if crank + 1 < N { 1.0 } else { 0.0 }
}

fn mass<const N: usize>(q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    let mut mass = SMatrix::zeros();
    for i in (0..N).step_by(2) {
        mass[(i, i)] = MASS * CRANK * CRANK / 4.0 + J + couplers::<N>(i) * MASS * CRANK * CRANK;
    }
    for i in (1..N).step_by(2) {
        mass[(i, i)] = MASS * BAR * BAR / 4.0 + J;
        let coupling = COUPLING * (q[i - 1] - q[i]).cos();
        mass[(i, i - 1)] = coupling;
        mass[(i - 1, i)] = coupling;
    }
    mass
}

/// Lengths of the three links that row pair `loop_` adds up, with their signs.
fn links(loop_: usize) -> [(usize, f64); 3] {
    let crank = 2 * loop_;
    [(crank, CRANK), (crank + 1, BAR), (crank + 2, -CRANK)]
}

impl<const N: usize, const R: usize> Mechanism<f64, N, R> for FourBars {
    fn structure(&self) -> &'static Structure {
        &STRUCTURE
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        let (q, v) = (&state.q, &state.v);
        out.mass = mass(q);
        for i in (0..N).step_by(2) {
            let weight = MASS * CRANK * (0.5 + couplers::<N>(i));
            out.force[i] = -GRAVITY * weight * q[i].cos();
        }
        for i in (1..N).step_by(2) {
            let coriolis = COUPLING * (q[i - 1] - q[i]).sin();
            out.force[i - 1] -= coriolis * v[i] * v[i];
            out.force[i] = coriolis * v[i - 1] * v[i - 1] - GRAVITY * MASS * BAR / 2.0 * q[i].cos();
        }
        for loop_ in 0..R / 2 {
            let mut bias = [0.0; 2];
            for (i, length) in links(loop_) {
                let (s, c) = q[i].sin_cos();
                out.jacobian[(2 * loop_, i)] = -length * s;
                out.jacobian[(2 * loop_ + 1, i)] = length * c;
                bias[0] += length * c * v[i] * v[i];
                bias[1] += length * s * v[i] * v[i];
            }
            out.bias[2 * loop_] = bias[0];
            out.bias[2 * loop_ + 1] = bias[1];
        }
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        out.mass = mass(&state.q);
        for loop_ in 0..R / 2 {
            let mut gap = [-BAR, 0.0];
            for (i, length) in links(loop_) {
                let (s, c) = state.q[i].sin_cos();
                out.jacobian[(2 * loop_, i)] = -length * s;
                out.jacobian[(2 * loop_ + 1, i)] = length * c;
                gap[0] += length * c;
                gap[1] += length * s;
            }
            out.residual[2 * loop_] = gap[0];
            out.residual[2 * loop_ + 1] = gap[1];
        }
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        let kinetic = 0.5 * state.v.dot(&(mass(&state.q) * state.v));
        let height = |i: usize| {
            let weight = match i % 2 {
                0 => MASS * CRANK * (0.5 + couplers::<N>(i)),
                _ => MASS * BAR / 2.0,
            };
            GRAVITY * weight * state.q[i].sin()
        };
        let potential = (0..N).map(height).sum();
        super::supplied(kinetic, potential, 0.0)
    }
}

impl<const N: usize, const R: usize> Passing<N, R> for FourBars {
    fn reduction(&self) -> Reduction {
        let (cranks, bars) = ((R / 2 + 1) as f64, (R / 2) as f64);
        Reduction {
            constant: cranks * (MASS * CRANK * CRANK / 4.0 + J) + bars * MASS * CRANK * CRANK,
            ripple: 0.0,
            weight: GRAVITY * MASS * CRANK * (cranks / 2.0 + bars),
            drive: 0.0,
            damping: 0.0,
        }
    }

    fn state(&self, t: f64, angle: f64, rate: f64) -> State<f64, N> {
        let even = |i: usize, value: f64| if i.is_multiple_of(2) { value } else { 0.0 };
        State::new(
            t,
            SVector::from_fn(|i, _| even(i, angle)),
            SVector::from_fn(|i, _| even(i, rate)),
        )
    }

    fn singular(&self) -> (f64, f64) {
        let rest = 80.0_f64.to_radians();
        let reduction = Passing::<N, R>::reduction(self);
        (0.0, -reduction.rate_after_rest(rest, 0.0))
    }
}
