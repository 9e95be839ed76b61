//! Forces that jump or kink: where conditions change within an attempt at a step.
//!
//! In:  attempts at steps, made with the conditions that held at their start ([`Motion`]).
//! Out: where the first of them changes; the conditions from there on.
//!
//! A condition hangs on the side of zero of a switching function. Held on its side, the
//! forces are smooth over the step and beyond, so that the step's own interpolant tells
//! when the function passes zero, and the step can be made again to end there. Where the
//! motion is pushed back to zero from both sides, as by dry friction that holds, it slides
//! along ([`super::sliding`]). All of that is over times and values, and compiled once for
//! mechanisms of all sizes.
//!
//! Not here: how the conditions are held ([`super::locking`]).
//!
//! Source: Park & Barton, ACM Transactions on Modeling and Computer Simulation 6 (1996)
//! 137–165 (discontinuity locking).

use super::conditions::{Aim, Burst, Decided, round_off_of};
use crate::crossing::{Left, NODES, Samples, first_crossing, moment, nodes, told, zero};
use crate::once::compiled_once;
use crate::{Discontinuity, DynamicsError, Real, Sides, Switch, Switches, Switching, Watched};

/// Attempts, after the first, to end a step where one function passes zero.
const REFINEMENTS: u32 = 3;
/// Switching functions that are sampled at once: the room for more has to be cleared.
const AT_ONCE: usize = 8;
/// A side that pushes less than this part of the other one, in units of what functions are off by,
/// is about to push the other way: so well is it known when another condition ceases to hold.
const TAKES_OVER: f64 = 100.0;
/// Changes of conditions that follow one another within this part of an attempt at a step count as
/// getting nowhere.
const HARDLY_LATER: f64 = 1e-6;
/// Changes in a row that may get nowhere, besides some for each condition there is.
const MOST_TURNS: usize = 100;
/// Changes that are allowed within the length of one attempt: what rests where it is pushed from
/// both sides trembles by as much as noise lets it, and a run would never end.
const MOST_AT_ONCE: usize = 10_000;

/// The motion of a mechanism of any size in an attempt at a step.
pub(crate) trait Motion<T> {
    /// What is decided about its conditions.
    fn decided(&mut self) -> &mut Decided<T>;
    /// When the attempt begins and ends.
    fn ends(&self) -> (T, T);
    /// What functions are off by within the attempt, relative to their size there.
    fn noise(&self) -> T;
    /// Writes the values of switching functions at a time, as many as there is room for.
    fn values(&self, t: T, out: &mut Switches<'_, T>);
    /// Writes the values and the rates of switching functions at a time, with the conditions held
    /// as was decided. Without room for them, only the weights of the conditions that are slid
    /// along are found.
    fn rates(&mut self, t: T, values: &mut [Switch<T>]) -> Result<(), DynamicsError<T>>;
}

impl<T: Real> dyn Motion<T> + '_ {
    /// Where the first condition changes within a step that was made with those at its
    /// start.
    pub(crate) fn switch(&mut self) -> Result<Switching<T>, DynamicsError<T>> {
        let (start, end) = self.ends();
        let same = moment(start.abs().max(end.abs()));
        let decided = self.decided();
        decided.made = Some((decided.sides, decided.sliding));
        decided.attempt = decided.attempt.max(end - start);
        // An attempt that was too long for its tolerance ends earlier than it should.
        let aim = decided.aim.take();
        let aim = aim.filter(|aim| end >= aim.t - same);
        let index = match self.first_change()? {
            Some((index, t)) if t <= start + same => {
                self.turn(index, start)?;
                return Ok(Switching::AtStart);
            }
            Some((index, t)) => {
                // A zero long before the end that was aimed at is another zero of the same
                // function.
                let near = t - start > (end - start) * T::from_f64(0.5);
                let tries = aim
                    .filter(|aim| aim.index == index && near)
                    .map_or(0, |aim| aim.tries + 1);
                if t < end - same && tries <= REFINEMENTS {
                    self.decided().aim = Some(Aim { index, t, tries });
                    return Ok(Switching::Within(t));
                }
                index
            }
            None => match aim {
                None => {
                    self.decided().attempt = T::zero();
                    return Ok(Switching::Nowhere);
                }
                Some(aim) => {
                    if let Some(t) = self.refined(aim, same)? {
                        let tries = aim.tries + 1;
                        self.decided().aim = Some(Aim { t, tries, ..aim });
                        return Ok(Switching::Within(t));
                    }
                    aim.index
                }
            },
        };
        self.turn(index, end)?;
        self.decided().attempt = T::zero();
        Ok(Switching::AtEnd)
    }

