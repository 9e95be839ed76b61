//! Sine and cosine of one angle together, inlined and without branches up to [`LARGEST`].
//!
//! In:  angles.
//! Out: both values, each within one and a half units in the last place.
//!
//! The angle is reduced by multiples of π/2 held in parts (Cody & Waite, *Software
//! Manual for the Elementary Functions*, 1980); the polynomials on [−π/4, π/4] have the
//! minimax coefficients that Sun's fdlibm publishes (`k_sin.c`, `k_cos.c`, 1993).

use core::f64::consts::FRAC_2_PI;
use core::hint::{black_box, select_unpredictable};

/// The largest angle (rad) for which the reduction is exact enough: the multiples
/// of π/2 then have at most 17 bits.
const LARGEST: f64 = 1.0e5;

/// The multiple of π/2 up to which angles are small: less than [`LARGEST`] by a quarter.
const MULTIPLE: f64 = 63_661.0;

/// Whether a product and a sum are one operation of the processor.
const FUSED: bool = cfg!(all(feature = "std", target_feature = "fma"));

/// π/2 in three parts: of 53 bits each where a product is fused with a sum; else 33
/// bits, the next 33, and the rest, which leave room for the bits of a multiple. What is
/// left of an angle after the first part is exact.
const HALF_PI: [f64; 3] = if FUSED {
    [
        core::f64::consts::FRAC_PI_2,
        6.123_233_995_736_766e-17,
        -1.497_384_904_859_183_3e-33,
    ]
} else {
    [
        1.570_796_326_734_125_6,
        6.077_100_506_303_966e-11,
        2.022_266_248_795_950_6e-21,
    ]
};
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

/// The numbers above, once for each lane: constants would be copied to the lanes by the
/// compiler, at the cost of an instruction each.
struct Table {
    quarters: Block,
    round: Block,
    half_pi: [Block; 3],
    sine: [Block; 6],
    cosine: [Block; 6],
    half: Block,
    one: Block,
    /// The bit of the sign.
    sign: Block,
}

const fn every<const K: usize>(numbers: [f64; K]) -> [Block; K] {
    let mut blocks = [[0.0; LANES]; K];
    let mut i = 0;
    while i < K {
        blocks[i] = [numbers[i]; LANES];
        i += 1;
    }
    blocks
}

const NUMBERS: Table = Table {
    quarters: [FRAC_2_PI; LANES],
    round: [ROUND; LANES],
    half_pi: every(HALF_PI),
    sine: every(SINE),
    cosine: every(COSINE),
    half: [0.5; LANES],
    one: [1.0; LANES],
    sign: [-0.0; LANES],
};
static TABLE: Table = NUMBERS;

/// Sines of multiples of π/2, of which each is the cosine of the one before.
const QUARTERS: [f64; 5] = [0.0, 1.0, 0.0, -1.0, 0.0];

/// Sine and cosine of `x`: inlined where the reduction is exact enough, the library's
/// elsewhere.
#[inline(always)]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= LARGEST {
        of_small(x)
    } else {
        library_sin_cos(x)
    }
}

/// Sine and cosine of an angle up to [`LARGEST`].
///
/// Those of the nearest multiple of π/2 are multiplied with those of what is left: exact, since
/// one of two products is zero, in fewer instructions than a swap and two signs take, and without
/// a branch.
#[inline(always)]
fn of_small(x: f64) -> (f64, f64) {
    let near = in_first_quarter(x, &NUMBERS, 0);
    let quarter = (near.quarter & 3) as usize;
    let (sine, cosine) = (QUARTERS[quarter], QUARTERS[quarter + 1]);
    (
        fused(near.cosine, sine, near.sine * cosine),
        fused(-near.sine, sine, near.cosine * cosine),
    )
}

#[cold]
#[inline(never)]
fn library_sin_cos(x: f64) -> (f64, f64) {
    #[cfg(feature = "std")]
    {
        f64::sin_cos(x)
    }
    #[cfg(not(feature = "std"))]
    {
        num_traits::Float::sin_cos(x)
    }
}

/// An angle less the nearest multiple of π/2.
struct Near {
    sine: f64,
    cosine: f64,
    /// That multiple: a whole number, and an integer of which the low bits count.
    multiple: f64,
    quarter: u64,
}

