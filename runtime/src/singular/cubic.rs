//! Where a cubic polynomial is lowest.
//!
//! In:  its values and rates at the ends of an interval.
//! Out: a place, to a few digits, and the value there.

use crate::Real;

/// Places at which a polynomial is evaluated.
const SAMPLES: usize = 16;

/// Where a cubic polynomial on [0, 1] with these values and rates at the ends is lowest,
/// and its value there.
pub(super) fn lowest_of_cubic<T: Real>(ends: [T; 2], rates: [T; 2]) -> (T, T) {
    let number = T::from_f64;
    let value = |x: T| {
        let rest = T::one() - x;
        ends[0] * rest * rest * (T::one() + number(2.0) * x)
            + ends[1] * x * x * (T::one() + number(2.0) * rest)
            + rates[0] * x * rest * rest
            - rates[1] * x * x * rest
    };
    let samples = (1..SAMPLES).map(|k| number(k as f64 / SAMPLES as f64));
    samples.fold((number(0.5), value(number(0.5))), |lowest, x| {
        let here = value(x);
        if here < lowest.1 { (x, here) } else { lowest }
    })
}
