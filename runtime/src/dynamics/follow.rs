//! Following a sheet of the constraint set from one accepted state to the next.
//!
//! In:  states of trial steps, and the news which of them were accepted.
//! Out: accelerations and projections on the sheet; refusals of steps that left it.
//!
//! Far from singular configurations nothing of this is needed. A step that turns out to
//! come near one is taken again with a chart.

use super::{Core, Source};
use crate::linalg::is_finite;
use crate::singular::{
    Found, Obstacle, Placed, Placement, Point, Searched, finding, solving_along,
};
use crate::state::all_finite;
use crate::tolerance::{regular, round_off, window};
use crate::{DynamicsError, Form, Mechanism, Real, Stabilisation, State, Step};
use nalgebra::SVector;

/// A start that is off the constraints by less than this, in units of round-off, stays
/// what it is to the last bit.
const MOST_ROUND_OFF: f64 = 8.0;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Begins a step at a state: goes on if it is the last accepted one.
    #[inline]
    pub(crate) fn begin_step(&mut self, state: &State<T, N>) {
        if self.session.base.as_ref() != Some(state) {
            self.session.begin(state);
            self.safe = None;
            self.expect_regular();
        }
        self.session.trial.lowest = T::one();
        self.session.trial.wants_chart = false;
        self.session.trial.crosses = false;
    }

    /// Whether accepted states are put onto the constraints.
    pub(crate) fn is_projected(&self) -> bool {
        self.settings.stabilisation == Stabilisation::Projection
    }

    /// Begins at a state, or at where it was put onto the constraints if it is not on them
    /// to round-off.
    #[inline(never)]
    pub(crate) fn start(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &mut State<T, N>,
        placed: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        mechanism.position(state, &mut self.position);
        let (worst, _) = self.residual(&self.position.residual);
        let (fastest, _) = self.residual(&self.position.speed(&state.v));
        let rate = self.metric.factor.length(&state.v.data.0[0]);
        let most = T::from_f64(MOST_ROUND_OFF) * round_off();
        // Comparisons with NaN are false, so that a residual that is NaN counts as off.
        let (is_on, stays_on) = (
            worst <= most * self.coordinate_scale.size,
            fastest <= most * rate,
        );
        let moved = self.metric.factor.length(&(placed.q - state.q).data.0[0]);
        let placed_elsewhere = self
            .session
            .trial
            .placed
            .as_ref()
            .is_some_and(|placed| placed.leaves);
        if is_on && (placed_elsewhere || moved > regular::<T>() * self.coordinate_scale.size) {
            return Err(self.refusal(mechanism, Obstacle::Undetermined, state.t));
        }
        if !is_on {
            *state = *placed;
        } else if !stays_on {
            state.v = placed.v;
        }
        if !is_on || !stays_on {
            self.session.begin(state);
        }
        Ok(())
    }

    /// Whether states of this step are put onto their sheet: forms that always have a
    /// chart do so next to singular configurations only.
    pub(crate) fn is_beside(&self) -> bool {
        self.settings.form == Form::Reduced || self.session.near
    }

    /// Whether singular configurations are looked after at all.
    pub(crate) fn follows(&self) -> bool {
        R > 0 && !self.settings.published
    }

    /// Whether no step of the null-space form can come near a singular configuration: there is
    /// none. Rows may look near-dependent all the same where masses differ by many orders of
    /// magnitude, and then have a chart.
    #[inline]
    pub(crate) fn is_regular_by_form(&self) -> bool {
        self.rows.by_form && self.settings.form == Form::Reduced && self.session.chart.is_none()
    }

    /// Whether the derivative at the end of a step is another one as soon as the step is accepted: off
    /// the constraints, accelerations by another chart differ.
    pub(crate) fn changes_chart(&self) -> bool {
        let charts = self.session.chart.is_some() || self.session.trial.chart.is_some();
        charts && !self.is_projected()
    }

    /// Takes note that the trial step needs a chart; the error with which it ends without one.
    #[cold]
    pub(crate) fn want_chart(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        t: T,
    ) -> DynamicsError<T> {
        self.session.trial.wants_chart = true;
        self.refusal(mechanism, Obstacle::Unresolved, t)
    }

    /// Makes a chart at the last accepted state if the trial step wanted one; whether it
    /// did.
    #[inline(never)]
    pub(crate) fn escalate(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
    ) -> Result<bool, DynamicsError<T>> {
        let wanted = core::mem::take(&mut self.session.trial.wants_chart);
        if wanted && self.session.chart.is_some() && !self.is_beside() {
            // The form has a chart anyway, by which the step was not judged yet.
            self.session.near = true;
            return Ok(true);
        }
        let Some(base) = self
            .session
            .base
            .filter(|_| wanted && self.session.chart.is_none())
        else {
            return Ok(false);
        };
        if self.session.at_rest {
            return Ok(false);
        }
        if mechanism.structure().assumed_regular {
            return Err(self.not_regular(mechanism, &base)?);
        }
        // Of redundant rows, others than the chosen ones may be far from dependence.
        if self.choose_better_rows(mechanism, &base)? && self.settings.form == Form::Reduced {
            return Ok(true);
        }
        match self.start_at(mechanism, &base)? {
            Some(chart) => {
                self.session.chart = Some(chart);
                self.session.near = true;
            }
            None if base.v == SVector::<T, N>::zeros() => {
                self.counters.undetermined += 1;
                self.session.at_rest = true;
            }
            None => {
                return Err(self.refusal(mechanism, Obstacle::Undetermined, base.t));
            }
        }
        self.expected = false;
        self.safe = None;
        Ok(true)
    }

    /// The error of constraints that were declared to be regular and are not.
    #[inline(never)]
    pub(super) fn not_regular(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<DynamicsError<T>, DynamicsError<T>> {
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let rank = self.rank_above(Source::Position, state.t, window())?;
        Ok(DynamicsError::NotRegular {
            t: state.t,
            rank,
            structure: mechanism.structure(),
        })
    }

    /// The acceleration on the sheet, at the state that a state of a trial step stands
    /// for.
    #[inline(never)]
    pub(super) fn acceleration_on_sheet(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let mut point = Point::zeros();
        let placement = self.place(mechanism, state, &mut point)?;
        match placement.is_crossing() {
            true => {
                self.counters.robust_accelerations += 1;
                mechanism.terms(&point.state, &mut self.terms);
            }
            // What the constraints demand was solved for with the terms at the same state.
            false => self.counters.beside_accelerations += 1,
        }
        let acceleration = self.accelerate(mechanism, &point)?;
        Ok(self.stabilised(acceleration, state, &point))
    }

    /// An acceleration on the sheet, or that which brings a state back onto it after
    /// Baumgarte (1972).
    pub(super) fn stabilised(
        &self,
        acceleration: SVector<T, N>,
        state: &State<T, N>,
        point: &Point<T, N>,
    ) -> SVector<T, N> {
        match self.settings.stabilisation {
            Stabilisation::Baumgarte { alpha, beta } => {
                let (off, fast) = (state.q - point.state.q, state.v - point.state.v);
                acceleration - fast * (alpha + alpha) - off * (beta * beta)
            }
            _ => acceleration,
        }
    }

    /// A chart at the last accepted state, for the forms that always need one.
    pub(super) fn require_chart(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.session.chart.is_none() {
            self.session.base.get_or_insert(*state);
            self.session.trial.wants_chart = true;
            let near = self.session.near;
            self.escalate(mechanism)?;
            self.session.near = near;
        }
        Ok(())
    }

    /// Puts a state onto the sheet of the chart at hand.
    pub(super) fn place(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        point: &mut Point<T, N>,
    ) -> Result<Placement, DynamicsError<T>> {
        let result = self
            .place_here(mechanism, state, point)
            .unwrap_or(Err(Obstacle::Undetermined));
        self.session.trial.crosses |= result.is_ok_and(Placement::is_crossing);
        result.map_err(|obstacle| self.refusal(mechanism, obstacle, state.t))
    }

    /// The acceleration at a state on the sheet, whose terms are in the buffer:
    /// `D̃ᵀM D̃ z = D̃ᵀ(p₁ − M aₚ)`, `q̈ = aₚ + D̃ z`. Source: Phong & Hoang (2012), section 3.
    fn accelerate(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        point: &Point<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let mut force = self.terms.force;
        self.terms.take_inertia(&mut force, &point.particular);
        Ok(point.particular + self.along_tangent(mechanism, point, force)?)
    }

    /// The velocity on the sheet that is nearest to a velocity, in the metric of the mass,
    /// at a state whose terms are in the buffer.
    fn velocity_on_sheet(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        point: &Point<T, N>,
        v: &SVector<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let mut momentum = SVector::zeros();
        self.terms.take_inertia(&mut momentum, &(point.drift - v));
        Ok(point.drift + self.along_tangent(mechanism, point, momentum)?)
    }

    /// `D̃ z` with `D̃ᵀM D̃ z = D̃ᵀf`, at a state whose terms are in the buffer.
    fn along_tangent(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        point: &Point<T, N>,
        mut force: SVector<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let solved = self.session.chart.as_ref().is_some_and(|chart| {
            solving_along()(
                &chart.view(),
                self.terms.mass.as_slice(),
                point.tangent.as_slice(),
                force.as_mut_slice(),
                &self.memory.workspace(),
            )
        });
        let t = point.state.t;
        match solved {
            true if all_finite(&force) => Ok(force),
            // The metric is definite, and so is the mass along what is a tangent space.
            false if is_finite(self.terms.mass.as_slice()) => {
                Err(self.refusal(mechanism, Obstacle::NotContracting, t))
            }
            _ => Err(DynamicsError::NotFinite { t }),
        }
    }

    /// The least acceleration at rest in a singular configuration: zero if it stays.
    #[inline(never)]
    pub(super) fn acceleration_at_rest(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<SVector<T, N>, DynamicsError<T>> {
        let least = self.published(mechanism, state)?;
        let size = self.metric.factor.length(&least.data.0[0]);
        let base = self.session.base.map(|base| (base.q, base.v));
        // The size of the acceleration elsewhere: in equilibrium the forces do not tell their own
        // size.
        let aside = self.lower([self.coordinate_scale.range * T::from_f64(0.25); N]);
        let moved = State::new(state.t, state.q + aside, state.v);
        let elsewhere = self.published(mechanism, &moved)?;
        let free = size.max(self.metric.factor.length(&elsewhere.data.0[0]));
        // A comparison with NaN is false, so that an acceleration that is NaN is refused, too.
        let stays = size <= free * T::EPSILON.sqrt() && base == Some((state.q, state.v));
        if stays {
            Ok(SVector::zeros())
        } else {
            Err(self.refusal(mechanism, Obstacle::Undetermined, state.t))
        }
    }

    /// Puts a state of a trial step onto the sheet.
    #[inline(never)]
    pub(crate) fn project_onto_sheet(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &mut State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let mut point = Point::zeros();
        let placement = self.place(mechanism, state, &mut point)?;
        if !placement.is_crossing() {
            // What is left out is orthogonal: round-off in the tangent space of a narrow gap
            // changes the energy by its square only.
            point.state.v = self.velocity_on_sheet(mechanism, &point, &state.v)?;
        }
        self.counters.robust_projections += 1;
        *state = point.state;
        let sine = point.sine();
        self.session.trial.end = sine * sine;
        self.session.trial.lowest = self.session.trial.lowest.min(self.session.trial.end);
        self.session.trial.placed = Some(Placed {
            tangent: point.tangent,
            drift: point.drift,
            met: point.met,
            leaves: matches!(placement, Placement::Crossing { leaves: true, .. }),
        });
        self.session.trial.strays = matches!(placement, Placement::Crossing { strays: true, .. });
        Ok(())
    }

    /// Refuses the state that was projected last if it was moved past another sheet.
    pub(crate) fn refuse_strayed(
        &self,
        mechanism: &dyn Mechanism<T, N, R>,
        t: T,
    ) -> Result<(), DynamicsError<T>> {
        match self.session.trial.strays {
            true => Err(self.refusal(mechanism, Obstacle::LeftSheet, t)),
            false => Ok(()),
        }
    }

    /// The passages after a time of a step that was accepted last.
    #[inline(never)]
    pub(crate) fn passages_after(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &Step<T, N>,
        after: T,
    ) -> Option<Found<T>> {
        let Some(chart) = self.session.step_chart.take() else {
            self.session.open_search = None;
            return None;
        };
        let at = |t, q: &mut [T]| q.copy_from_slice(step.inside_at(t).q.as_slice());
        let start = step.start;
        let open = self.session.open_search.filter(|(t, _)| *t < start.t);
        let searched = Searched {
            start: start.at(),
            length: step.end.t - start.t,
            after,
            tolerance: self.session.tolerance,
            rheonomic: !mechanism.structure().scleronomic,
            at: &at,
            open: open.as_ref().map(|(t, q)| (*t, q.as_slice())),
        };
        let mut found = None;
        self.on_sheet(mechanism, &chart, &mut |sheet, workspace| {
            found = Some(finding()(sheet, &searched, workspace));
        });
        self.session.step_chart = Some(chart);
        let left_open = found.as_ref().and_then(|found: &Found<T>| found.open);
        self.session.open_search = left_open.and_then(|t| match t < start.t {
            true => open,
            false => Some((t, step.inside_at(t).q)),
        });
        found
    }

    /// Takes note that a trial step was accepted.
    pub(crate) fn commit(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        step: &Step<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        self.session.base = Some(step.end);
        self.session.begins = false;
        if !self.rows.all_have_sizes() {
            self.verify_rows_without_size(mechanism, &step.end)?;
        }
        if !self.follows() || self.session.at_rest {
            return Ok(());
        }
        self.observe_coordinate_scale(mechanism, &step.end)?;
        if self.session.chart.is_none() {
            self.metric.view().observe_pivots();
        }
        self.session.sine = Some(self.session.trial.end.sqrt());
        self.session.near = self.session.trial.near;
        self.session.rate = self.session.trial.rate;
        self.session.step_chart = None;
        if self.session.chart.is_some() {
            hand_over(&mut self.session.chart, &mut self.session.step_chart);
        } else {
            if self.session.trial.inspection_chart.is_some() {
                let inspected = &mut self.session.trial.inspection_chart;
                hand_over(inspected, &mut self.session.step_chart);
            }
            if self.session.trial.by_emitted {
                self.learn_emitted_rows(mechanism, &step.end);
            }
        }
        if self.session.trial.chart.is_some() && !self.leaves_dependence(mechanism, &step.end)? {
            hand_over(&mut self.session.trial.chart, &mut self.session.chart);
        }
        self.expect_regular();
        Ok(())
    }

    /// Chooses other rows at the end of a step in which the chosen ones came near dependence;
    /// whether that was due to the choice alone.
    fn leaves_dependence(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        end: &State<T, N>,
    ) -> Result<bool, DynamicsError<T>> {
        let chooses = self.session.near && self.choose_better_rows(mechanism, end)?;
        self.session.near &= !chooses;
        Ok(chooses)
    }
}

/// Moves a chart to where it is kept: the one by which the inside of the step is searched later,
/// and the one for the next step. A function of its own: a chart is large, and most steps have
/// none.
#[inline(never)]
fn hand_over<C>(from: &mut Option<C>, to: &mut Option<C>) {
    *to = from.take();
}