/// Sine and cosine of the angle in a lane, less the nearest multiple of π/2.
#[inline(always)]
fn in_first_quarter(x: f64, table: &Table, lane: usize) -> Near {
    let shifted = fused(x, table.quarters[lane], table.round[lane]);
    let multiple = shifted - table.round[lane];
    let (r, tail) = remainder(x, multiple, table, lane);
    let z = r * r;
    let bend = polynomial(z, &table.sine, lane);
    let bow = polynomial(z, &table.cosine, lane);
    let (sine, cosine) = if FUSED {
        // Only the factor of z is rounded: by a quarter of a unit, since it is near a half.
        let bow = fused(z, bow, -table.half[lane]);
        (fused(z * r, bend, r), fused(z, bow, table.one[lane]))
    } else {
        let half = z * table.half[lane];
        let near = table.one[lane] - half;
        // What the rounding of that added. The sums are written as differences, whose operands
        // the compiler does not exchange when it puts lanes together.
        let added = (near - table.one[lane]) + half;
        let bow = added + r * tail - z * z * bow;
        (r + (z * r * bend + tail), near - bow)
    };
    let quarter = shifted.to_bits();
    Near {
        sine,
        cosine,
        multiple,
        quarter,
    }
}

/// Sine and cosine of the angle in a lane, and the multiple of π/2 that is nearest to it.
#[inline(always)]
fn in_lane(x: f64, table: &Table, lane: usize) -> ((f64, f64), f64) {
    let near = in_first_quarter(x, table, lane);
    let (odd, third) = (near.quarter << 63, near.quarter << 62);
    let swap = (odd as i64) < 0;
    let s = select_unpredictable(swap, near.cosine, near.sine);
    let c = select_unpredictable(swap, near.sine, near.cosine);
    let sign = third & table.sign[lane].to_bits();
    let sine = f64::from_bits(s.to_bits() ^ sign);
    let cosine = f64::from_bits(c.to_bits() ^ sign ^ odd);
    ((sine, cosine), near.multiple)
}

/// `x − n·π/2`, and what its rounding loses; that is given as zero where products are fused
/// with sums, since it is no more than half a unit.
#[inline(always)]
fn remainder(x: f64, n: f64, table: &Table, lane: usize) -> (f64, f64) {
    let first = fused(-n, table.half_pi[0][lane], x);
    if FUSED {
        let second = fused(-n, table.half_pi[1][lane], first);
        return (fused(-n, table.half_pi[2][lane], second), 0.0);
    }
    let middle = n * table.half_pi[1][lane];
    let second = first - middle;
    let rest = n * table.half_pi[2][lane] - ((first - second) - middle);
    let r = second - rest;
    (r, (second - r) - rest)
}

/// `c₀ + z(c₁ + z(c₂ + …))`.
#[inline(always)]
fn polynomial(z: f64, coefficients: &[Block; 6], lane: usize) -> f64 {
    let [first @ .., last] = coefficients;
    let step = |sum: f64, coefficient: &Block| fused(sum, z, coefficient[lane]);
    first.iter().rev().fold(last[lane], step)
}

/// As many angles as go through the processor's lanes at once.
const LANES: usize = 4;

/// Angles, or their sines or cosines, that are worked on side by side.
type Block = [f64; LANES];

/// Sines and cosines of several angles: in lanes, or one by one where a block would be filled
/// in part, which takes more time.
#[inline(always)]
pub(crate) fn sin_cos_all<const K: usize>(angles: &[f64; K]) -> ([f64; K], [f64; K]) {
    // All of it is written over. Ones are stored here, side by side; zeros are left to a
    // function that clears memory, and its call costs more.
    let mut both = [[1.0; K]; 2];
    let [sines, cosines] = &mut both;
    if K < LANES {
        few(angles, sines, cosines);
    } else {
        in_blocks(angles, sines, cosines);
    }
    let [sines, cosines] = both;
    (sines, cosines)
}

/// One after the other, with one branch for all of them.
#[inline(always)]
fn few<const K: usize>(angles: &[f64; K], sines: &mut [f64; K], cosines: &mut [f64; K]) {
    // None is larger than the root of the sum of all squares.
    let squares = angles.iter().fold(0.0, |sum, x| fused(*x, *x, sum));
    if squares <= LARGEST * LARGEST {
        for i in 0..K {
            (sines[i], cosines[i]) = of_small(angles[i]);
        }
    } else {
        one_by_one(angles, sines, cosines);
    }
}

