//! Loops in a list of steps.
//!
//! In:  the steps of a program.
//! Out: [`Block`]s: stretches in which the same forms come again and again, and in which what the
//! turns refer to lies at even distances from one turn to the next; and the steps between them.
//!
//! Bodies, arrays and loops of a description leave such traces: their expressions have one
//! form, and the elimination of their unknowns goes from one to the next.

use super::step::{Reference, Step, Steps};
use crate::model::Symbol;
use rustc_hash::FxHashMap;
use std::mem::{Discriminant, discriminant};
use std::ops::Range;

/// The fewest turns of a loop, and the fewest steps that it saves.
const TURNS_MIN: usize = 4;
const SAVED_MIN: usize = 32;
/// The most lengths of a turn that are tried at a place.
const LENGTHS: usize = 16;
/// At most so many turns of equal forms are taken together as one turn: what they refer to may
/// alternate.
const TOGETHER_MAX: usize = 4;

/// Where a definition is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Address {
    /// In a column, which has a definition of each turn, at the number of the turn.
    Column(usize, usize),
    /// Outside of all columns, by its number.
    Single(usize),
}

/// Distance, in rows and columns, between what one iteration refers to and what the next
/// one does.
pub(super) type Stride = [isize; 2];

/// A part of a list of steps.
pub(super) enum Block {
    /// Steps one after the other.
    Straight(Range<usize>),
    /// Steps that come again.
    Loop(Loop),
}

/// Steps that come again.
pub(super) struct Loop {
    /// The steps of the first turn.
    pub first: Range<usize>,
    pub turns: usize,
    /// The strides of all that these steps refer to, in order.
    pub strides: Vec<Stride>,
    /// The distance in a column from one turn to the next.
    pub step: isize,
}

impl Loop {
    /// The steps of all turns.
    pub fn all(&self) -> Range<usize> {
        self.first.start..self.first.start + self.first.len() * self.turns
    }
}

/// What was found in a list of steps.
pub(super) struct Found {
    pub blocks: Vec<Block>,
    /// Where each definition is.
    pub addresses: Vec<Address>,
    /// The number of turns of each column.
    pub columns: Vec<usize>,
}

/// A stretch of steps in which their forms come again and again.
#[derive(Clone, Copy)]
struct Stretch {
    first: usize,
    /// Steps of a turn.
    length: usize,
    turns: usize,
}

impl Stretch {
    fn turn(&self, turn: usize) -> usize {
        self.first + turn * self.length
    }

    fn saved(&self) -> usize {
        (self.turns - 1) * self.length
    }

    fn is_worth_it(&self) -> bool {
        self.turns >= TURNS_MIN && self.saved() >= SAVED_MIN
    }
}

impl Found {
    /// Finds the loops and columns in the steps of a program.
    pub fn of(steps: &Steps) -> Self {
        let stretches = stretches(&steps.list);
        let mut found = Self {
            blocks: Vec::new(),
            addresses: (0..steps.definitions.len()).map(Address::Single).collect(),
            columns: Vec::new(),
        };
        found.columns_of_angles(steps);
        for stretch in &stretches {
            found.columns_of_stretch(&steps.list, stretch);
        }
        let mut done = 0;
        for stretch in stretches {
            found.straight(done..stretch.first);
            found.loops(&steps.list, stretch);
            done = stretch.turn(stretch.turns);
        }
        found.straight(done..steps.list.len());
        found
    }

    /// How many steps are left to be written: those outside of loops, and those of one turn of
    /// each loop.
    pub fn left(&self) -> usize {
        let length = |block: &Block| match block {
            Block::Straight(range) => range.len(),
            Block::Loop(repeated) => repeated.first.len(),
        };
        self.blocks.iter().map(length).sum()
    }

    /// Makes the sines a column, and the cosines another.
    fn columns_of_angles(&mut self, steps: &Steps) {
        let Some(angles) = &steps.angles else { return };
        for side in 0..2 {
            for (turn, pair) in angles.pairs.iter().enumerate() {
                if let Some(number) = pair[side] {
                    self.addresses[number] = Address::Column(self.columns.len(), turn);
                }
            }
            self.columns.push(angles.pairs.len());
        }
    }

    /// Makes each definition of a step of a turn a column over all turns.
    fn columns_of_stretch(&mut self, steps: &[Step], stretch: &Stretch) {
        for step in stretch.first..stretch.turn(1) {
            for place in 0..steps[step].defines.len() {
                for turn in 0..stretch.turns {
                    let number = steps[step + turn * stretch.length].defines.start + place;
                    self.addresses[number] = Address::Column(self.columns.len(), turn);
                }
                self.columns.push(stretch.turns);
            }
        }
    }

    /// Adds steps that are in no loop; those next to one another make one block.
    fn straight(&mut self, steps: Range<usize>) {
        match self.blocks.last_mut() {
            _ if steps.is_empty() => {}
            Some(Block::Straight(before)) => before.end = steps.end,
            _ => self.blocks.push(Block::Straight(steps)),
        }
    }

