//! Sets of small whole numbers, a bit for each.

/// A set of whole numbers below a bound.
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