/// Block after block; the last one may take in some of the one before it.
#[inline(never)]
fn in_blocks<const K: usize>(angles: &[f64; K], sines: &mut [f64; K], cosines: &mut [f64; K]) {
    // No multiple is larger than the root of the sum of all squares.
    let mut squares = [0.0; LANES];
    let (blocks, rest) = angles.as_chunks::<LANES>();
    let outputs = sines
        .as_chunks_mut()
        .0
        .iter_mut()
        .zip(cosines.as_chunks_mut().0);
    for (block, (sines, cosines)) in blocks.iter().zip(outputs) {
        let multiples = lanes(block, black_box(&TABLE), sines, cosines);
        add_squares(&multiples, &mut squares);
    }
    if !rest.is_empty()
        && let Some(block) = angles.last_chunk()
        && let (Some(sines), Some(cosines)) = (sines.last_chunk_mut(), cosines.last_chunk_mut())
    {
        let multiples = lanes(block, black_box(&TABLE), sines, cosines);
        add_squares(&multiples, &mut squares);
    }
    if !are_small(&squares) {
        one_by_one(angles, sines, cosines);
    }
}

#[inline(always)]
fn add_squares(multiples: &Block, squares: &mut Block) {
    for (n, sum) in multiples.iter().zip(squares) {
        *sum = fused(*n, *n, *sum);
    }
}

/// Whether sums of squares tell that no multiple is larger than [`MULTIPLE`], or not a
/// number.
#[inline(always)]
fn are_small(squares: &Block) -> bool {
    let mut small = true;
    for sum in squares {
        small &= *sum <= MULTIPLE * MULTIPLE;
    }
    small
}

/// A block of small angles; the multiples of π/2 that are nearest to them.
#[inline(always)]
fn lanes(block: &Block, table: &Table, sines: &mut Block, cosines: &mut Block) -> Block {
    let mut multiples = [0.0; LANES];
    for lane in 0..LANES {
        ((sines[lane], cosines[lane]), multiples[lane]) = in_lane(block[lane], table, lane);
    }
    multiples
}

/// Angles of which some may be too large for the fast path.
#[cold]
#[inline(never)]
fn one_by_one(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    for ((angle, sin), cos) in angles.iter().zip(sines).zip(cosines) {
        (*sin, *cos) = sin_cos(*angle);
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

#[cfg(test)]
mod tests {
    use super::*;
    use bricard_testkit::Random;

    /// Distance in units in the last place of the second.
    fn ulps(value: f64, exact: f64) -> f64 {
        let unit = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
        ((value - exact) / unit).abs()
    }

    fn check(x: f64) -> f64 {
        let (s, c) = sin_cos(x);
        ulps(s, x.sin()).max(ulps(c, x.cos()))
    }

    /// The library is off by half a unit itself.
    const WORST: f64 = 2.0;

    #[test]
    fn random_angles_are_within_two_units_of_the_library() {
        let mut random = Random::seeded(20_260_707);
        let mut worst: f64 = 0.0;
        for _ in 0..1_000_000 {
            let x = random.within(LARGEST);
            worst = worst.max(check(x)).max(check(x * 1e-5));
        }
        assert!(worst <= WORST, "{worst} units");
    }

    #[test]
    fn neighbours_of_multiples_of_a_right_angle_are_within_two_units_of_the_library() {
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
        assert!(worst <= WORST, "{worst} units");
    }

    #[test]
    fn a_batch_gives_what_each_angle_gives_alone_however_large_some_are() {
        fn same<const K: usize>(angles: [f64; K]) {
            let (sines, cosines) = sin_cos_all(&angles);
            for (i, angle) in angles.into_iter().enumerate() {
                let (sine, cosine) = sin_cos(angle);
                assert_eq!((sines[i], cosines[i]), (sine, cosine), "{angle}");
            }
        }
        same([0.3, -2.0, 4.0]);
        same([0.3, -2.0, 1e6]);
        same([0.3, -2.0, 4.0, -7.5, 99.0, 1e4]);
        same([0.3, -2.0, 9e4, -9e4, 8e4, 9.9e4]);
        same([0.3, -2.0, 4.0, 1e300, 99.0, 1e4]);
    }

    #[test]
    fn a_batch_with_no_number_in_it_has_that_one_only() {
        let (sines, _) = sin_cos_all(&[0.3, f64::NAN, 4.0, -7.5, 99.0]);
        assert_eq!(sines.map(f64::is_nan), [false, true, false, false, false]);
    }

    #[test]
    fn zero_has_an_exact_sine_and_cosine() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin_cos(-0.0), (0.0, 1.0));
    }
}
