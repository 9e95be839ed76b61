//! Sine and cosine of one angle together, inlined and without branches.
//!
//! In:  an angle `|x| ≤` [`LARGEST`].
//! Out: both values, each within one unit in the last place.
//!
//! The angle is reduced by multiples of π/2 held in three parts (Cody & Waite,
//! *Software Manual for the Elementary Functions*, 1980), with what the rounding
//! of the remainder loses carried along; the polynomials on [−π/4, π/4] have the
//! minimax coefficients that Sun's fdlibm publishes (`k_sin.c`, `k_cos.c`, 1993).

use core::f64::consts::FRAC_2_PI;

/// The largest angle (rad) for which the reduction is exact enough: the multiples
/// of π/2 then have at most 17 bits, which the 33-bit parts leave room for.
pub(crate) const LARGEST: f64 = 1.0e5;

/// The first 33 bits of π/2, the next 33, and the rest.
const HALF_PI: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];
/// 1.5 · 2⁵²: adding it rounds to a whole number, whose low bits are then the
/// number's.
const ROUND: f64 = 6_755_399_441_055_744.0;

const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine and cosine of `x`, `|x| ≤` [`LARGEST`].
#[inline(always)]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    let shifted = x * FRAC_2_PI + ROUND;
    let quarter = shifted.to_bits();
    let n = shifted - ROUND;

    // r + tail = x − n·π/2.
    let first = x - n * HALF_PI[0];
    let middle = n * HALF_PI[1];
    let second = first - middle;
    let rest = n * HALF_PI[2] - ((first - second) - middle);
    let r = second - rest;
    let tail = (second - r) - rest;

    let (s, c) = kernels(r, tail);
    let swap = quarter & 1 == 1;
    let (s, c) = if swap { (c, s) } else { (s, c) };
    let sine_sign = (quarter & 2) << 62;
    let cosine_sign = (quarter.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits(s.to_bits() ^ sine_sign),
        f64::from_bits(c.to_bits() ^ cosine_sign),
    )
}

/// As many angles as go through the processor's lanes at once.
const LANES: usize = 4;

/// Sines and cosines of several angles, each `|x| ≤` [`LARGEST`].
#[inline(always)]
pub(crate) fn sin_cos_all<const K: usize>(angles: [f64; K]) -> ([f64; K], [f64; K]) {
    let mut both = ([0.0; K], [0.0; K]);
    for first in (0..K).step_by(LANES) {
        let block: [f64; LANES] =
            core::array::from_fn(|i| angles.get(first + i).copied().unwrap_or(0.0));
        let block = block.map(sin_cos);
        for (i, (sin, cos)) in block.into_iter().take(K - first).enumerate() {
            both.0[first + i] = sin;
            both.1[first + i] = cos;
        }
    }
    both
}

/// Both functions on [−π/4, π/4], at `r + tail`.
#[inline(always)]
fn kernels(r: f64, tail: f64) -> (f64, f64) {
    let z = r * r;
    let w = z * z;
    let [s1, s2, s3, s4, s5, s6] = SINE;
    let high = s2 + z * (s3 + z * s4) + z * w * (s5 + z * s6);
    let cube = z * r;
    let sine = r - ((z * (0.5 * tail - cube * high) - tail) - cube * s1);

    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let high = z * (c1 + z * (c2 + z * c3)) + w * w * (c4 + z * (c5 + z * c6));
    let half = 0.5 * z;
    let near = 1.0 - half;
    let cosine = near + (((1.0 - near) - half) + (z * high - r * tail));
    (sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance in units in the last place of the second.
    fn ulps(value: f64, exact: f64) -> f64 {
        let unit = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
        ((value - exact) / unit).abs()
    }

    fn check(x: f64) -> f64 {
        let (s, c) = sin_cos(x);
        ulps(s, x.sin()).max(ulps(c, x.cos()))
    }

    #[test]
    fn random_angles_are_within_a_unit_of_the_library() {
        let mut seed: u64 = 20_260_707;
        let mut worst: f64 = 0.0;
        for _ in 0..1_000_000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let x = ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 2.0 * LARGEST;
            worst = worst.max(check(x)).max(check(x * 1e-5));
        }
        assert!(worst <= 1.0, "{worst} units");
    }

    #[test]
    fn neighbours_of_multiples_of_a_right_angle_are_within_a_unit_of_the_library() {
        let mut worst: f64 = 0.0;
        for n in -60_000_i32..=60_000 {
            let x = f64::from(n) * core::f64::consts::FRAC_PI_2;
            for bits in [x.to_bits(), x.to_bits() + 1, x.to_bits().wrapping_sub(1)] {
                let x = f64::from_bits(bits);
                if x.abs() <= LARGEST {
                    worst = worst.max(check(x));
                }
            }
        }
        assert!(worst <= 1.0, "{worst} units");
    }

    #[test]
    fn zero_keeps_its_sign_and_has_an_exact_cosine() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert!(sin_cos(-0.0).0.is_sign_negative());
    }
}
