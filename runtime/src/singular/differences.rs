//! Numerical differentiation.
//!
//! In:  equidistant values of a function.
//! Out: how fast it changes there, to the fourth order.

use crate::Real;

/// Values of the function that are used.
pub(super) const VALUES: usize = 5;

/// The derivatives of the polynomial through all values.
const WEIGHTS: [[f64; VALUES]; VALUES] = [
    [-25.0, 48.0, -36.0, 16.0, -3.0],
    [-3.0, -10.0, 18.0, -6.0, 1.0],
    [1.0, -8.0, 0.0, 8.0, -1.0],
    [-1.0, 6.0, -18.0, 10.0, 3.0],
    [3.0, -16.0, 36.0, -48.0, 25.0],
];

/// Place `k` of the equidistant ones, of which the first and the last are given.
pub(super) fn place<T: Real>((from, to): (T, T), k: usize) -> T {
    match k + 1 == VALUES {
        true => to,
        false => from + (to - from) * T::from_f64(k as f64 / (VALUES - 1) as f64),
    }
}

/// How fast a function changes at equidistant places, from its values there.
pub(super) fn differentiated<T: Real>(values: [T; VALUES], distance: T) -> [T; VALUES] {
    WEIGHTS.map(|weights| {
        let terms = weights
            .iter()
            .zip(values)
            .map(|(weight, value)| T::from_f64(*weight) * value);
        terms.fold(T::zero(), |sum, term| sum + term) / (distance * T::from_f64(12.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_the_fourth_degree_are_exact() {
        let value = |x: f64| 3.0 - x + 2.0 * x.powi(3) - 0.5 * x.powi(4);
        let slope = |x: f64| -1.0 + 6.0 * x.powi(2) - 2.0 * x.powi(3);
        let places = core::array::from_fn(|k| place((-1.0, 1.0), k));
        let found = differentiated(places.map(value), 0.5);
        for (place, found) in places.into_iter().zip(found) {
            assert!((found - slope(place)).abs() < 1e-13, "{place}: {found}");
        }
    }
}
