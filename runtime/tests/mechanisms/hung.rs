//! A double four-bar with a pendulum hung on its first coupler: two degrees of
//! freedom, of which one does not care about the singular position.

use super::{ANGLE, FourBars, GRAVITY, Passing, structure};
use bricard_runtime::nalgebra::SMatrix;
use bricard_runtime::{Energy, Mechanism, Position, State, Structure, Terms};

/// The double four-bar and the pendulum: coordinates `θ₀, φ₁, θ₁, φ₂, θ₂, ψ`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hung;

/// The motion of [`Hung`] in `θ` and `ψ`, without constraints.
#[derive(Clone, Copy, Debug, Default)]
pub struct HungReduced;

const CRANK: f64 = 0.4;
const PLACE: f64 = 0.25;
const ROPE: f64 = 0.3;
const MASS: f64 = 0.6;

static HUNG: Structure = structure(&[ANGLE; 6], &[]);
static REDUCED: Structure = structure(&[ANGLE; 2], &[]);

/// Adds a point mass at the end of a chain of links `(coordinate, length)`.
fn add_chain<const N: usize>(
    state: &State<f64, N>,
    chain: &[(usize, f64)],
    mass: &mut SMatrix<f64, N, N>,
    force: &mut SMatrix<f64, N, 1>,
) {
    for &(i, a) in chain {
        force[i] -= MASS * GRAVITY * a * state.q[i].cos();
        for &(j, b) in chain {
            let (sine, cosine) = (state.q[i] - state.q[j]).sin_cos();
            mass[(i, j)] += MASS * a * b * cosine;
            force[i] -= MASS * a * b * sine * state.v[j] * state.v[j];
        }
    }
}

const CHAIN: [(usize, f64); 3] = [(0, CRANK), (1, PLACE), (5, ROPE)];

impl Hung {
    /// The full state that belongs to a reduced one.
    pub fn state(reduced: &State<f64, 2>) -> State<f64, 6> {
        let (q, v) = (&reduced.q, &reduced.v);
        State::new(
            reduced.t,
            [q[0], 0.0, q[0], 0.0, q[0], q[1]].into(),
            [v[0], 0.0, v[0], 0.0, v[0], v[1]].into(),
        )
    }

    fn loops(state: &State<f64, 6>) -> State<f64, 5> {
        State::new(
            state.t,
            state.q.fixed_rows::<5>(0).into_owned(),
            state.v.fixed_rows::<5>(0).into_owned(),
        )
    }
}

impl Mechanism<f64, 6, 4> for Hung {
    fn structure(&self) -> &'static Structure {
        &HUNG
    }

    fn terms(&self, state: &State<f64, 6>, out: &mut Terms<f64, 6, 4>) {
        let mut loops: Terms<f64, 5, 4> = Terms::default();
        FourBars.terms(&Self::loops(state), &mut loops);
        out.mass = SMatrix::zeros();
        out.mass.fixed_view_mut::<5, 5>(0, 0).copy_from(&loops.mass);
        out.force = SMatrix::zeros();
        out.force.fixed_rows_mut::<5>(0).copy_from(&loops.force);
        add_chain(state, &CHAIN, &mut out.mass, &mut out.force);
        out.jacobian
            .fixed_columns_mut::<5>(0)
            .copy_from(&loops.jacobian);
        out.bias = loops.bias;
    }

    fn position(&self, state: &State<f64, 6>, out: &mut Position<f64, 6, 4>) {
        let mut terms = Terms::default();
        self.terms(state, &mut terms);
        let mut loops: Position<f64, 5, 4> = Position::default();
        FourBars.position(&Self::loops(state), &mut loops);
        (out.mass, out.jacobian) = (terms.mass, terms.jacobian);
        out.residual = loops.residual;
    }

    fn energy(&self, _state: &State<f64, 6>) -> Energy<f64> {
        Energy::default()
    }
}

impl Mechanism<f64, 2, 0> for HungReduced {
    fn structure(&self) -> &'static Structure {
        &REDUCED
    }

    fn terms(&self, state: &State<f64, 2>, out: &mut Terms<f64, 2, 0>) {
        let reduction = Passing::<5, 4>::reduction(&FourBars);
        out.mass = SMatrix::zeros();
        out.mass[(0, 0)] = reduction.constant;
        out.force = [-reduction.weight * state.q[0].cos(), 0.0].into();
        let chain = [(0, CRANK), (1, ROPE)];
        add_chain(state, &chain, &mut out.mass, &mut out.force);
    }

    fn energy(&self, _state: &State<f64, 2>) -> Energy<f64> {
        Energy::default()
    }
}
