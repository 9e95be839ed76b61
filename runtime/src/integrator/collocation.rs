//! Coefficients of the implicit methods: Radau IIA with three or five stages.
//!
//! In:  the first digits of the method.
//! Out: nodes, matrix, and its eigenvalues with left and right eigenvectors, in
//!      the precision of the scalar.
//!
//! Nodes and eigenvalues are roots of polynomials with known coefficients: Newton's
//! method brings their first 16 digits to the precision of the scalar. All else follows
//! in formulas without cancellation.
//!
//! Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996),
//! sections IV.5 and IV.8.

use super::lu::{factorise, solve};
use crate::Real;
use crate::linalg::column;
use crate::once::compiled_once;
use nalgebra::Complex;

/// Stages that the largest method has.
pub(super) const MOST_STAGES: usize = 5;
/// Pairs of complex eigenvalues that the largest method has.
pub(super) const MOST_PAIRS: usize = 2;

/// Corrections of a root that has 16 digits: enough for 106 bits and one to spare.
const CORRECTIONS: usize = 3;

/// What tells one method from another: the first digits of its nodes but for the last,
/// which is one, and of the eigenvalues of its matrix, one of each complex pair.
pub(crate) struct Digits {
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

/// Radau IIA of order `2s − 1` with `s` stages, three or five; of lists with room for
/// more, the first `s` entries are in use.
#[derive(Clone, Debug)]
pub(crate) struct Collocation<T> {
    /// `s`.
    pub(super) stages: usize,
    /// `c_i`.
    pub(super) nodes: [T; MOST_STAGES],
    /// `A`, as rows.
    pub(super) matrix: [[T; MOST_STAGES]; MOST_STAGES],
    /// `A²`, as rows.
    pub(super) square: [[T; MOST_STAGES]; MOST_STAGES],
    /// What the polynomial through values at the nodes has at the start of the step,
    /// as weights of the values.
    pub(super) start: [T; MOST_STAGES],
    /// The real eigenvalue of `A`.
    pub(super) real: Eigen<T>,
    /// One eigenvalue of each complex pair; of the entries, `pairs` are in use.
    pub(super) complex: [Eigen<Complex<T>>; MOST_PAIRS],
    /// Number of complex pairs.
    pub(super) pairs: usize,
}

/// An eigenvalue with its vectors, `left · right = 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eigen<F> {
    pub(super) value: F,
    pub(super) left: [F; MOST_STAGES],
    pub(super) right: [F; MOST_STAGES],
}

impl<T: Real> Collocation<T> {
    #[inline(never)]
    pub(crate) fn new(digits: &Digits) -> Self {
        let stages = digits.nodes.len() + 1;
        let zero = [T::zero(); MOST_STAGES];
        let mut nodes = [T::one(); MOST_STAGES];
        for (place, first) in nodes.iter_mut().zip(digits.nodes) {
            *place = node(*first, stages);
        }
        let mut start = zero;
        let mut matrix = [zero; MOST_STAGES];
        let used = &nodes[..stages];
        for j in 0..stages {
            start[j] = cardinal(used, j, T::zero());
            for (row, node) in matrix.iter_mut().zip(used) {
                for other in used {
                    let inside = cardinal(used, j, *node * *other);
                    row[j] += *node * weight(*other, stages) * inside;
                }
            }
        }
        let mut square = [zero; MOST_STAGES];
        for (square, row) in square.iter_mut().zip(&matrix) {
            for (share, other) in row.iter().zip(&matrix) {
                for (entry, other) in square.iter_mut().zip(other) {
                    *entry += *share * *other;
                }
            }
        }
        let (real, complex) = eigen(used, digits);
        Self {
            stages,
            nodes,
            matrix,
            square,
            start,
            real,
            complex,
            pairs: digits.pairs.len(),
        }
    }
}

/// The polynomial that is one at node `j` and zero at the others, at `x`.
#[inline(never)]
pub(super) fn cardinal<T: Real>(nodes: &[T], j: usize, x: T) -> T {
    product(nodes, j, x)
}

/// [`cardinal`] where the compiler knows the number of nodes.
#[inline(always)]
pub(super) fn product<T: Real>(nodes: &[T], j: usize, x: T) -> T {
    let mut product = T::one();
    for k in 0..nodes.len() {
        if k != j {
            product = product * (x - nodes[k]) / (nodes[j] - nodes[k]);
        }
    }
    product
}

/// The vectors of `S` stages, which are one after the other.
#[inline(always)]
pub(super) fn by_stage<T, const S: usize>(mut vectors: &[T], n: usize) -> [&[T]; S] {
    let mut stages: [&[T]; S] = [&[]; S];
    for stage in &mut stages {
        (*stage, vectors) = vectors.split_at(n);
    }
    stages
}

/// `before`, and the sum of one component of the vectors with the first `S` weights.
#[inline(always)]
pub(super) fn weigh<T: Real, const S: usize>(
    weights: &[T; MOST_STAGES],
    components: &[T; S],
    before: T,
) -> T {
    let pairs = weights.iter().zip(components);
    pairs.fold(before, |sum, (weight, component)| {
        weight.mul_add(*component, sum)
    })
}

