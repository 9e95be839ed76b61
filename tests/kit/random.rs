//! Random numbers from a seed, the same on every machine.
//!
//! In:  a seed.
//! Out: [`Random`].
//!
//! Source: Steele, Lea & Flood, Fast splittable pseudorandom number generators (2014).

/// A sequence of random numbers (SplitMix64).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The sequence of a seed, a name and a place: each trial has its own, so that it can
    /// be made again alone.
    pub fn of(seed: u64, name: &str, index: usize) -> Self {
        let mix = |state: u64, byte: u8| (state ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let named = name.bytes().fold(0xcbf2_9ce4_8422_2325 ^ seed, mix);
        let mut random = Self(named.wrapping_add((index as u64).wrapping_mul(0x9e37_79b9)));
        random.bits();
        random
    }

    /// The sequence of a seed.
    pub fn seeded(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number between two.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let part = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * part
    }

    /// Numbers between two.
    pub fn vector(&mut self, n: usize, low: f64, high: f64) -> Vec<f64> {
        (0..n).map(|_| self.between(low, high)).collect()
    }

    /// A number of at most this size, of either sign.
    pub fn within(&mut self, size: f64) -> f64 {
        self.between(-size, size)
    }

    /// A number between two whose logarithm is spread evenly.
    pub fn decade(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// A number of either sign whose size lies between two, its logarithm spread evenly.
    pub fn signed_decade(&mut self, low: f64, high: f64) -> f64 {
        self.sign() * self.decade(low, high)
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// A whole number below a bound.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound as u64) as usize
    }

    /// One of several.
    pub fn of_these<T: Copy>(&mut self, these: &[T]) -> T {
        these[self.below(these.len())]
    }
}
