//! The double four-bar of the paper's second example.

use super::ByHand;
use super::sine::sin_cos;
use super::solve::solve;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{State, Terms};

const SHORT: f64 = 0.4;
const LONG: f64 = 0.7;
const G: f64 = 9.81;
/// A crank that carries a coupler: `m e² + J + m r²`.
const CRANK: f64 = 0.2 * 0.2 + 0.1 + SHORT * SHORT;
/// A crank alone.
const LAST: f64 = 0.2 * 0.2 + 0.1;
/// A coupler: `m e² + J`.
const COUPLER: f64 = 0.35 * 0.35 + 0.1;
/// `m r e`.
const COUPLED: f64 = SHORT * 0.35;
/// Weights of a crank with coupler, a coupler, the last crank.
const WEIGHTS: [f64; 3] = [G * (0.2 + SHORT), G * 0.35, G * 0.2];
const LENGTHS: [f64; 5] = [SHORT, LONG, SHORT, LONG, SHORT];
/// Rods of each loop, and how their ends count.
const LOOPS: [[usize; 3]; 2] = [[0, 1, 2], [2, 3, 4]];
const SIGNS: [f64; 3] = [1.0, 1.0, -1.0];

/// The mechanism.
pub struct DoubleFourBar;

/// What varies. The pairs of a crank and its coupler are coupled, nothing else is.
struct Varying {
    coupled: [f64; 2],
    /// Lengths times sines and cosines.
    sl: [f64; 5],
    cl: [f64; 5],
    p: [f64; 5],
}

#[inline(always)]
fn varying(q: &[f64; 5], v: &[f64; 5]) -> Varying {
    let (s, c) = sin_cos(*q);
    let mut p = [0.0; 5];
    let mut coupled = [0.0; 2];
    for pair in 0..2 {
        let (i, j) = (2 * pair, 2 * pair + 1);
        coupled[pair] = COUPLED * (s[i] * s[j] + c[i] * c[j]);
        let turned = COUPLED * (s[i] * c[j] - c[i] * s[j]);
        p[i] = -turned * v[j] * v[j] - WEIGHTS[0] * c[i];
        p[j] = turned * v[i] * v[i] - WEIGHTS[1] * c[j];
    }
    p[4] = -WEIGHTS[2] * c[4];
    Varying {
        coupled,
        sl: core::array::from_fn(|i| LENGTHS[i] * s[i]),
        cl: core::array::from_fn(|i| LENGTHS[i] * c[i]),
        p,
    }
}

impl Varying {
    /// The entries of `A` in the rows of a loop, at its three rods.
    #[inline(always)]
    fn rows(&self, which: usize) -> [[f64; 3]; 2] {
        let rods = LOOPS[which];
        [
            core::array::from_fn(|k| -SIGNS[k] * self.sl[rods[k]]),
            core::array::from_fn(|k| SIGNS[k] * self.cl[rods[k]]),
        ]
    }

    /// `p₂`.
    #[inline(always)]
    fn bias(&self, v: &[f64; 5]) -> [f64; 4] {
        let along = |which: usize, parts: &[f64; 5]| {
            let rods = LOOPS[which];
            (0..3).fold(0.0, |sum, k| {
                sum + SIGNS[k] * parts[rods[k]] * v[rods[k]] * v[rods[k]]
            })
        };
        [
            along(0, &self.cl),
            along(0, &self.sl),
            along(1, &self.cl),
            along(1, &self.sl),
        ]
    }

    /// `g`.
    #[inline(always)]
    fn gap(&self) -> [f64; 4] {
        let open = |which: usize, parts: &[f64; 5]| {
            (0..3).fold(0.0, |sum, k| sum + SIGNS[k] * parts[LOOPS[which][k]])
        };
        [
            open(0, &self.cl) - LONG,
            open(0, &self.sl),
            open(1, &self.cl) - LONG,
            open(1, &self.sl),
        ]
    }

    /// `M⁻¹` on each pair of a crank and its coupler.
    #[inline(always)]
    fn inverse(&self) -> [[f64; 3]; 2] {
        self.coupled.map(|m12| {
            let over = 1.0 / (CRANK * COUPLER - m12 * m12);
            [COUPLER * over, -m12 * over, CRANK * over]
        })
    }
}

#[inline(always)]
fn times(inverse: &[[f64; 3]; 2], x: &[f64; 5]) -> [f64; 5] {
    let mut y = [0.0; 5];
    for (pair, [i11, i12, i22]) in inverse.iter().enumerate() {
        let (i, j) = (2 * pair, 2 * pair + 1);
        y[i] = i11 * x[i] + i12 * x[j];
        y[j] = i12 * x[i] + i22 * x[j];
    }
    y[4] = x[4] / LAST;
    y
}

