//! Where a cubic polynomial is lowest.
//!
//! In:  its values and rates at the ends of an interval.
//! Out: the place where it turns back, and the value there.

use crate::Real;

/// Where a cubic polynomial on [0, 1] with these values and rates at the ends is lowest,
/// and its value there; `None` if it does not fall at the one end and rise at the other.
///
/// Its derivative `c + b x + a x²` then has one root between them.
pub(super) fn lowest_of_cubic<T: Real>(ends: [T; 2], rates: [T; 2]) -> Option<(T, T)> {
    let dips = rates[0] < T::zero() && rates[1] > T::zero();
    if !dips {
        return None;
    }
    let (two, three) = (T::from_f64(2.0), T::from_f64(3.0));
    let rise = ends[1] - ends[0];
    let second = three * rise - two * rates[0] - rates[1];
    let third = rates[0] + rates[1] - two * rise;
    let (a, b, c) = (three * third, two * second, rates[0]);
    let root = (b * b - T::from_f64(4.0) * a * c).max(T::zero()).sqrt();
    // With this sign nothing cancels where the root is small, and it is the one in between.
    let x = match b >= T::zero() {
        true => -two * c / (b + root),
        false => (root - b) / (two * a),
    };
    let x = x.max(T::zero()).min(T::one());
    Some((x, ends[0] + x * (c + x * (second + x * third))))
}

#[cfg(test)]
mod tests {
    use super::lowest_of_cubic;

    #[test]
    fn a_cubic_is_lowest_where_it_turns_back() {
        // (x − x₀)² (1 + s x) − d, beside the ends, too.
        for x0 in [1e-6_f64, 0.02, 0.5, 0.986, 1.0 - 1e-6] {
            for s in [-0.5, 0.0, 0.5] {
                let value = |x: f64| (x - x0).powi(2) * (1.0 + s * x) - 1e-3;
                let rate = |x: f64| (x - x0) * (2.0 + s * (3.0 * x - x0));
                let found = lowest_of_cubic([value(0.0), value(1.0)], [rate(0.0), rate(1.0)]);
                let (x, lowest) = found.expect("it falls and rises");
                assert!((x - x0).abs() < 1e-9, "{x} is not {x0} with {s}");
                assert!((lowest + 1e-3).abs() < 1e-15, "{lowest}");
            }
        }
        assert_eq!(lowest_of_cubic([1.0, 1.0], [1.0, -1.0]), None);
        assert_eq!(lowest_of_cubic([1.0, 1.0], [f64::NAN, 1.0]), None);
    }
}