    /// Adds the loops of a stretch. Its first turns often refer to what stands before it, and its
    /// last turns to ends: these are no part of a loop.
    fn loops(&mut self, steps: &[Step], stretch: Stretch) {
        let mut turn = 0;
        while turn < stretch.turns {
            let mut best = (
                0,
                Block::Straight(stretch.turn(turn)..stretch.turn(turn + 1)),
                1,
            );
            for together in 1..=TOGETHER_MAX {
                let part = Stretch {
                    first: stretch.turn(turn),
                    length: together * stretch.length,
                    turns: (stretch.turns - turn) / together,
                };
                if let Some((part, strides)) = self.even_turns(steps, part)
                    && part.is_worth_it()
                    && part.saved() > best.0
                {
                    let repeated = Loop {
                        first: part.first..part.turn(1),
                        turns: part.turns,
                        strides,
                        step: together.cast_signed(),
                    };
                    best = (part.saved(), Block::Loop(repeated), part.turns * together);
                }
            }
            turn += best.2;
            match best.1 {
                Block::Straight(steps) => self.straight(steps),
                repeated @ Block::Loop(_) => self.blocks.push(repeated),
            }
        }
    }

    /// The first turns of a stretch that refer to things at even distances, and these distances.
    fn even_turns(&self, steps: &[Step], stretch: Stretch) -> Option<(Stretch, Vec<Stride>)> {
        let at = |turn: usize| self.referred(steps, stretch.turn(turn)..stretch.turn(turn + 1));
        if stretch.turns < 2 {
            return None;
        }
        let (first, mut last) = (at(0), at(1));
        let strides = strides(&first, &last)?;
        let mut turns = 2;
        while turns < stretch.turns {
            let next = at(turns);
            if !continues(&last, &next, &strides) {
                break;
            }
            last = next;
            turns += 1;
        }
        Some((Stretch { turns, ..stretch }, strides))
    }

    /// What the steps of a turn refer to.
    fn referred(&self, steps: &[Step], turn: Range<usize>) -> Vec<Target> {
        let own = steps[turn.start].defines.start..steps[turn.end - 1].defines.end;
        let references = steps[turn].iter().flat_map(|step| &step.references);
        references
            .map(|reference| self.target(*reference, &own))
            .collect()
    }

    fn target(&self, reference: Reference, own: &Range<usize>) -> Target {
        match reference {
            Reference::Value(number) if own.contains(&number) => {
                Target(Group::Own(number - own.start), [0, 0])
            }
            Reference::Value(number) => match self.addresses[number] {
                Address::Column(column, turn) => Target(Group::Column(column), [turn, 0]),
                Address::Single(number) => Target(Group::Single(number), [0, 0]),
            },
            Reference::Entry(symbol) => {
                let place = symbol.entry().unwrap_or_default();
                Target(Group::Entry(discriminant(&symbol)), [place, 0])
            }
            Reference::Number(..) => Target(Group::Number, [0, 0]),
            Reference::Written(slot) => Target(Group::Written, [slot.row, slot.column]),
        }
    }
}

/// What a step refers to: the group that contains it, and its place there.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Target(Group, [usize; 2]);

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Group {
    /// A definition of the same turn.
    Own(usize),
    Column(usize),
    Single(usize),
    Entry(Discriminant<Symbol>),
    Number,
    Written,
}

/// The distances from what one turn refers to, to what the next one refers to. `None` if the two
/// are of different groups, or if one thing to which a turn refers twice would become two in the
/// next: it has only one name.
fn strides(first: &[Target], next: &[Target]) -> Option<Vec<Stride>> {
    let mut known: FxHashMap<Target, Stride> = FxHashMap::default();
    let mut strides = Vec::with_capacity(first.len());
    for (target, moved) in first.iter().zip(next) {
        let stride = stride(target, moved)?;
        if target.0 != Group::Written && *known.entry(*target).or_insert(stride) != stride {
            return None;
        }
        strides.push(stride);
    }
    Some(strides)
}

fn stride(target: &Target, moved: &Target) -> Option<Stride> {
    (target.0 == moved.0).then(|| distance(target.1, moved.1))
}

/// The distance from one place of an array to another.
pub(super) fn distance(from: [usize; 2], to: [usize; 2]) -> Stride {
    let step = |i: usize| to[i].wrapping_sub(from[i]).cast_signed();
    [step(0), step(1)]
}

fn continues(last: &[Target], next: &[Target], strides: &[Stride]) -> bool {
    let mut all = last.iter().zip(next).zip(strides);
    all.all(|((last, next), stride)| self::stride(last, next) == Some(*stride))
}

/// Stretches in which forms come again, from the first on, each with the length of turn that
/// saves most.
fn stretches(steps: &[Step]) -> Vec<Stretch> {
    let mut places: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    for (place, step) in steps.iter().enumerate() {
        places.entry(step.form).or_default().push(place);
    }
    let mut stretches = Vec::new();
    let mut first = 0;
    while first < steps.len() {
        let again = &places[&steps[first].form];
        let after = again.partition_point(|place| *place <= first);
        let mut best: Option<Stretch> = None;
        for next in again[after..].iter().take(LENGTHS) {
            let stretch = stretch(steps, first, next - first);
            if best.is_none_or(|best| best.saved() < stretch.saved()) {
                best = Some(stretch);
            }
        }
        match best {
            Some(stretch) if stretch.is_worth_it() => {
                first = stretch.turn(stretch.turns);
                stretches.push(stretch);
            }
            _ => first += 1,
        }
    }
    stretches
}

/// How often a number of steps comes again in the same forms.
fn stretch(steps: &[Step], first: usize, length: usize) -> Stretch {
    let pairs = steps[first..].iter().zip(&steps[first + length..]);
    let equal = pairs
        .take_while(|(step, next)| step.form == next.form)
        .count();
    Stretch {
        first,
        length,
        turns: 1 + equal / length,
    }
}