/// `S = A M⁻¹ Aᵀ` (lower triangle). Rods 0 and 1 meet the first loop only, rods 3 and 4
/// the second; rod 2 belongs to both, and is coupled with rod 3.
#[inline(always)]
fn schur(rows: &[[[f64; 3]; 2]; 2], inverse: &[[f64; 3]; 2]) -> [[f64; 4]; 4] {
    let mut s = [[0.0; 4]; 4];
    let [first, second] = inverse;
    let [a, b] = rows;
    for i in 0..2 {
        let along = [
            first[0] * a[i][0] + first[1] * a[i][1],
            first[1] * a[i][0] + first[2] * a[i][1],
            second[0] * a[i][2],
        ];
        let crossed = second[1] * a[i][2];
        let other = [
            second[0] * b[i][0] + second[1] * b[i][1],
            second[1] * b[i][0] + second[2] * b[i][1],
            b[i][2] / LAST,
        ];
        for j in 0..=i {
            s[i][j] = along[0] * a[j][0] + along[1] * a[j][1] + along[2] * a[j][2];
            s[2 + i][2 + j] = other[0] * b[j][0] + other[1] * b[j][1] + other[2] * b[j][2];
        }
        for j in 0..2 {
            s[2 + j][i] = along[2] * b[j][0] + crossed * b[j][1];
        }
    }
    s
}

/// `M⁻¹ Aᵀ l`.
#[inline(always)]
fn lifted(rows: &[[[f64; 3]; 2]; 2], inverse: &[[f64; 3]; 2], l: &[f64; 4]) -> [f64; 5] {
    let [a, b] = rows;
    let mut x = [0.0; 5];
    for k in 0..3 {
        x[k] = a[0][k] * l[0] + a[1][k] * l[1];
    }
    for k in 0..3 {
        x[2 + k] += b[0][k] * l[2] + b[1][k] * l[3];
    }
    times(inverse, &x)
}

#[inline(always)]
fn along(rows: &[[[f64; 3]; 2]; 2], x: &[f64; 5]) -> [f64; 4] {
    let row = |which: usize, i: usize| {
        let a = &rows[which][i];
        a[0] * x[2 * which] + a[1] * x[2 * which + 1] + a[2] * x[2 * which + 2]
    };
    [row(0, 0), row(0, 1), row(1, 0), row(1, 1)]
}

impl ByHand<5, 4> for DoubleFourBar {
    #[inline(always)]
    fn terms(&self, state: &State<f64, 5>, out: &mut Terms<f64, 5, 4>) {
        let x = varying(state.q.as_ref(), state.v.as_ref());
        for pair in 0..2 {
            let (i, j) = (2 * pair, 2 * pair + 1);
            out.mass[(i, i)] = CRANK;
            out.mass[(j, j)] = COUPLER;
            out.mass[(i, j)] = x.coupled[pair];
            out.mass[(j, i)] = x.coupled[pair];
            let rows = x.rows(pair);
            for k in 0..3 {
                out.jacobian[(i, LOOPS[pair][k])] = rows[0][k];
                out.jacobian[(j, LOOPS[pair][k])] = rows[1][k];
            }
        }
        out.mass[(4, 4)] = LAST;
        out.force = x.p.into();
        out.bias = x.bias(state.v.as_ref()).into();
    }

    #[inline(always)]
    fn residual(&self, state: &State<f64, 5>) -> SVector<f64, 4> {
        varying(state.q.as_ref(), state.v.as_ref()).gap().into()
    }

    #[inline(always)]
    fn acceleration(&self, state: &State<f64, 5>) -> SVector<f64, 5> {
        let x = varying(state.q.as_ref(), state.v.as_ref());
        let (rows, inverse) = ([x.rows(0), x.rows(1)], x.inverse());
        let mut s = schur(&rows, &inverse);
        let free = times(&inverse, &x.p);
        let (had, wanted) = (along(&rows, &free), x.bias(state.v.as_ref()));
        let mut l = [core::array::from_fn(|i| wanted[i] - had[i])];
        solve(&mut s, &mut l);
        SVector::from(free) + SVector::from(lifted(&rows, &inverse, &l[0]))
    }

    #[inline(always)]
    fn correction(&self, state: &State<f64, 5>) -> (SVector<f64, 5>, SVector<f64, 5>) {
        let x = varying(state.q.as_ref(), state.v.as_ref());
        let (rows, inverse) = ([x.rows(0), x.rows(1)], x.inverse());
        let mut s = schur(&rows, &inverse);
        let mut l = [x.gap(), along(&rows, state.v.as_ref())];
        solve(&mut s, &mut l);
        (
            -SVector::from(lifted(&rows, &inverse, &l[0])),
            -SVector::from(lifted(&rows, &inverse, &l[1])),
        )
    }
}
