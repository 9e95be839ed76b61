//! Motion along the zero of a switching function that both sides push it back to.
//!
//! In:  the accelerations with the condition held on either side.
//! Out: the mean of them along which the function stays zero; the velocity for which it is
//!      zero.
//!
//! Dry friction that holds a body, `force -F*sign(der(x)) on x`, is of this kind: the
//! weight of each side says how much of the friction acts. Several conditions are taken
//! together, each with the difference that it makes to the acceleration.
//!
//! Source: Filippov, Differential Equations with Discontinuous Righthand Sides (1988),
//! section 4.

use crate::linalg::{add_scaled, column};
use crate::once::compiled_once;
use crate::{DynamicsError, Real, Sides, Switch};

/// Conditions that a motion may slide along at a time.
pub(super) const ROOM: usize = 16;

/// The conditions that a motion slides along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slid {
    list: [usize; ROOM],
    count: usize,
    /// The sides: below zero for all of these, as they are held for the others.
    below: Sides,
}

/// Filippov's weight of the force above zero for each condition.
pub(crate) type Weights<T> = [T; ROOM];

/// An acceleration with the conditions held on these sides, which it writes, and the
/// switching functions with their rates.
pub(crate) type Accelerate<'a, T> =
    &'a mut dyn FnMut(Sides, &mut [Switch<T>], &mut [T]) -> Result<(), DynamicsError<T>>;

impl Slid {
    /// No conditions yet; all are held on these sides.
    pub(super) fn new(below: Sides) -> Self {
        Self {
            list: [0; ROOM],
            count: 0,
            below,
        }
    }

    /// Adds a condition, if there is room for it.
    pub(super) fn push(&mut self, index: usize) -> bool {
        let Some(place) = self.list.get_mut(self.count) else {
            return false;
        };
        *place = index;
        self.count += 1;
        self.below.hold(index as u32, false);
        true
    }

    /// The places of these among all conditions.
    pub(super) fn list(&self) -> &[usize] {
        &self.list[..self.count]
    }

    /// The weights with which the conditions' changes of the acceleration make up for what the
    /// functions are off: of a motion that slides their rates, and of an impulse of the forces that
    /// hold it their values. Writes the acceleration of `n` coordinates below zero, then those
    /// changes, into `ROOM + 1` vectors.
    pub(crate) fn weigh<T: Real>(
        &self,
        n: usize,
        vectors: &mut [T],
        accelerate: Accelerate<'_, T>,
        off: fn(Switch<T>) -> T,
    ) -> Result<Weights<T>, DynamicsError<T>> {
        let (below, changes) = vectors.split_at_mut(n);
        let mut rates = [Switch::default(); Sides::ROOM];
        accelerate(self.below, &mut rates, below)?;
        // Row `j`: how the rate of function `j` changes with each weight; what it lacks.
        let mut table = [[T::zero(); ROOM + 1]; ROOM];
        for (row, &j) in table.iter_mut().zip(self.list()) {
            row[self.count] = -off(rates[j]);
        }
        for (i, (&index, change)) in self.list().iter().zip(changes.chunks_mut(n)).enumerate() {
            let mut one = self.below;
            one.hold(index as u32, true);
            let mut changed = [Switch::default(); Sides::ROOM];
            accelerate(one, &mut changed, change)?;
            for (above, below) in change.iter_mut().zip(&*below) {
                *above -= *below;
            }
            for (row, &j) in table.iter_mut().zip(self.list()) {
                row[i] = changed[j].rate - rates[j].rate;
            }
        }
        Ok(solve(&mut table, self.count))
    }

    /// Adds weighted changes to a vector.
    pub(super) fn add<T: Real>(&self, weights: &Weights<T>, changes: &[T], sum: &mut [T]) {
        let n = sum.len();
        for (weight, change) in weights[..self.count].iter().zip(changes.chunks(n)) {
            add_scaled(sum, *weight, change);
        }
    }
}

/// Solves `count` equations by elimination with the largest pivot of each column.
/// Conditions that make no difference of their own have no weight.
#[inline(never)]
fn solve<T: Real>(table: &mut [[T; ROOM + 1]; ROOM], count: usize) -> [T; ROOM] {
    // What is left of equal rows is round-off.
    for row in &mut table[..count] {
        let size = row[..count]
            .iter()
            .fold(T::zero(), |most: T, x| most.max(x.abs()));
        if size > T::zero() {
            row.iter_mut().for_each(|entry| *entry /= size);
        }
    }
    let least = T::EPSILON.sqrt();
    for k in 0..count {
        let size = |row: usize| table[row][k].abs();
        let pivot = (k..count).fold(
            k,
            |best, row| if size(row) > size(best) { row } else { best },
        );
        table.swap(k, pivot);
        let head = table[k];
        if head[k].abs() <= least {
            continue;
        }
        for (i, row) in table[..count].iter_mut().enumerate() {
            if i != k {
                let factor = row[k] / head[k];
                for (entry, head) in row.iter_mut().zip(&head) {
                    *entry -= factor * *head;
                }
            }
        }
    }
    column(|k| match k < count && table[k][k].abs() > least {
        true => table[k][count] / table[k][k],
        false => T::zero(),
    })
}

compiled_once! {
    /// [`Slid::weigh`].
    pub(super) fn weighing<T>: fn(
        &Slid,
        usize,
        &mut [T],
        Accelerate<'_, T>,
        fn(Switch<T>) -> T,
    ) -> Result<Weights<T>, DynamicsError<T>> = Slid::weigh;
}
