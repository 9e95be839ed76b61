//! Coefficients of the implicit methods: Radau IIA with three or five stages.
//!
//! In:  the number of stages.
//! Out: nodes, matrix, and its eigenvalues with left and right eigenvectors, in
//!      the precision of the scalar.
//!
//! Nodes and eigenvalues are roots of polynomials with known coefficients: Newton's
//! method brings their first 16 digits to the precision of the scalar. All else follows
//! in formulas without cancellation.
//!
//! Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996),
//! sections IV.5 and IV.8.

use super::lu::Lu;
use crate::Real;
use nalgebra::Complex;

/// Pairs of complex eigenvalues that the largest method has.
pub(super) const MOST_PAIRS: usize = 2;

/// Corrections of a root that has 16 digits: enough for 106 bits and one to spare.
const CORRECTIONS: usize = 3;

/// What tells one method from another: the first digits of its nodes but for the last,
/// which is one, and of the eigenvalues of its matrix, one of each complex pair.
pub(super) struct Digits {
    pub(super) nodes: &'static [f64],
    real: f64,
    pairs: &'static [(f64, f64)],
}

pub(super) const THREE: Digits = Digits {
    nodes: &[0.1550510257216822, 0.6449489742783178],
    real: 0.27488882959567734,
    pairs: &[(0.16255558520216132, 0.1849493244071408)],
};

pub(super) const FIVE: Digits = Digits {
    nodes: &[
        0.05710419611451768,
        0.2768430136381238,
        0.5835904323689168,
        0.8602401356562195,
    ],
    real: 0.15906584442746913,
    pairs: &[
        (0.1331790770182996, 0.07499451183581853),
        (0.06506577854574362, 0.11646852774031707),
    ],
};

/// Radau IIA with `S` stages, of order `2S − 1`; `S` is three or five.
#[derive(Clone, Debug)]
pub(super) struct Collocation<T, const S: usize> {
    /// `c_i`.
    pub(super) nodes: [T; S],
    /// `A`, as rows.
    pub(super) matrix: [[T; S]; S],
    /// `A²`, as rows.
    pub(super) square: [[T; S]; S],
    /// What the polynomial through values at the nodes has at the start of the step,
    /// as weights of the values.
    pub(super) start: [T; S],
    /// The real eigenvalue of `A`.
    pub(super) real: Eigen<T, S>,
    /// One eigenvalue of each complex pair; of the entries, `pairs` are in use.
    pub(super) complex: [Eigen<Complex<T>, S>; MOST_PAIRS],
    /// Number of complex pairs.
    pub(super) pairs: usize,
}

/// An eigenvalue with its vectors, `left · right = 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eigen<F, const S: usize> {
    pub(super) value: F,
    pub(super) left: [F; S],
    pub(super) right: [F; S],
}

impl<T: Real, const S: usize> Collocation<T, S> {
    pub(super) fn new() -> Self {
        let digits = if S == 3 { &THREE } else { &FIVE };
        let nodes = core::array::from_fn(|i| digits.nodes.get(i).map_or(T::one(), |x| node(*x, S)));
        let weights: [T; S] = nodes.map(|c| {
            // The quadrature of the method (Radau's, of degree 2S − 2).
            let n = T::from_f64(S as f64);
            let (_, value) = legendre(c, S);
            c / (n * n * value * value)
        });
        let matrix: [[T; S]; S] = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                (0..S).fold(T::zero(), |sum, k| {
                    let inside = cardinal(&nodes, j, nodes[i] * nodes[k]);
                    sum + nodes[i] * weights[k] * inside
                })
            })
        });
        let square = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                (0..S).fold(T::zero(), |sum, k| sum + matrix[i][k] * matrix[k][j])
            })
        });
        let (real, complex) = eigen(&nodes, digits);
        Self {
            start: core::array::from_fn(|i| cardinal(&nodes, i, T::zero())),
            nodes,
            matrix,
            square,
            real,
            complex,
            pairs: digits.pairs.len(),
        }
    }
}

/// The polynomial that is one at node `j` and zero at the others, at `x`.
pub(super) fn cardinal<T: Real>(nodes: &[T], j: usize, x: T) -> T {
    let others = nodes.iter().enumerate().filter(|(k, _)| *k != j);
    others.fold(T::one(), |product, (_, node)| {
        product * (x - *node) / (nodes[j] - *node)
    })
}

/// Legendre's polynomials of degrees `s` and `s − 1`, moved to 0 … 1, at `c`.
fn legendre<T: Real>(c: T, s: usize) -> (T, T) {
    let x = c + c - T::one();
    let (mut value, mut before) = (T::one(), T::zero());
    for n in 0..s {
        let n = T::from_f64(n as f64);
        let next = ((n + n + T::one()) * x * value - n * before) / (n + T::one());
        (value, before) = (next, value);
    }
    (value, before)
}