    /// Decides the conditions at a start: where functions are zero there, by how the motion goes
    /// on.
    pub(crate) fn settle(&mut self) -> Result<(), DynamicsError<T>> {
        let (t, _) = self.ends();
        while let Some(index) = self.wrong_at(t)? {
            self.turn(index, t)?;
        }
        let decided = self.decided();
        decided.turns = 0;
        decided.made = Some((decided.sides, decided.sliding));
        Ok(())
    }

    /// A condition that holds no longer as soon as the motion goes on: its function is at zero
    /// and leaves its side, or it is slid along and one side doesn't push back.
    fn wrong_at(&mut self, t: T) -> Result<Option<usize>, DynamicsError<T>> {
        let mut values = [Switch::default(); Sides::ROOM];
        self.rates(t, &mut values)?;
        let decided = self.decided();
        let count = decided.list.len().min(Sides::ROOM);
        for (index, found) in values[..count].iter().enumerate() {
            decided.take_note(index, *found);
        }
        Ok((0..count).find(|&index| {
            let Switch { value, rate } = values[index];
            match decided.slides(index) {
                true => !(T::zero()..=T::one()).contains(&decided.weights[index]),
                // What stays zero since another condition is slid along leaves by round-off.
                false => {
                    let least = decided.round_off(index).rate;
                    value == T::zero() && rate * decided.side(index) < -least
                }
            }
        }))
    }

    /// A better time for a function to pass zero, by Newton's method from the end of an
    /// attempt; none if that was good enough.
    fn refined(&mut self, aim: Aim<T>, same: T) -> Result<Option<T>, DynamicsError<T>> {
        if aim.tries >= REFINEMENTS || self.decided().slides(aim.index) {
            return Ok(None);
        }
        let (start, end) = self.ends();
        let Switch { value, rate } = self.rate(end, aim.index)?;
        let change = -(value / rate);
        // False where the function only just reaches zero: the change is then infinite or NaN.
        let worth = change.abs() > same && change.abs() < (end - start) * T::from_f64(0.1);
        Ok(worth.then(|| end + change))
    }

    /// Changes a condition at an end: to its other side, or to sliding if the motion is
    /// pushed back from there; off that again where one side no longer pushes.
    fn turn(&mut self, index: usize, t: T) -> Result<(), DynamicsError<T>> {
        let before = self.decided().sides;
        self.change(index, t)?;
        self.carry(index, before, t);
        Ok(())
    }

    #[inline(never)]
    fn change(&mut self, index: usize, t: T) -> Result<(), DynamicsError<T>> {
        let decided = self.decided();
        decided.count_turn(index, t)?;
        let place = index as u32;
        if decided.slides(index) {
            let above = decided.weights[index] > T::from_f64(0.5);
            decided.sliding &= !(1 << index);
            decided.released |= 1 << index;
            decided.sides.hold(place, above);
            return Ok(());
        }
        decided.released &= !(1 << index);
        let side = decided.side(index);
        if decided.list[index].discontinuity != Discontinuity::Jump {
            // Continuous forces push to the same side of zero from both.
            decided.sides.hold(place, side < T::zero());
            return Ok(());
        }
        let mut pushes = [T::zero(); 2];
        for (push, above) in pushes.iter_mut().zip([side > T::zero(), side < T::zero()]) {
            self.decided().sides.hold(place, above);
            let found = self.rate(t, index)?;
            self.decided().take_note(index, found);
            *push = found.rate * side;
        }
        // Where the motion slides along another function that vanishes with this one, neither
        // side pushes. Where this one takes over what another no longer holds, its own side is about
        // to push.
        let least = self.decided().round_off(index).rate;
        let about = least.max(pushes[1] * self.noise() * T::from_f64(TAKES_OVER));
        let [leaves, returns] = [pushes[0] < about, pushes[1] > least];
        if leaves && returns {
            self.decided().sliding |= 1 << index;
        }
        Ok(())
    }

