//! Motion along the zero of a switching function that both sides push it back to.
//!
//! In:  the accelerations with the condition held on either side.
//! Out: the mean of them along which the function stays zero; when one side no longer
//!      pushes back.
//!
//! Dry friction that holds a body, `force -F*sign(der(x)) on x`, is of this kind: the
//! share of each side says how much of the friction acts. Several conditions are taken
//! together, each with the difference that it makes to the acceleration.
//!
//! Source: Filippov, Differential Equations with Discontinuous Righthand Sides (1988),
//! section 4.

use super::Core;
use super::switching::{earliest, values};
use crate::crossing::{NODES, nodes};
use crate::linalg::column;
use crate::{DynamicsError, Mechanism, Real, Sides, State, Step};
use nalgebra::SVector;

/// Conditions that a motion may slide along at a time.
const ROOM: usize = 16;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// The acceleration with the conditions held, also where the motion slides along some.
    #[inline(always)]
    pub(super) fn held_acceleration<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        match self.conditions.sliding {
            0 => self.acceleration(mechanism, state),
            _ => self.sliding_acceleration(&mechanism, state),
        }
    }

    /// The acceleration of a motion that slides.
    #[inline(never)]
    fn sliding_acceleration(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let (list, count) = self.sliding_list(state)?;
        let list = &list[..count];
        let mut sides = self.conditions.sides;
        for &index in list {
            sides.hold(index as u32, false);
        }
        self.decide(sides);
        let below = self.acceleration(mechanism, state)?;
        let rates = values(mechanism, state, &below);
        let mut changes = [SVector::<T, N>::zeros(); ROOM];
        // Row `j`: how the rate of function `j` changes with each share; what it lacks.
        let mut table = [[T::zero(); ROOM + 1]; ROOM];
        for (row, &j) in table.iter_mut().zip(list) {
            row[count] = -rates[j].rate;
        }
        for (i, &index) in list.iter().enumerate() {
            let mut one = sides;
            one.hold(index as u32, true);
            self.decide(one);
            let above = self.acceleration(mechanism, state)?;
            let changed = values(mechanism, state, &above);
            for (row, &j) in table.iter_mut().zip(list) {
                row[i] = changed[j].rate - rates[j].rate;
            }
            changes[i] = above - below;
        }
        let shares = solve(&mut table, count);
        let mut acceleration = below;
        for ((&index, share), change) in list.iter().zip(shares).zip(&changes) {
            acceleration += change * share;
            self.conditions.shares[index] = share;
        }
        self.decide(self.conditions.sides);
        Ok(acceleration)
    }

    /// The conditions that the motion slides along.
    #[inline(never)]
    fn sliding_list(
        &self,
        state: &State<T, N>,
    ) -> Result<([usize; ROOM], usize), DynamicsError<T>> {
        let mut list = [0; ROOM];
        let mut count = 0;
        for (index, condition) in self.conditions.list.iter().enumerate().take(Sides::ROOM) {
            if self.conditions.slides(index) {
                if count == ROOM {
                    return Err(DynamicsError::Sticks {
                        t: state.t,
                        condition,
                    });
                }
                list[count] = index;
                count += 1;
            }
        }
        Ok((list, count))
    }

    /// When one side no longer pushes back within a step that slides along a condition.
    #[inline(never)]
    pub(super) fn end_of_sliding(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &Step<T, N>,
        index: usize,
    ) -> Result<Option<T>, DynamicsError<T>> {
        let times = nodes((step.start().t, step.end().t));
        let noise = self.noise();
        let mut first: Option<T> = None;
        // What is left of either side's share.
        for above in [true, false] {
            let mut left = |t| {
                self.held_acceleration(mechanism, &step.at(t))?;
                let share = self.conditions.shares[index];
                Ok(if above { T::one() - share } else { share })
            };
            let mut samples = [T::zero(); NODES];
            for (sample, t) in samples.iter_mut().zip(times) {
                *sample = left(t)?;
            }
            let found = earliest(&mut left, (times, samples), T::one(), noise)?;
            first = match (first, found) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
        }
        if let Some(t) = first {
            // The shares there say which side it leaves to.
            self.held_acceleration(mechanism, &step.at(t))?;
        }
        Ok(first)
    }
}

/// Solves `count` equations by elimination with the largest pivot of each column.
/// Conditions that make no difference of their own have no share.
#[inline(never)]
fn solve<T: Real>(table: &mut [[T; ROOM + 1]; ROOM], count: usize) -> [T; ROOM] {
    for k in 0..count {
        let size = |row: usize| table[row][k].abs();
        let pivot = (k..count).fold(
            k,
            |best, row| if size(row) > size(best) { row } else { best },
        );
        table.swap(k, pivot);
        let head = table[k];
        if head[k] == T::zero() {
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
    column(|k| match k < count && table[k][k] != T::zero() {
        true => table[k][count] / table[k][k],
        false => T::zero(),
    })
}
