//! A slider–crank whose slider has no mass: `M` is singular, `M + AᵀWA` is not.

use super::{ANGLE, LENGTH, SliderCrank, structure};
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    Acceleration, Correction, Energy, Mechanism, Pivots, Position, State, Structure, Terms,
};

static NAMED: Structure = Structure {
    weighed: &[0],
    ..structure(&[ANGLE, ANGLE, LENGTH], &[])
};

/// The mechanism without more, as [`Massless`] is, or with solves of its own in the metric
/// that its first row takes part in.
#[derive(Default)]
pub struct Massless {
    pub slider_crank: SliderCrank,
    pub solves: bool,
}

/// `x` of `M x + Aᵀλ = f`, `A x = b`, and the pivots, in the metric with this weight.
fn solved(
    at: &Position<f64, 3, 2>,
    weight: f64,
    (f, b): (&SVector<f64, 3>, &SVector<f64, 2>),
) -> (SVector<f64, 3>, Pivots<f64, 3, 2>) {
    let a = at.jacobian;
    let metric = at.mass + a.row(0).transpose() * a.row(0) * weight;
    let inverse: SMatrix<f64, 3, 3> = metric.try_inverse().unwrap_or_else(SMatrix::zeros);
    let gram: SMatrix<f64, 2, 2> = a * inverse * a.transpose();
    let multiplier = gram.try_inverse().unwrap_or_else(SMatrix::zeros) * (a * inverse * f - b);
    let lower = metric
        .cholesky()
        .map_or_else(SMatrix::zeros, |factor| factor.l());
    let last = gram[(1, 1)] - gram[(0, 1)] * gram[(0, 1)] / gram[(0, 0)];
    let pivots = Pivots {
        mass_pivots: lower.diagonal().map(|root| root * root),
        mass_diagonal: metric.diagonal(),
        row_pivots: [gram[(0, 0)], last].into(),
        row_squares: gram.diagonal(),
    };
    (inverse * (f - a.transpose() * multiplier), pivots)
}

impl Mechanism<f64, 3, 2> for Massless {
    fn structure(&self) -> &'static Structure {
        match self.solves {
            true => &NAMED,
            false => self.slider_crank.structure(),
        }
    }

    fn terms(&self, state: &State<f64, 3>, out: &mut Terms<f64, 3, 2>) {
        self.slider_crank.terms(state, out);
        out.mass[(2, 2)] = 0.0;
    }

    fn position(&self, state: &State<f64, 3>, out: &mut Position<f64, 3, 2>) {
        self.slider_crank.position(state, out);
        out.mass[(2, 2)] = 0.0;
    }

    fn energy(&self, state: &State<f64, 3>) -> Energy<f64> {
        self.slider_crank.energy(state)
    }

    fn acceleration(&self, state: &State<f64, 3>, out: &mut Acceleration<f64, 3, 2>) -> bool {
        let (mut at, mut terms) = (Position::default(), Terms::default());
        self.position(state, &mut at);
        self.terms(state, &mut terms);
        let right = (&terms.force, &terms.bias);
        (out.acceleration, out.pivots) = solved(&at, out.weights[0], right);
        self.solves
    }

    fn correction(&self, state: &State<f64, 3>, out: &mut Correction<f64, 3, 2>) -> bool {
        let mut at = Position::default();
        self.position(state, &mut at);
        let (weight, zero) = (out.weights[0], SVector::zeros());
        out.residual = at.residual;
        (out.position, out.pivots) = solved(&at, weight, (&zero, &-at.residual));
        let moved = State::new(state.t, state.q + out.position, state.v);
        self.position(&moved, &mut at);
        let speed = at.jacobian * state.v;
        out.velocity = solved(&at, weight, (&zero, &-speed)).0;
        self.solves
    }
}