/// A node: a zero of `P_s − P_{s−1}`.
fn node<T: Real>(digits: f64, s: usize) -> T {
    let mut c = T::from_f64(digits);
    let n = T::from_f64(s as f64);
    for _ in 0..CORRECTIONS {
        let (value, before) = legendre(c, s);
        let (_, second) = legendre(c, s - 1);
        // (x² − 1) Pₙ' = n (x Pₙ − Pₙ₋₁), and x' = 2.
        let x = c + c - T::one();
        let below = x * x - T::one();
        let slope =
            n * (x * value - before) / below - (n - T::one()) * (x * before - second) / below;
        c -= (value - before) / (slope + slope);
    }
    c
}

/// The eigenvalues of `A` and their vectors.
///
/// `A` integrates polynomials of degree `S − 1` from zero. With `M(x) = Π(x − c_i)` of
/// coefficients `m_k`, an eigenvector is a polynomial with `λp − ∫p = M` times a
/// constant, which it is if `Σ k! m_k λᵏ = 0`; its coefficients follow downwards.
fn eigen<T: Real, const S: usize>(
    nodes: &[T; S],
    digits: &Digits,
) -> (Eigen<T, S>, [Eigen<Complex<T>, S>; MOST_PAIRS]) {
    let (lowest, scaled) = characteristic(nodes);
    let complex = |re: f64, im: f64| Complex::new(T::from_f64(re), T::from_f64(im));
    let mut values = [complex(digits.real, 0.0); S];
    for (i, (re, im)) in digits.pairs.iter().enumerate() {
        (values[2 * i + 1], values[2 * i + 2]) = (complex(*re, *im), complex(*re, -*im));
    }
    let values = values.map(|value| root(lowest, &scaled, value));
    let vectors = values.map(|value| vector(nodes, &scaled, value));
    let left = |k: usize| {
        let one = |i| if i == k { T::one() } else { T::zero() };
        let unit = core::array::from_fn(|i| Complex::new(one(i), T::zero()));
        // Eigenvectors to different eigenvalues are independent.
        Lu::new::<T>(vectors).map_or(unit, |lu| lu.solve::<T>(&unit))
    };
    let pair = |k: usize| Eigen {
        value: values[k],
        left: left(k),
        right: vectors[k],
    };
    let real = Eigen {
        value: values[0].re,
        left: left(0).map(|x| x.re),
        right: vectors[0].map(|x| x.re),
    };
    (real, core::array::from_fn(|i| pair((2 * i + 1).min(S - 1))))
}

/// `k! m_k` for k = 0, and for k = 1 … S.
fn characteristic<T: Real, const S: usize>(nodes: &[T; S]) -> (T, [T; S]) {
    let (mut lowest, mut others) = (T::one(), [T::zero(); S]);
    for (degree, node) in nodes.iter().enumerate() {
        // Times x − node: every coefficient moves up by one.
        for k in (0..=degree).rev() {
            let below = if k == 0 { lowest } else { others[k - 1] };
            others[k] = below - *node * others[k];
        }
        lowest = -(*node * lowest);
    }
    let mut factorial = T::one();
    for (k, entry) in others.iter_mut().enumerate() {
        factorial *= T::from_f64((k + 1) as f64);
        *entry *= factorial;
    }
    (lowest, others)
}

/// A root of the polynomial with these coefficients.
fn root<T: Real, const S: usize>(lowest: T, others: &[T; S], digits: Complex<T>) -> Complex<T> {
    let mut x = digits;
    for _ in 0..CORRECTIONS {
        let (mut value, mut slope) = (
            Complex::new(T::zero(), T::zero()),
            Complex::new(T::zero(), T::zero()),
        );
        for entry in others.iter().rev() {
            slope = slope * x + value;
            value = value * x + Complex::new(*entry, T::zero());
        }
        slope = slope * x + value;
        value = value * x + Complex::new(lowest, T::zero());
        x -= value / slope;
    }
    x
}

/// The right eigenvector: values of the polynomial at the nodes.
fn vector<T: Real, const S: usize>(
    nodes: &[T; S],
    scaled: &[T; S],
    value: Complex<T>,
) -> [Complex<T>; S] {
    // k! p_k, from the highest down.
    let mut above = Complex::new(-scaled[S - 1], T::zero());
    let mut coefficients = [above; S];
    for k in (0..S - 1).rev() {
        above = value * above - Complex::new(scaled[k], T::zero());
        coefficients[k] = above;
    }
    nodes.map(|node| {
        let zero = Complex::new(T::zero(), T::zero());
        (0..S).rev().fold(zero, |sum, k| {
            sum * node / T::from_f64((k + 1) as f64) + coefficients[k]
        })
    })
}
