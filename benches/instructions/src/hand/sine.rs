//! Sines and cosines of a few angles at once, without branches, for |x| < 1e5.
//!
//! Cody & Waite reduction by multiples of π/2 and fdlibm's polynomials: 1.6 units in
//! the last place at worst.

const HALF_PI: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Sines and cosines.
#[inline(always)]
pub fn sin_cos<const K: usize>(angles: [f64; K]) -> ([f64; K], [f64; K]) {
    let mut both = ([0.0; K], [0.0; K]);
    for i in 0..K {
        (both.0[i], both.1[i]) = one(angles[i]);
    }
    both
}

#[inline(always)]
fn one(x: f64) -> (f64, f64) {
    let shifted = x * core::f64::consts::FRAC_2_PI + ROUND;
    let quarter = shifted.to_bits();
    let n = shifted - ROUND;
    let r = ((x - n * HALF_PI[0]) - n * HALF_PI[1]) - n * HALF_PI[2];
    let z = r * r;
    let sine = r + r
        * z
        * (-1.666_666_666_666_663_2e-1
            + z * (8.333_333_333_322_49e-3
                + z * (-1.984_126_982_985_795e-4
                    + z * (2.755_731_370_707_006_8e-6
                        + z * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10)))));
    let cosine = 1.0 - 0.5 * z
        + z * z
            * (4.166_666_666_666_66e-2
                + z * (-1.388_888_888_887_411e-3
                    + z * (2.480_158_728_947_673e-5
                        + z * (-2.755_731_435_139_066_3e-7
                            + z * (2.087_572_321_298_175e-9 + z * -1.135_964_755_778_819_5e-11)))));
    let (s, c) = if quarter & 1 == 1 {
        (cosine, sine)
    } else {
        (sine, cosine)
    };
    let sine_sign = (quarter & 2) << 62;
    let cosine_sign = (quarter.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits(s.to_bits() ^ sine_sign),
        f64::from_bits(c.to_bits() ^ cosine_sign),
    )
}
