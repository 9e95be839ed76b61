//! Mechanisms with one line of mathematics each.

use super::{ANGLE, LENGTH, structure};
use bricard_runtime::nalgebra::SMatrix;
use bricard_runtime::{ConstraintRow, Energy, Mechanism, Position, State, Structure, Terms};

/// A mass on a spring, `2 q̈ + 4 q = 0`: no constraints, constant mass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spring;

static SPRING: Structure = Structure {
    constant_mass: true,
    ..structure(&[LENGTH], &[])
};

impl Mechanism<f64, 1, 0> for Spring {
    fn structure(&self) -> &'static Structure {
        &SPRING
    }

    fn terms(&self, state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        out.mass[(0, 0)] = 2.0;
        out.force[0] = -4.0 * state.q[0];
    }

    fn energy(&self, _state: &State<f64, 1>) -> Energy<f64> {
        Energy::default()
    }
}

/// A sled on ice: `x`, `y`, heading `θ`; its runner does not slip sideways,
/// `ẋ sin θ − ẏ cos θ = 0`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sled;

static SLED: Structure = Structure {
    scleronomic: false,
    ..structure(
        &[LENGTH, LENGTH, ANGLE],
        &[ConstraintRow {
            text: "der(x)*sin(theta) = der(y)*cos(theta)",
            line: 1,
            holonomic: false,
        }],
    )
};

impl Sled {
    fn mass() -> SMatrix<f64, 3, 3> {
        SMatrix::from_diagonal(&[1.5, 1.5, 0.4].into())
    }
}

impl Mechanism<f64, 3, 1> for Sled {
    fn structure(&self) -> &'static Structure {
        &SLED
    }

    fn terms(&self, state: &State<f64, 3>, out: &mut Terms<f64, 3, 1>) {
        let ((s, c), v) = (state.q[2].sin_cos(), &state.v);
        out.mass = Self::mass();
        out.jacobian = SMatrix::from([[s], [-c], [0.0]]);
        out.bias[0] = -(v[0] * c + v[1] * s) * v[2];
    }

    fn position(&self, state: &State<f64, 3>, out: &mut Position<f64, 3, 1>) {
        let (s, c) = state.q[2].sin_cos();
        out.mass = Self::mass();
        out.jacobian = SMatrix::from([[s], [-c], [0.0]]);
    }

    fn energy(&self, state: &State<f64, 3>) -> Energy<f64> {
        let kinetic = 0.5 * state.v.dot(&(Self::mass() * state.v));
        Energy {
            kinetic,
            balance: kinetic,
            ..Energy::default()
        }
    }
}
