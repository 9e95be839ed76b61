//! The lines that the firmware writes.
//!
//! In:  text.
//! Out: what it says, or the line that can't be understood.

use std::collections::BTreeMap;

/// Coordinates, then velocities.
pub type State = [f64; 6];

/// What some ticks took together.
#[derive(Default)]
pub struct Ticks {
    pub count: u64,
    pub evaluations: u64,
    pub instructions: u64,
}

/// The most of a tick.
#[derive(Default)]
pub struct Most {
    pub evaluations: u32,
    pub instructions: u32,
    /// Instructions for each evaluation.
    pub each: u32,
}

/// What the firmware says.
#[derive(Default)]
pub struct Report {
    /// States by the number of the tick.
    pub states: BTreeMap<u32, State>,
    /// Bytes of the stack that were used.
    pub stack: u32,
    /// Bytes of the loop's variables.
    pub variables: u32,
    /// Ticks away from singular positions.
    pub regular: Ticks,
    /// Ticks next to them.
    pub beside: Ticks,
    pub most: Most,
}

impl Report {
    /// Reads all lines.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut report = Self::default();
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            report
                .take(&words)
                .ok_or_else(|| format!("the firmware says `{line}`"))?;
        }
        Ok(report)
    }

    fn take(&mut self, words: &[&str]) -> Option<()> {
        let (name, numbers) = words.split_first()?;
        match *name {
            "state" => {
                let (tick, bits) = numbers.split_first()?;
                let state = bits
                    .iter()
                    .map(|bits| u64::from_str_radix(bits, 16).map(f64::from_bits))
                    .collect::<Result<Vec<f64>, _>>();
                let state = State::try_from(state.ok()?).ok()?;
                self.states.insert(tick.parse().ok()?, state);
            }
            "stack" => [self.stack] = all(numbers)?,
            "variables" => [self.variables] = all(numbers)?,
            "regular" => self.regular = ticks(numbers)?,
            "beside" => self.beside = ticks(numbers)?,
            "most" => {
                let [evaluations, instructions, each] = all(numbers)?;
                self.most = Most {
                    evaluations,
                    instructions,
                    each,
                };
            }
            _ => return None,
        }
        Some(())
    }
}

fn ticks(words: &[&str]) -> Option<Ticks> {
    let [count, evaluations, instructions] = all(words)?;
    Some(Ticks {
        count,
        evaluations,
        instructions,
    })
}

/// As many numbers as there are words.
fn all<V: std::str::FromStr, const K: usize>(words: &[&str]) -> Option<[V; K]> {
    let numbers: Option<Vec<V>> = words.iter().map(|word| word.parse().ok()).collect();
    numbers?.try_into().ok()
}
