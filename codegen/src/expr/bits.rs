//! Sets of small whole numbers.

use rustc_hash::FxHashSet;

/// A set of whole numbers below a bound, a bit for each.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Bits {
    words: Vec<u64>,
}

impl Bits {
    /// The empty set of numbers below a bound.
    pub fn below(bound: usize) -> Self {
        Self {
            words: vec![0; bound / 64 + 1],
        }
    }

    /// Takes a number in; whether it is new.
    pub fn insert(&mut self, number: usize) -> bool {
        let (word, bit) = (&mut self.words[number / 64], 1 << (number % 64));
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }

    /// Takes in all numbers of another set with the same bound.
    pub fn extend(&mut self, other: &Bits) {
        for (word, other) in self.words.iter_mut().zip(&other.words) {
            *word |= other;
        }
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.words
            .iter()
            .map(|word| word.count_ones() as usize)
            .sum()
    }

    /// The numbers in ascending order.
    pub fn ascending(&self) -> Vec<usize> {
        let mut numbers = Vec::with_capacity(self.len());
        for (i, &word) in self.words.iter().enumerate() {
            let mut rest = word;
            while rest != 0 {
                numbers.push(64 * i + rest.trailing_zeros() as usize);
                rest &= rest - 1;
            }
        }
        numbers
    }
}

/// A set of whole numbers below a bound that takes no more time than it has numbers: it begins
/// without a bit for each.
#[derive(Debug)]
pub(crate) enum Growing {
    /// So far, and the bound.
    Few(FxHashSet<usize>, usize),
    /// With a bit for each.
    Many(Bits),
}

impl Growing {
    /// The empty set of numbers below a bound.
    pub fn below(bound: usize) -> Self {
        Self::Few(FxHashSet::default(), bound)
    }

    /// Takes a number in; whether it is new.
    pub fn insert(&mut self, number: usize) -> bool {
        match self {
            Self::Many(bits) => bits.insert(number),
            Self::Few(few, bound) => {
                let is_new = few.insert(number);
                if few.len() > *bound / 64 {
                    let mut bits = Bits::below(*bound);
                    for number in few.iter() {
                        bits.insert(*number);
                    }
                    *self = Self::Many(bits);
                }
                is_new
            }
        }
    }

    /// The numbers in ascending order.
    pub fn ascending(&self) -> Vec<usize> {
        match self {
            Self::Many(bits) => bits.ascending(),
            Self::Few(few, _) => {
                let mut numbers: Vec<usize> = few.iter().copied().collect();
                numbers.sort_unstable();
                numbers
            }
        }
    }
}
