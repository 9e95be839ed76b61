//! Phong & Hoang (2012), Example 1: slider–crank with equal crank and rod.

use super::{ANGLE, GRAVITY, LENGTH, Passing, Reduction, structure};
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{Energy, Mechanism, Position, State, Structure, Terms};

/// Crank, connecting rod and slider; `drive` and `damping` make up the moment
/// `drive − damping·q̇₁` on the crank.
#[derive(Clone, Copy, Debug, Default)]
pub struct SliderCrank {
    /// Constant part of the moment (N·m).
    pub drive: f64,
    /// What the moment loses with speed (N·m·s).
    pub damping: f64,
}

const L: f64 = 0.5;
const E: f64 = 0.25;
const M1: f64 = 1.0;
const M2: f64 = 1.0;
const M3: f64 = 0.5;
const J: f64 = 0.1;

static STRUCTURE: Structure = structure(&[ANGLE, ANGLE, LENGTH], &[]);

impl SliderCrank {
    /// The paper's driven run: moment `10 − 2 q̇₁`.
    pub const DRIVEN: Self = Self {
        drive: 10.0,
        damping: 2.0,
    };

    /// Mass matrix: constant but for the coupling of crank and rod.
    fn mass(q: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
        let coupling = -M2 * L * E * (q[0] + q[1]).cos();
        SMatrix::from_columns(&[
            [M1 * E * E + J + M2 * L * L, coupling, 0.0].into(),
            [coupling, M2 * E * E + J, 0.0].into(),
            [0.0, 0.0, M3].into(),
        ])
    }

    fn jacobian(q: &SVector<f64, 3>) -> SMatrix<f64, 2, 3> {
        let ((s1, c1), (s2, c2)) = (q[0].sin_cos(), q[1].sin_cos());
        SMatrix::from_columns(&[
            [-L * s1, L * c1].into(),
            [-L * s2, -L * c2].into(),
            [-1.0, 0.0].into(),
        ])
    }
}

impl Mechanism<f64, 3, 2> for SliderCrank {
    fn structure(&self) -> &'static Structure {
        &STRUCTURE
    }

    fn terms(&self, state: &State<f64, 3>, out: &mut Terms<f64, 3, 2>) {
        let (q, v) = (&state.q, &state.v);
        let ((s1, c1), (s2, c2)) = (q[0].sin_cos(), q[1].sin_cos());
        let coriolis = M2 * L * E * (q[0] + q[1]).sin();
        out.mass = Self::mass(q);
        out.force = SVector::from([
            self.drive
                - self.damping * v[0]
                - coriolis * v[1] * v[1]
                - GRAVITY * (M1 * E + M2 * L) * c1,
            -coriolis * v[0] * v[0] + GRAVITY * M2 * E * c2,
            0.0,
        ]);
        out.jacobian = Self::jacobian(q);
        out.bias = SVector::from([
            L * (c1 * v[0] * v[0] + c2 * v[1] * v[1]),
            L * (s1 * v[0] * v[0] - s2 * v[1] * v[1]),
        ]);
    }

    fn position(&self, state: &State<f64, 3>, out: &mut Position<f64, 3, 2>) {
        let q = &state.q;
        let ((s1, c1), (s2, c2)) = (q[0].sin_cos(), q[1].sin_cos());
        out.mass = Self::mass(q);
        out.residual = SVector::from([L * c1 + L * c2 - q[2], L * s1 - L * s2]);
        out.jacobian = Self::jacobian(q);
    }

    fn energy(&self, state: &State<f64, 3>) -> Energy<f64> {
        let (q, v) = (&state.q, &state.v);
        let kinetic = 0.5 * v.dot(&(Self::mass(q) * v));
        let potential = GRAVITY * ((M1 * E + M2 * L) * q[0].sin() - M2 * E * q[1].sin());
        super::supplied(
            kinetic,
            potential,
            (self.drive - self.damping * v[0]) * v[0],
        )
    }
}

impl Passing<3, 2> for SliderCrank {
    fn reduction(&self) -> Reduction {
        Reduction {
            drive: self.drive,
            damping: self.damping,
            ..Reduction::SLIDER_CRANK
        }
    }

    fn state(&self, t: f64, angle: f64, rate: f64) -> State<f64, 3> {
        let (s, c) = angle.sin_cos();
        State::new(
            t,
            [angle, angle, 2.0 * L * c].into(),
            [rate, rate, -2.0 * L * s * rate].into(),
        )
    }

    fn singular(&self) -> (f64, f64) {
        // From rest at 45°, falling to −90°.
        let start = core::f64::consts::FRAC_PI_4;
        let end = -core::f64::consts::FRAC_PI_2;
        (end, -self.reduction().rate_after_rest(start, end))
    }
}
