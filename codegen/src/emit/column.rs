//! Arrays over the turns of loops.
//!
//! In:  the blocks of a function, and where the definitions of their steps are.
//! Out: which definitions are kept for others in such an array, and its name.

use super::name::Names;
use super::step::{Reference, Steps};
use super::turns::{Address, Block, Found};
use proc_macro2::Ident;

/// The first columns, where angles are known from the start.
const ANGLES: [&str; 2] = ["sines", "cosines"];

/// The arrays of a function.
pub(super) struct Columns {
    addresses: Vec<Address>,
    /// The number of turns of each column, and its array's name if it is needed.
    columns: Vec<(usize, Option<Ident>)>,
    /// How many of the columns are made by the call for the angles: the sines and the cosines.
    angles: usize,
    /// For each definition, whether a loop reads it from its column although it stands outside of
    /// all loops.
    read_in_turns: Vec<bool>,
}

/// Where a step is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Context {
    /// The call for the angles.
    Angles,
    /// Outside of all loops.
    Outside,
    /// In a loop and a turn of it.
    Turn(usize, usize),
}

impl Columns {
    /// The arrays that a function needs.
    pub fn of(blocks: &[Block], steps: &Steps, found: Found, names: &mut Names) -> Self {
        let contexts = contexts(blocks, steps.list.len());
        let mut defined = vec![Context::Angles; steps.definitions.len()];
        for (step, context) in steps.list.iter().zip(&contexts) {
            defined[step.defines.clone()].fill(*context);
        }
        let columns = found.columns.into_iter().map(|turns| (turns, None));
        let mut columns = Self {
            addresses: found.addresses,
            columns: columns.collect(),
            angles: steps.angles.iter().len() * ANGLES.len(),
            read_in_turns: vec![false; steps.definitions.len()],
        };
        for block in blocks {
            let (range, strides) = match block {
                Block::Straight(range) => (range.clone(), None),
                Block::Loop(repeated) => (repeated.all(), Some(&repeated.strides)),
            };
            let mut strides = strides.into_iter().flatten().cycle();
            for step in range {
                for reference in &steps.list[step].references {
                    let fixed = strides.next().is_none_or(|[row, _]| *row == 0);
                    let Reference::Value(number) = reference else {
                        continue;
                    };
                    let (from, to) = (defined[*number], contexts[step]);
                    if from != to && !(from == Context::Outside && fixed) {
                        columns.need(*number, &steps.definitions[*number], names);
                        columns.read_in_turns[*number] |= from == Context::Outside;
                    }
                }
            }
        }
        columns
    }

    /// Gives the column of a definition an array.
    fn need(&mut self, number: usize, name: &Ident, names: &mut Names) {
        if let Address::Column(column, _) = self.addresses[number] {
            let wish = match ANGLES.get(column) {
                Some(wish) if column < self.angles => wish.to_string(),
                _ => format!("{name}_by_turn"),
            };
            let array = &mut self.columns[column].1;
            array.get_or_insert_with(|| names.unique(&wish));
        }
    }

    /// The array of a definition's column, if there is one, and its place there.
    pub fn array(&self, number: usize) -> Option<(&Ident, usize)> {
        match self.addresses[number] {
            Address::Column(column, turn) => Some((self.columns[column].1.as_ref()?, turn)),
            Address::Single(_) => None,
        }
    }

    /// The array of a definition's column and its place there, if it stands outside of all loops
    /// and one of them reads it from its column.
    pub fn array_outside(&self, number: usize) -> Option<(&Ident, usize)> {
        let read = self.read_in_turns[number];
        read.then(|| self.array(number)).flatten()
    }

    /// The arrays of sines and of cosines, as far as they are needed.
    pub fn of_angles(&self) -> [Option<&Ident>; 2] {
        let array = |side: usize| self.columns.get(side).and_then(|(_, name)| name.as_ref());
        [0, 1].map(array)
    }

    /// The other arrays that are needed, with their lengths.
    pub fn arrays(&self) -> impl Iterator<Item = (&Ident, usize)> {
        let columns = self.columns[self.angles..].iter();
        columns.filter_map(|(turns, name)| Some((name.as_ref()?, *turns)))
    }
}

/// The context of each step.
fn contexts(blocks: &[Block], steps: usize) -> Vec<Context> {
    let mut contexts = Vec::with_capacity(steps);
    for (number, block) in blocks.iter().enumerate() {
        match block {
            Block::Straight(range) => contexts.extend(range.clone().map(|_| Context::Outside)),
            Block::Loop(repeated) => {
                let turns = (0..repeated.turns).map(|turn| Context::Turn(number, turn));
                let steps = repeated.first.len();
                contexts.extend(turns.flat_map(|turn| std::iter::repeat_n(turn, steps)));
            }
        }
    }
    contexts
}