    /// Changes the conditions whose functions jumped to their other side with a condition that
    /// has changed. Functions depend on no conditions but those before them in the list.
    fn carry(&mut self, changed: usize, before: Sides, t: T) {
        let decided = self.decided();
        let (count, mut sides) = (decided.list.len().min(Sides::ROOM), decided.sides);
        if changed + 1 >= count {
            return;
        }
        let [mut was, mut is] = [[Switch::default(); Sides::ROOM]; 2];
        self.values(t, &mut Switches::of(before, &mut was));
        loop {
            self.values(t, &mut Switches::of(sides, &mut is));
            let decided = self.decided();
            let jumped = (changed + 1..count).find(|&i| {
                let value = is[i].value;
                value != was[i].value && value * decided.side(i) < T::zero()
            });
            let Some(index) = jumped else {
                return;
            };
            decided
                .sides
                .hold(index as u32, is[index].value > T::zero());
            decided.sliding &= !(1 << index);
            sides = decided.sides;
        }
    }

    /// The first condition that changes within a step, and when.
    fn first_change(&mut self) -> Result<Option<(usize, T)>, DynamicsError<T>> {
        let list = self.decided().list;
        let times = nodes(self.ends());
        let mut sampled = [[T::zero(); NODES]; AT_ONCE];
        let mut first: Option<(usize, T)> = None;
        for index in 0..list.len() {
            if index % AT_ONCE == 0 {
                self.sample(&times, index, &mut sampled);
            }
            let values = sampled[index % AT_ONCE];
            let found = match self.decided().slides(index) {
                true => self.end_of_sliding(index)?,
                false => self.end_of_side(index, Samples { times, values })?,
            };
            if let Some(t) = found {
                first = match first {
                    Some((_, earlier)) if earlier <= t => first,
                    _ => Some((index, t)),
                };
            }
        }
        Ok(first)
    }

    /// When a sampled function leaves the side on which its condition is held.
    fn end_of_side(
        &mut self,
        index: usize,
        samples: Samples<T>,
    ) -> Result<Option<T>, DynamicsError<T>> {
        let (ends, told) = (self.ends(), told(self.noise()));
        let (size, rate) = (samples.size(), T::zero());
        let decided = self.decided();
        decided.take_note(index, Switch { value: size, rate });
        let round_off = decided.round_off(index).value;
        // A function that vanishes with one that is slid along: between the ends it is the error of
        // the step.
        let [first, last] = [samples.values[0], samples.values[NODES - 1]];
        let known = decided.known_size(index, ends.1 - ends.0);
        let vanishes = first.abs().max(last.abs()) <= round_off_of(known);
        if decided.sliding != 0 && vanishes && size <= told * known {
            return Ok(None);
        }
        let (side, sides) = (decided.side(index), decided.sides);
        let released = decided.released >> index & 1 == 1;
        let condition = &decided.list[index];
        let quantity = Watched::Condition(condition.text);
        let defined = |t, value: T| match value.partial_cmp(&T::zero()) {
            Some(_) => Ok(value),
            None => Err(DynamicsError::WatchedNotFinite { t, quantity }),
        };
        let mut value = |t| {
            let mut values = [Switch::default(); Sides::ROOM];
            self.values(t, &mut Switches::of(sides, &mut values[..=index]));
            defined(t, values[index].value)
        };
        defined(ends.1, samples.values[NODES - 1])?;
        // Cubics that join smoothly differ by the third power of the distance from the
        // knot: what comes no farther beyond does not matter.
        let noise = match condition.discontinuity {
            Discontinuity::Knot => self.noise().sqrt(),
            Discontinuity::Jump | Discontinuity::Kink => self.noise() * size + round_off,
        };
        let beyond = (-side * samples.values[0]).max(T::zero());
        // A condition that has changed may still be on its other side, by as much as a state is
        // moved that is put onto its sheet.
        let margin = noise + beyond;
        match earliest(&mut value, samples, side, margin)? {
            // Where the motion leaves zero, the interpolant is no better than the step.
            Some(t) if released && t < samples.times[1] => {
                let samples = Samples::of(&mut value, (samples.times[1], ends.1))?;
                earliest(&mut value, samples, side, margin)
            }
            found => Ok(found),
        }
    }

