//! The slider–crank of the paper's first example.

use super::ByHand;
use super::sine::sin_cos;
use bricard_runtime::nalgebra::{SVector, Vector3};
use bricard_runtime::{State, Terms};

const L: f64 = 0.5;
const E: f64 = 0.25;
const G: f64 = 9.81;
/// `m₁e₁² + J₁ + m₂L₁²`.
const M11: f64 = E * E + 0.1 + L * L;
/// `m₂e₂² + J₂`.
const M22: f64 = E * E + 0.1;
const M33: f64 = 0.5;
/// `m₂L₁e₂`.
const COUPLED: f64 = L * E;
const WEIGHT1: f64 = G * (E + L);
const WEIGHT2: f64 = G * E;

/// The mechanism.
pub struct SliderCrank;

/// What varies.
struct Varying {
    m12: f64,
    /// `A` without its constant entry −1 in the first row.
    a: [[f64; 2]; 2],
    p: [f64; 2],
    bias: [f64; 2],
    cosines: [f64; 2],
}

#[inline(always)]
fn varying(q: [f64; 2], v: [f64; 2]) -> Varying {
    let (s, c) = sin_cos(q);
    let squares = [v[0] * v[0], v[1] * v[1]];
    let mixed = COUPLED * (s[0] * c[1] + c[0] * s[1]);
    let [sl, cl] = [[L * s[0], L * s[1]], [L * c[0], L * c[1]]];
    Varying {
        m12: COUPLED * (s[0] * s[1] - c[0] * c[1]),
        a: [[-sl[0], -sl[1]], [cl[0], -cl[1]]],
        p: [
            -mixed * squares[1] - WEIGHT1 * c[0],
            -mixed * squares[0] + WEIGHT2 * c[1],
        ],
        bias: [
            cl[0] * squares[0] + cl[1] * squares[1],
            sl[0] * squares[0] - sl[1] * squares[1],
        ],
        cosines: cl,
    }
}

/// `M⁻¹` on the first two coordinates.
#[inline(always)]
fn inverse(m12: f64) -> [f64; 3] {
    let over = 1.0 / (M11 * M22 - m12 * m12);
    [M22 * over, -m12 * over, M11 * over]
}

#[inline(always)]
fn times([i11, i12, i22]: [f64; 3], x: [f64; 2]) -> [f64; 2] {
    [i11 * x[0] + i12 * x[1], i12 * x[0] + i22 * x[1]]
}

/// `M⁻¹Aᵀ` and `S = A M⁻¹ Aᵀ` (its three entries), but for what the slider adds.
#[inline(always)]
fn schur(terms: &Varying, inverse: [f64; 3]) -> ([[f64; 2]; 2], [f64; 3]) {
    let [a1, a2] = terms.a;
    let (b1, b2) = (times(inverse, a1), times(inverse, a2));
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    (
        [b1, b2],
        [dot(a1, b1) + 1.0 / M33, dot(a2, b1), dot(a2, b2)],
    )
}

#[inline(always)]
fn multipliers([s11, s12, s22]: [f64; 3], x: [f64; 2]) -> [f64; 2] {
    let over = 1.0 / (s11 * s22 - s12 * s12);
    [
        over * (s22 * x[0] - s12 * x[1]),
        over * (s11 * x[1] - s12 * x[0]),
    ]
}

#[inline(always)]
fn lifted(b: [[f64; 2]; 2], l: [f64; 2]) -> Vector3<f64> {
    Vector3::new(
        b[0][0] * l[0] + b[1][0] * l[1],
        b[0][1] * l[0] + b[1][1] * l[1],
        -l[0] / M33,
    )
}

impl ByHand<3, 2> for SliderCrank {
    #[inline(always)]
    fn terms(&self, state: &State<f64, 3>, out: &mut Terms<f64, 3, 2>) {
        let x = varying([state.q[0], state.q[1]], [state.v[0], state.v[1]]);
        out.mass[(0, 0)] = M11;
        out.mass[(1, 0)] = x.m12;
        out.mass[(0, 1)] = x.m12;
        out.mass[(1, 1)] = M22;
        out.mass[(2, 2)] = M33;
        out.force[0] = x.p[0];
        out.force[1] = x.p[1];
        for i in 0..2 {
            out.jacobian[(i, 0)] = x.a[i][0];
            out.jacobian[(i, 1)] = x.a[i][1];
            out.bias[i] = x.bias[i];
        }
        out.jacobian[(0, 2)] = -1.0;
    }

    #[inline(always)]
    fn residual(&self, state: &State<f64, 3>) -> SVector<f64, 2> {
        let (s, c) = sin_cos([state.q[0], state.q[1]]);
        [L * (c[0] + c[1]) - state.q[2], L * (s[0] - s[1])].into()
    }

    #[inline(always)]
    fn acceleration(&self, state: &State<f64, 3>) -> SVector<f64, 3> {
        let x = varying([state.q[0], state.q[1]], [state.v[0], state.v[1]]);
        let inverse = inverse(x.m12);
        let free = times(inverse, x.p);
        let (b, s) = schur(&x, inverse);
        let missing = |i: usize| x.bias[i] - x.a[i][0] * free[0] - x.a[i][1] * free[1];
        let l = multipliers(s, [missing(0), missing(1)]);
        Vector3::new(free[0], free[1], 0.0) + lifted(b, l)
    }

    #[inline(always)]
    fn correction(&self, state: &State<f64, 3>) -> (SVector<f64, 3>, SVector<f64, 3>) {
        let v = [state.v[0], state.v[1]];
        let x = varying([state.q[0], state.q[1]], v);
        let (b, s) = schur(&x, inverse(x.m12));
        let open = [
            x.cosines[0] + x.cosines[1] - state.q[2],
            x.a[0][1] - x.a[0][0],
        ];
        let rate = |i: usize| x.a[i][0] * v[0] + x.a[i][1] * v[1];
        let rates = [rate(0) - state.v[2], rate(1)];
        (
            -lifted(b, multipliers(s, open)),
            -lifted(b, multipliers(s, rates)),
        )
    }
}
