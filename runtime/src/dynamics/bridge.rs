//! Across a singular position on regular states at both sides of it.
//!
//! In:  a state near a singular position of a mechanism with one degree of freedom.
//! Out: the state on its branch, and the acceleration there.
//!
//! The branch is a smooth curve; only its equations degenerate. So it is enough to
//! know it where they do not: positions, velocities and accelerations at some
//! regular states before and behind are interpolated, as functions of the distance
//! along the curve. They are found on the cheap path, without a rank decision, and
//! have less round-off than anything that divides by vanishing rows.
//!
//! Not here: constraints that move and more degrees of freedom, where the branch is
//! not a curve; rest, where no branch is chosen; and singular positions so close
//! together that there is no room between them. There the branch rows decide
//! ([`super::singular`]).

use super::{Solver, Source, Which};
use crate::linalg::{dot, norm, on_bridge, pier_distance};
use crate::{DynamicsError, Mechanism, Real, State};
use nalgebra::SVector;

/// Regular states on each side: enough for functions that change within half a radian.
const PIERS: usize = 8;

/// How often the distances are doubled, where rows are weak farther out.
const WIDENINGS: usize = 2;

/// How often the direction of the branch is corrected at the state on it.
const DIRECTIONS: usize = 2;

/// A regular state on the branch, and the acceleration there.
#[derive(Clone, Copy, Debug)]
struct Pier<T, const N: usize> {
    /// How far along the branch, in any unit.
    place: T,
    /// Where, seen from the state that is asked for.
    offset: SVector<T, N>,
    v: SVector<T, N>,
    a: SVector<T, N>,
}