    /// When one side no longer pushes back within a step that slides along a condition.
    fn end_of_sliding(&mut self, index: usize) -> Result<Option<T>, DynamicsError<T>> {
        let (ends, noise) = (self.ends(), self.noise());
        let mut first: Option<T> = None;
        // A weight that falls to zero ends the sliding.
        for above in [true, false] {
            let mut left = |t| {
                self.rates(t, &mut [])?;
                let weight = self.decided().weights[index];
                Ok(if above { T::one() - weight } else { weight })
            };
            let samples = Samples::of(&mut left, ends)?;
            let margin = noise * samples.size();
            // Another condition that has just turned may end it at once, and what lets go may be
            // back before the step ends.
            let found = match samples.values[0] < -margin {
                true => Some(ends.0),
                false => earliest(&mut left, samples, T::one(), margin)?,
            };
            first = match (first, found) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
        }
        if let Some(t) = first {
            // The weights there say to which side the motion leaves.
            self.rates(t, &mut [])?;
        }
        Ok(first)
    }

    /// Samples some switching functions of a step, from one on.
    fn sample(&mut self, times: &[T; NODES], first: usize, sampled: &mut [[T; NODES]; AT_ONCE]) {
        let sides = self.decided().sides;
        let mut values = [Switch::default(); Sides::ROOM];
        let values = &mut values[..(first + AT_ONCE).min(Sides::ROOM)];
        for (k, t) in times.iter().enumerate() {
            self.values(*t, &mut Switches::of(sides, values));
            for (samples, switch) in sampled.iter_mut().zip(&values[first..]) {
                samples[k] = switch.value;
            }
        }
    }

    /// One switching function at a time, with its rate.
    #[inline(never)]
    fn rate(&mut self, t: T, index: usize) -> Result<Switch<T>, DynamicsError<T>> {
        let mut values = [Switch::default(); Sides::ROOM];
        self.rates(t, &mut values[..=index])?;
        Ok(values[index])
    }
}

impl<T: Real> Decided<T> {
    /// Refuses conditions that change again and again while time hardly goes on.
    fn count_turn(&mut self, index: usize, t: T) -> Result<(), DynamicsError<T>> {
        if self.list[index].of_time {
            return Ok(());
        }
        let later = t - self.turned > self.attempt * T::from_f64(HARDLY_LATER);
        self.turned = t;
        self.turns = if later { 0 } else { self.turns + 1 };
        self.burst.length = self.burst.length.max(self.attempt);
        if t - self.burst.since > self.burst.length {
            self.burst = Burst::since(t);
        }
        self.burst.count += 1;
        let most = MOST_TURNS + 2 * self.list.len();
        if self.turns > most || self.burst.count > MOST_AT_ONCE {
            let condition = &self.list[index];
            return Err(DynamicsError::Sticks { t, condition });
        }
        Ok(())
    }
}

/// When a sampled function leaves a side for the other one, if it does by more than a margin.
fn earliest<T: Real>(
    function: &mut dyn FnMut(T) -> Result<T, DynamicsError<T>>,
    mut samples: Samples<T>,
    side: T,
    margin: T,
) -> Result<Option<T>, DynamicsError<T>> {
    let margin = margin * side;
    for value in &mut samples.values {
        *value += margin;
    }
    let mut beyond = |t| Ok(function(t)? + margin);
    let found = first_crossing(&mut beyond, &samples, &mut side.clone(), Left::BeyondZero)?;
    let Some((from, to)) = found else {
        return Ok(None);
    };
    let (before, after) = (function(from)?, function(to)?);
    if before.sign() != side {
        return Ok(Some(from));
    }
    let t = zero(function, (from, before), (to, after))?;
    Ok(Some(t))
}

compiled_once! {
    /// [`Motion::switch`].
    pub(super) fn switching<T>: fn(&mut (dyn Motion<T> + '_)) -> Result<Switching<T>, DynamicsError<T>> =
        |motion| motion.switch();

    /// [`Motion::settle`].
    pub(super) fn settling<T>: fn(&mut (dyn Motion<T> + '_)) -> Result<(), DynamicsError<T>> =
        |motion| motion.settle();
}