/// The weight of a node in the quadrature of the method (Radau's, of degree 2s − 2).
fn weight<T: Real>(c: T, s: usize) -> T {
    let n = T::from_f64(s as f64);
    let (_, value) = legendre(c, s);
    c / (n * n * value * value)
}

/// Legendre's polynomials of degrees `s` and `s − 1`, moved to 0 … 1, at `c`.
#[inline(never)]
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
/// `A` integrates polynomials of degree `s − 1` from zero. With `M(x) = Π(x − c_i)` of
/// coefficients `m_k`, an eigenvector is a polynomial with `λp − ∫p = M` times a
/// constant, which it is if `Σ k! m_k λᵏ = 0`; its coefficients follow downwards.
#[inline(never)]
fn eigen<T: Real>(nodes: &[T], digits: &Digits) -> (Eigen<T>, [Eigen<Complex<T>>; MOST_PAIRS]) {
    let s = nodes.len();
    let scaled = &characteristic(nodes)[..=s];
    let number = |re: f64, im: f64| Complex::new(T::from_f64(re), T::from_f64(im));
    let mut values = [number(digits.real, 0.0); MOST_STAGES];
    for (i, (re, im)) in digits.pairs.iter().enumerate() {
        (values[2 * i + 1], values[2 * i + 2]) = (number(*re, *im), number(*re, -*im));
    }
    let mut vectors = [number(0.0, 0.0); MOST_STAGES * MOST_STAGES];
    let vectors = &mut vectors[..s * s];
    for (value, vector) in values.iter_mut().zip(vectors.chunks_exact_mut(s)) {
        *value = root(scaled, *value);
        eigenvector(nodes, scaled, *value, vector);
    }
    let mut factors = [number(0.0, 0.0); MOST_STAGES * MOST_STAGES];
    let factors = &mut factors[..s * s];
    factors.copy_from_slice(vectors);
    let (mut order, mut sizes) = ([0; MOST_STAGES], [T::zero(); MOST_STAGES]);
    let order = &mut order[..s];
    // Eigenvectors to different eigenvalues are independent.
    let _regular = factorise(factors, order, &mut sizes[..s]);
    let of_value = |k: usize| {
        let mut unit = [number(0.0, 0.0); MOST_STAGES];
        unit[k] = number(1.0, 0.0);
        let (mut left, mut right) = (unit, unit);
        solve::<T, _>(factors, order, &unit[..s], &mut left[..s]);
        right[..s].copy_from_slice(&vectors[k * s..(k + 1) * s]);
        Eigen {
            value: values[k],
            left,
            right,
        }
    };
    let real = of_value(0);
    let real = Eigen {
        value: real.value.re,
        left: column(|i| real.left[i].re),
        right: column(|i| real.right[i].re),
    };
    // There are no more than `s` values; what is not in use may be any of them.
    (real, [of_value(1), of_value(3.min(s - 1))])
}

/// `k! m_k` for k = 0 … s.
fn characteristic<T: Real>(nodes: &[T]) -> [T; MOST_STAGES + 1] {
    let mut coefficients = [T::zero(); MOST_STAGES + 1];
    coefficients[0] = T::one();
    for (degree, node) in nodes.iter().enumerate() {
        // Times x − node: every coefficient moves up by one.
        for k in (0..=degree).rev() {
            coefficients[k + 1] = coefficients[k] - *node * coefficients[k + 1];
        }
        coefficients[0] = -(*node * coefficients[0]);
    }
    let mut factorial = T::one();
    for (k, entry) in coefficients.iter_mut().enumerate().skip(1) {
        factorial *= T::from_f64(k as f64);
        *entry *= factorial;
    }
    coefficients
}

/// A root of the polynomial with these coefficients.
#[inline(never)]
fn root<T: Real>(coefficients: &[T], digits: Complex<T>) -> Complex<T> {
    let mut x = digits;
    for _ in 0..CORRECTIONS {
        let zero = Complex::new(T::zero(), T::zero());
        let (mut value, mut slope) = (zero, zero);
        for entry in coefficients.iter().rev() {
            slope = slope * x + value;
            value = value * x + Complex::new(*entry, T::zero());
        }
        x -= value / slope;
    }
    x
}

/// The right eigenvector: values of the polynomial at the nodes.
#[inline(never)]
fn eigenvector<T: Real>(nodes: &[T], scaled: &[T], value: Complex<T>, out: &mut [Complex<T>]) {
    let s = nodes.len();
    // k! p_k, from the highest down.
    let mut above = Complex::new(-scaled[s], T::zero());
    let mut coefficients = [above; MOST_STAGES];
    for k in (0..s - 1).rev() {
        above = value * above - Complex::new(scaled[k + 1], T::zero());
        coefficients[k] = above;
    }
    for (entry, node) in out.iter_mut().zip(nodes) {
        *entry = Complex::new(T::zero(), T::zero());
        for k in (0..s).rev() {
            *entry = *entry * *node / T::from_f64((k + 1) as f64) + coefficients[k];
        }
    }
}

compiled_once! {
    /// [`Collocation::new`].
    pub(super) fn collocation<T>: fn(&Digits) -> Collocation<T> = Collocation::new;
}
