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
    let shifted = fused(x, FRAC_2_PI, ROUND);
    let quarter = shifted.to_bits();
    let n = shifted - ROUND;

    // r + tail = x − n·π/2.
    let first = fused(-n, HALF_PI[0], x);
    let middle = n * HALF_PI[1];
    let second = first - middle;
    let rest = fused(n, HALF_PI[2], -((first - second) - middle));
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

/// Angles, or their sines or cosines, that are worked on side by side.
type Block = [f64; LANES];

/// Sines and cosines of several angles.
#[inline(always)]
pub(crate) fn sin_cos_all<const K: usize>(angles: [f64; K]) -> ([f64; K], [f64; K]) {
    let mut both = ([0.0; K], [0.0; K]);
    if K > LANES {
        in_blocks(&angles, &mut both.0, &mut both.1);
        return both;
    }
    let (mut block, mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    block[..K].copy_from_slice(&angles);
    in_block(&block, &mut sines, &mut cosines);
    both.0.copy_from_slice(&sines[..K]);
    both.1.copy_from_slice(&cosines[..K]);
    both
}

/// Fills slices of equal length, at least [`LANES`], block after block; the last
/// one may take in some of the one before it.
#[inline(never)]
fn in_blocks(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let mut inside = true;
    let (blocks, rest) = angles.as_chunks::<LANES>();
    let sine_blocks = sines.as_chunks_mut::<LANES>().0;
    let cosine_blocks = cosines.as_chunks_mut::<LANES>().0;
    for ((block, sines), cosines) in blocks.iter().zip(sine_blocks).zip(cosine_blocks) {
        inside &= lanes(block, sines, cosines);
    }
    if !inside {
        one_by_one(angles, sines, cosines);
    } else if !rest.is_empty()
        && let Some(block) = angles.last_chunk()
        && let (Some(sines), Some(cosines)) = (sines.last_chunk_mut(), cosines.last_chunk_mut())
    {
        in_block(block, sines, cosines);
    }
}

/// One block, in a function of its own: inlined into a long one the same lines go
/// through the lanes one after the other.
#[inline(never)]
fn in_block(block: &Block, sines: &mut Block, cosines: &mut Block) {
    if !lanes(block, sines, cosines) {
        one_by_one(block, sines, cosines);
    }
}

/// A block; `false` if one of its angles is larger than [`LARGEST`] or not a
/// number, and what was written is not to be used.
#[inline(always)]
fn lanes(block: &Block, sines: &mut Block, cosines: &mut Block) -> bool {
    let mut inside = true;
    for ((angle, sin), cos) in block.iter().zip(sines).zip(cosines) {
        (*sin, *cos) = sin_cos(*angle);
        inside &= angle.abs() <= LARGEST;
    }
    inside
}

/// Angles of which some are too large for the fast path.
#[cold]
#[inline(never)]
fn one_by_one(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for ((angle, sin), cos) in angles.iter().zip(sines).zip(cosines) {
        (*sin, *cos) = crate::real::sin_cos(*angle);
    }
}

/// `a b + c`, in one operation where the processor has one: a call of a function
/// would be far slower than what it saves.
#[inline(always)]
fn fused(a: f64, b: f64, c: f64) -> f64 {
    #[cfg(all(feature = "std", target_feature = "fma"))]
    return a.mul_add(b, c);
    #[cfg(not(all(feature = "std", target_feature = "fma")))]
    return a * b + c;
}

/// Both functions on [−π/4, π/4], at `r + tail`.
#[inline(always)]
fn kernels(r: f64, tail: f64) -> (f64, f64) {
    let z = r * r;
    let w = z * z;
    let [s1, s2, s3, s4, s5, s6] = SINE;
    let high = fused(z * w, fused(z, s6, s5), fused(z, fused(z, s4, s3), s2));
    let cube = z * r;
    let low = fused(z, fused(-cube, high, 0.5 * tail), -tail);
    let sine = r - fused(-cube, s1, low);

    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let high = fused(
        w * w,
        fused(z, fused(z, c6, c5), c4),
        z * fused(z, fused(z, c3, c2), c1),
    );
    let half = 0.5 * z;
    let near = 1.0 - half;
    let cosine = near + (((1.0 - near) - half) + fused(z, high, -(r * tail)));
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