impl<T: Real, const N: usize, const R: usize> Solver<T, N, R> {
    /// Brings a state onto its branch and remembers the acceleration there; `false`
    /// if there is nothing to interpolate between, and the state is as it was.
    pub(crate) fn bridge<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &mut State<T, N>,
    ) -> Result<bool, DynamicsError<T>> {
        let Some(mut span) = self.approach(mechanism, state)? else {
            return Ok(false);
        };
        for _ in 0..=WIDENINGS {
            if let Some(piers) = self.piers(mechanism, state, span)? {
                let Some(middle) = self.middle(mechanism, state, piers) else {
                    return Ok(false);
                };
                state.q += middle.offset;
                state.v = middle.v;
                self.bridged = Some((*state, middle.a));
                return Ok(true);
            }
            span += span;
        }
        Ok(false)
    }

    /// Moves a state that was brought onto the branch from `state` along it to the
    /// nearest place in the metric. Newton's iteration ends a little beside it, and the
    /// more so the weaker the rows are, while the stages of a step that passes a
    /// singular position must all be treated alike.
    pub(super) fn slide<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        landed: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if !self.is_safe_at(landed) || !self.branches_are_curves() {
            return Ok(());
        }
        mechanism.position(landed, &mut self.position);
        let momentum = self.position.mass * landed.v;
        let share = momentum.dot(&(state.q - landed.q)) / momentum.dot(&landed.v);
        let still = self.position.drift.iter().all(|b| *b == T::zero());
        if !still || !share.is_finite() {
            return Ok(());
        }
        let mut nearest = State::new(state.t, landed.q + landed.v * share, landed.v);
        if self.land_regular(mechanism, &mut nearest)?.is_some() {
            *landed = nearest;
        }
        Ok(())
    }

    /// Whether a branch is a curve, as long as its constraints do not move.
    fn branches_are_curves(&self) -> bool {
        let one_freedom = self.rows.regular(Which::All) + 1 == N;
        one_freedom && self.rows.all_holonomic() && self.settings.branch_rows
    }

    /// The acceleration at a state that was interpolated.
    pub(super) fn bridged_acceleration(&self, state: &State<T, N>) -> Option<SVector<T, N>> {
        let (at, acceleration) = self.bridged.as_ref()?;
        (at == state).then_some(*acceleration)
    }

    /// The time from one pier to the next, none if there can be no piers.
    fn approach<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
    ) -> Result<Option<T>, DynamicsError<T>> {
        if !self.branches_are_curves() {
            return Ok(None);
        }
        mechanism.position(state, &mut self.position);
        if self.position.drift.iter().any(|b| *b != T::zero()) {
            return Ok(None);
        }
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        mechanism.branch(state, &mut self.branch);
        let mut fastest = T::zero();
        for row in 0..R {
            let vector = self.metric.lift(&self.branch.slope, row);
            fastest = fastest.max(norm(&vector) * self.rows.scale(row));
        }
        // K = 3Ȧ for constraints that do not move.
        let span = pier_distance::<T>() * T::from_f64(3.0) / fastest;
        Ok(span.is_finite().then_some(span))
    }

    /// Regular states on both sides; none if one of them is not regular.
    fn piers<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        span: T,
    ) -> Result<Option<[Pier<T, N>; 2 * PIERS]>, DynamicsError<T>> {
        let centre = Pier {
            place: T::zero(),
            offset: SVector::zeros(),
            v: state.v,
            a: SVector::zeros(),
        };
        let mut piers = [centre; 2 * PIERS];
        for i in 0..PIERS {
            let step = state.v * span;
            let outer = match i {
                0 => [-step, step],
                _ => outward([&piers[2 * i - 2].offset, &piers[2 * i - 1].offset], i),
            };
            for (pier, offset) in piers[2 * i..].iter_mut().zip(outer) {
                let mut at = State::new(state.t, state.q + offset, state.v);
                match self.land_regular(mechanism, &mut at) {
                    Ok(Some(_)) => {}
                    Ok(None) | Err(DynamicsError::ProjectionFailed { .. }) => return Ok(None),
                    Err(error) => return Err(error),
                }
                let a = self.regular_landed(mechanism, &at)?;
                (pier.offset, pier.v, pier.a) = (at.q - state.q, at.v, a);
            }
        }
        Ok(Some(piers))
    }

    /// The state on the branch that is nearest to `state` in the metric; none where
    /// more and fewer piers do not agree on it.
    fn middle<M: Mechanism<T, N, R> + ?Sized>(
        &mut self,
        mechanism: &M,
        state: &State<T, N>,
        mut piers: [Pier<T, N>; 2 * PIERS],
    ) -> Option<Pier<T, N>> {
        let mut at = *state;
        for _ in 0..DIRECTIONS {
            mechanism.position(&at, &mut self.position);
            let along = self.position.mass * at.v;
            for pier in &mut piers {
                pier.place = dot(&along.data.0[0], &pier.offset.data.0[0]);
            }
            let middle = interpolate(&piers);
            (at.q, at.v) = (state.q + middle.offset, middle.v);
        }
        let all = interpolate(&piers);
        let inner = interpolate(&piers[..2 * PIERS - 2]);
        let [.., behind, ahead] = &piers;
        let length = |x: SVector<T, N>| self.metric.factor.length(&x.data.0[0]);
        let agree = |part: fn(&Pier<T, N>) -> SVector<T, N>| {
            let size = length(part(&all)).max(length(part(ahead) - part(behind)));
            length(part(&all) - part(&inner)) <= on_bridge::<T>() * size
        };
        (agree(|p| p.offset) && agree(|p| p.v) && agree(|p| p.a)).then_some(all)
    }
}

/// Where the next two states are to be looked for, by the parabola through the
/// centre and the two before, `i` units away.
fn outward<T: Real, const N: usize>(
    [behind, ahead]: [&SVector<T, N>; 2],
    i: usize,
) -> [SVector<T, N>; 2] {
    let unit = T::from_f64(i as f64);
    let half = T::from_f64(0.5);
    let ratio = (unit + T::one()) / unit;
    let slope = (ahead - behind) * (ratio * half);
    let bend = (ahead + behind) * (ratio * ratio * half);
    [bend - slope, bend + slope]
}

/// Lagrange's interpolation at place zero.
fn interpolate<T: Real, const N: usize>(piers: &[Pier<T, N>]) -> Pier<T, N> {
    let mut sum = Pier {
        place: T::zero(),
        offset: SVector::zeros(),
        v: SVector::zeros(),
        a: SVector::zeros(),
    };
    for (i, pier) in piers.iter().enumerate() {
        let mut weight = T::one();
        for (j, other) in piers.iter().enumerate() {
            if i != j {
                weight *= other.place / (other.place - pier.place);
            }
        }
        sum.offset += pier.offset * weight;
        sum.v += pier.v * weight;
        sum.a += pier.a * weight;
    }
    sum
}
