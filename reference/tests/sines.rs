//! Sines and cosines of the runtime against numbers of 106 bits.
//!
//! `BRICARD_LONG=1` looks at ten million angles.

use bricard_reference::DoubleDouble;
use bricard_runtime::Real;
use bricard_testkit::Random;
use core::f64::consts::FRAC_PI_2;

/// Units in the last place that a value may be off by.
const UNITS: f64 = 1.5;
/// The largest angle (rad) that the fast path takes.
const LARGEST: f64 = 1.0e5;
/// Neighbours that are looked at on both sides of a multiple of a right angle.
const NEIGHBOURS: i64 = 2;
/// Angles worked on side by side, so that blocks are filled and left half empty.
const TOGETHER: usize = 7;

/// How many angles to look at.
fn angles() -> usize {
    match std::env::var_os("BRICARD_LONG") {
        Some(_) => 10_000_000,
        None => 50_000,
    }
}

/// Distance of a value from the exact one, in units in the last place of that; infinite
/// for what is no number.
fn units(value: f64, exact: DoubleDouble) -> f64 {
    let size = exact.to_f64().abs();
    let unit = f64::from_bits(size.to_bits() + 1) - size;
    let off = (DoubleDouble::from_f64(value) - exact).to_f64().abs() / unit;
    if off.is_nan() { f64::INFINITY } else { off }
}

/// The largest error of the sines and cosines of some angles.
fn worst(angles: &[f64; TOGETHER]) -> f64 {
    let (sines, cosines) = f64::sin_cos_all(angles);
    let mut worst: f64 = 0.0;
    for ((angle, sine), cosine) in angles.iter().zip(sines).zip(cosines) {
        let exact = DoubleDouble::from_f64(*angle).sin_cos();
        worst = worst.max(units(sine, exact.0)).max(units(cosine, exact.1));
    }
    worst
}

/// The largest error over a sequence of angles.
fn worst_of(angles: impl Iterator<Item = f64>) -> f64 {
    let mut block = [0.0; TOGETHER];
    let mut worst_yet: f64 = 0.0;
    for (i, angle) in angles.enumerate() {
        block[i % TOGETHER] = angle;
        if i % TOGETHER == TOGETHER - 1 {
            worst_yet = worst_yet.max(worst(&block));
        }
    }
    // The last few, and others of the block before.
    worst_yet.max(worst(&block))
}

#[test]
fn sines_of_random_angles_are_within_one_and_a_half_units() {
    let mut random = Random::seeded(20_260_707);
    // All sizes, and small ones as often as large ones.
    let spread = (0..angles()).map(|i| random.within(if i % 2 == 0 { LARGEST } else { 4.0 }));
    let worst = worst_of(spread);
    assert!(worst <= UNITS, "{worst} units");
}

#[test]
fn sines_beside_multiples_of_a_right_angle_are_within_one_and_a_half_units() {
    let last = (LARGEST / FRAC_PI_2) as i64;
    let kinds = 2 * NEIGHBOURS + 1;
    let stride = (2 * last * kinds / angles() as i64).max(1);
    let multiples = (-last..=last).step_by(usize::try_from(stride).unwrap_or(1));
    let beside = multiples.flat_map(|n| {
        let bits = (n as f64 * FRAC_PI_2).to_bits() as i64;
        let near = move |step| f64::from_bits((bits + step) as u64);
        (-NEIGHBOURS..=NEIGHBOURS).map(near)
    });
    let worst = worst_of(beside.filter(|x| x.is_normal() && x.abs() <= LARGEST));
    assert!(worst <= UNITS, "{worst} units");
}
