//! Several of one mechanism side by side: each moves as it would alone.

use super::{ANGLE, LENGTH, SliderCrank, structure};
use bricard_runtime::nalgebra::SMatrix;
use bricard_runtime::{Energy, Mechanism, Position, State, Structure, Terms};

/// How many there are.
pub const COUNT: usize = 4;
const N: usize = 3;
const R: usize = 2;
const ALL_N: usize = COUNT * N;
const ALL_R: usize = COUNT * R;

static SIDE: Structure = structure(
    &[
        ANGLE, ANGLE, LENGTH, ANGLE, ANGLE, LENGTH, ANGLE, ANGLE, LENGTH, ANGLE, ANGLE, LENGTH,
    ],
    &[],
);

/// Slider–cranks that have nothing to do with each other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Side;

impl Side {
    /// The state of all.
    pub fn state(each: [State<f64, N>; COUNT]) -> State<f64, ALL_N> {
        let mut state: State<f64, ALL_N> = State::default();
        for (k, one) in each.iter().enumerate() {
            state.q.fixed_rows_mut::<N>(k * N).copy_from(&one.q);
            state.v.fixed_rows_mut::<N>(k * N).copy_from(&one.v);
        }
        state
    }

    fn one(state: &State<f64, ALL_N>, k: usize) -> State<f64, N> {
        let part = |x: &SMatrix<f64, ALL_N, 1>| x.fixed_rows::<N>(k * N).into_owned();
        State::new(state.t, part(&state.q), part(&state.v))
    }
}

/// Puts a matrix of the `k`-th into that of all.
fn put<const A: usize, const B: usize, const C: usize, const D: usize>(
    all: &mut SMatrix<f64, C, D>,
    one: &SMatrix<f64, A, B>,
    k: usize,
) {
    let column = if D == 1 { 0 } else { k * B };
    all.fixed_view_mut::<A, B>(k * A, column).copy_from(one);
}

impl Mechanism<f64, ALL_N, ALL_R> for Side {
    fn structure(&self) -> &'static Structure {
        &SIDE
    }

    fn terms(&self, state: &State<f64, ALL_N>, out: &mut Terms<f64, ALL_N, ALL_R>) {
        *out = Terms::default();
        for k in 0..COUNT {
            let mut one: Terms<f64, N, R> = Terms::default();
            SliderCrank::default().terms(&Self::one(state, k), &mut one);
            put(&mut out.mass, &one.mass, k);
            put(&mut out.jacobian, &one.jacobian, k);
            put(&mut out.force, &one.force, k);
            put(&mut out.bias, &one.bias, k);
        }
    }

    fn position(&self, state: &State<f64, ALL_N>, out: &mut Position<f64, ALL_N, ALL_R>) {
        *out = Position::default();
        for k in 0..COUNT {
            let mut one: Position<f64, N, R> = Position::default();
            SliderCrank::default().position(&Self::one(state, k), &mut one);
            put(&mut out.mass, &one.mass, k);
            put(&mut out.jacobian, &one.jacobian, k);
            put(&mut out.residual, &one.residual, k);
            put(&mut out.drift, &one.drift, k);
        }
    }

    fn energy(&self, _state: &State<f64, ALL_N>) -> Energy<f64> {
        Energy::default()
    }
}
