//! Whether a trial step may be accepted.
//!
//! In:  the ends of a trial step, what its states came to.
//! Out: the chart at its end, or a refusal: the step leapt over a singular configuration
//!      that was not seen, left its sheet, or lost energy.

use super::{Core, Source, Which};
use crate::singular::{
    Chart, Obstacle, Placed, Point, choosing_poorly, counting, smallest_sine, staying,
};
use crate::tolerance::{accepted, excusable, safe_steps, window};
use crate::{DynamicsError, Form, Mechanism, Real, State, Structure, Watched};

/// A sine that falls below this part of its values at both ends of a step may have been zero in
/// between.
const FALL: f64 = 0.9;
/// A step without a chart is inspected at the ends of at least and at most so many parts: in each a
/// coordinate moves about as far as in a step that is not long.
const LOOKS: usize = 4;
const MOST_LOOKS: usize = 64;
/// Constraint error beside a singular configuration, in units of the tolerance, that may remain
/// where positions are not projected. By experiment: with more, motions change branches unseen.
const DRIFT: f64 = 1.0;
/// Square of the sine, in units of the constraint error, above which an error does not decide which
/// branch is taken.
const GAPS: f64 = 100.0;

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Verifies a trial step before it is accepted.
    pub(crate) fn verify(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        start: &State<T, N>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if !self.follows() || self.session.at_rest || self.is_regular_by_form() {
            return Ok(());
        }
        if self.session.sine.is_none() {
            self.session.sine = Some(self.sine_at(mechanism, start)?);
        }
        if !self.is_projected() {
            self.verify_drift(mechanism, end)?;
        }
        match self.session.chart {
            None => {
                if self.metric.hides_dependence() {
                    self.uncover_dependence(mechanism, end)?;
                }
                self.verify_far(mechanism, start, end)
            }
            Some(_) => self.verify_beside(mechanism, start, end),
        }
    }

    /// Takes note of the sine at the end of a step, where rows alone do not show it.
    #[inline(never)]
    fn uncover_dependence(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        mechanism.position(end, &mut self.position);
        let factorised = self.factorise_metric(mechanism, Source::Position, end.t);
        let squared = match (factorised, self.metric.hides_dependence()) {
            (Ok(()), true) => self.metric.smallest_pivot(),
            (Ok(()), false) => T::one(),
            (Err(DynamicsError::MassSingular { .. }), true) => T::zero(),
            (Err(error), _) => return Err(error),
        };
        self.session.trial.end = self.session.trial.end.min(squared);
        self.session.trial.lowest = self.session.trial.lowest.min(squared);
        Ok(())
    }

    /// Verifies a step with a chart, which is needed only where a state was near a singular
    /// configuration. A chart is large, and so is the stack of functions that take it: what most
    /// steps need is in functions of their own.
    #[inline(never)]
    fn verify_beside(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        start: &State<T, N>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if !self.is_beside() {
            self.session.chart = None;
            return self.verify_far(mechanism, start, end);
        }
        let held = self.held_powers(mechanism, [start, end])?;
        let Some(chart) = self.session.chart.take() else {
            return self.verify_far(mechanism, start, end);
        };
        let result = self.verify_near(mechanism, &chart, (start, end), held);
        self.session.chart = Some(chart);
        result
    }

    /// The sine of the constraints where nothing is known of it yet.
    #[inline(never)]
    fn sine_at(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<T, DynamicsError<T>> {
        mechanism.position(state, &mut self.position);
        self.factorise_metric(mechanism, Source::Position, state.t)?;
        let squared = self.factorise_constraints(Source::Position, Which::All);
        Ok(squared.sqrt())
    }

    /// Verifies a step without a chart: was it far from singular configurations all the way? Four
    /// things make that doubtful: the sine was smaller within the step than at both ends; the step
    /// is longer than the rate of the sine allows; the next step needs a chart; a coordinate moved
    /// far.
    fn verify_far(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        start: &State<T, N>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.session.trial.chart.is_some() {
            self.session.trial.chart = None;
        }
        if self.session.trial.inspection_chart.is_some() {
            self.session.trial.inspection_chart = None;
        }
        let after = self.session.trial.end.sqrt();
        let lowest = self.session.trial.lowest.sqrt().min(after);
        let before = self.session.sine.unwrap_or(after);
        let dips = lowest < before.min(after) * T::from_f64(FALL);
        let length = end.t - start.t;
        let comes_near = self.needs_chart((before, after, lowest), length);
        // A step may be longer than the one before it, and the sine may change faster.
        let change = self.session.rate.max(self.session.trial.rate) * length;
        let outruns_rate = before < window::<T>() + safe_steps::<T>() * change;
        if !dips && !outruns_rate && !comes_near && !self.is_long(start, end) {
            return Ok(());
        }
        if after <= window() {
            return Err(self.want_chart(mechanism, end.t));
        }
        self.look_between(mechanism, (start, end), comes_near)?;
        // Where nothing keeps a motion on the constraints, its energy drifts together with it.
        match outruns_rate && self.is_projected() {
            true => {
                let held = self.held_powers(mechanism, [start, end])?;
                self.verify_energy(mechanism, (start, end), held)
            }
            false => Ok(()),
        }
    }

    /// Whether a coordinate has moved so far in a step that the sine may have fallen and grown
    /// again between the states at which it was seen. Any step is long where the sine is seen at
    /// its ends alone.
    fn is_long(&self, start: &State<T, N>, end: &State<T, N>) -> bool {
        self.metric.hides_dependence() || self.stretch(start, end) > T::one()
    }

    /// The largest movement of a coordinate, in units of how far it may move in a step that is not
    /// long.
    pub(super) fn stretch(&self, start: &State<T, N>, end: &State<T, N>) -> T {
        let ([from], [to]) = (&start.q.data.0, &end.q.data.0);
        let moved = from.iter().zip(to).zip(&self.far);
        moved.fold(T::zero(), |most, ((from, to), far)| {
            most.max((*to - *from).abs() / *far)
        })
    }

    /// A step that may have leapt over a singular configuration: do signs change on its way?
    #[inline(never)]
    fn look_between(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        (start, end): (&State<T, N>, &State<T, N>),
        comes_near: bool,
    ) -> Result<(), DynamicsError<T>> {
        let Some(chart) = self.chart_at_trial(mechanism, end)? else {
            return Err(self.want_chart(mechanism, end.t));
        };
        let stretch = self.stretch(start, end);
        let looks = (LOOKS..MOST_LOOKS).find(|looks| stretch <= T::from_f64(*looks as f64));
        let looks = looks.unwrap_or(MOST_LOOKS);
        let mut stays = false;
        self.on_sheet(mechanism, &chart, &mut |sheet, workspace| {
            stays = staying()(sheet, (start.at(), end.at()), looks, workspace);
        });
        if !stays {
            return Err(self.want_chart(mechanism, end.t));
        }
        // Charts are large, so that none is copied in vain.
        if comes_near {
            self.session.trial.chart = Some(chart);
        }
        if self.is_long(start, end) {
            self.session.trial.inspection_chart = Some(chart);
        }
        Ok(())
    }

    /// A chart at a state of a trial step, which teaches nothing of the rows.
    fn chart_at_trial(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
    ) -> Result<Option<Chart<T, N, R>>, DynamicsError<T>> {
        if self.rows.all_independent() {
            return self.start_at(mechanism, state);
        }
        let known = self.rows.clone();
        let chart = self.start_at(mechanism, state);
        self.rows = known;
        chart
    }

    /// Whether the next step needs a chart: it may come near a singular configuration, or
    /// the form always uses one.
    fn needs_chart(&mut self, (before, after, lowest): (T, T, T), length: T) -> bool {
        let change = before.max(after) - lowest;
        self.session.trial.rate = change / length;
        self.session.trial.near = after < window::<T>() + safe_steps::<T>() * change;
        self.settings.form != Form::Reduced || self.session.trial.near
    }

    /// Verifies a step with a chart: is its end on the same sheet?
    #[inline(never)]
    fn verify_near(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        (start, end): (&State<T, N>, &State<T, N>),
        held: [T; 2],
    ) -> Result<(), DynamicsError<T>> {
        self.session.trial.chart = None;
        self.verify_choice(mechanism, chart, start, end)?;
        let (form, structure) = (self.settings.form, mechanism.structure());
        let seeks = form.passes() && !structure.assumed_regular && !self.session.trial.crosses;
        let (mut changes, mut part) = (None, T::one());
        self.on_sheet(mechanism, chart, &mut |sheet, workspace| {
            let ends = (start.at(), end.at());
            (changes, part) = counting()(sheet, ends, seeks, workspace);
        });
        if changes != Some(0) && structure.assumed_regular {
            return Err(self.not_regular(mechanism, end)?);
        }
        if changes != Some(0) && !form.passes() {
            let rank = self.rows.regular - changes.unwrap_or(1);
            return Err(DynamicsError::SingularPosition {
                t: end.t,
                form,
                rank,
                structure,
            });
        }
        if seeks && changes != Some(0) {
            self.verify_crossing(mechanism, chart, &start.towards(end, part))?;
        }
        self.verify_energy(mechanism, (start, end), held)?;
        let Some(placed) = self.session.trial.placed.take() else {
            return Ok(());
        };
        let sine = smallest_sine(&placed.met);
        let before = self.session.sine.unwrap_or(sine);
        let lowest = self.session.trial.lowest.sqrt().min(sine);
        let is_beside_gap = placed.met.iter().any(|met| met.gap);
        if !self.needs_chart((before, sine, lowest), end.t - start.t) && !is_beside_gap {
            return Ok(());
        }
        self.factorise_end(mechanism, end)?;
        self.verify_residual(mechanism, end)?;
        let next = self.chart_after(structure, chart, end, placed);
        if next.is_none() {
            return Err(self.refusal(mechanism, Obstacle::NotRegular, end.t));
        }
        self.session.trial.chart = next;
        Ok(())
    }

    /// Refuses a step with redundant rows on which the chosen rows, the most independent ones at
    /// its start, do not remain about the most independent: their determinant tells where sheets
    /// cross.
    fn verify_choice(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        start: &State<T, N>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        if self.rows.all_independent() {
            return Ok(());
        }
        let mut poorly = false;
        self.on_sheet(mechanism, chart, &mut |sheet, workspace| {
            poorly = choosing_poorly()(sheet, (start.at(), end.at()), workspace);
        });
        match poorly {
            true => Err(self.refusal(mechanism, Obstacle::Unresolved, end.t)),
            false => Ok(()),
        }
    }

    /// Evaluates the constraints at the end of a step with a chart, and factorises the metric,
    /// unless charts have a metric of their own.
    fn factorise_end(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        mechanism.position(end, &mut self.position);
        match self.metric.hides_dependence() {
            true => Ok(()),
            false => self.factorise_metric(mechanism, Source::Position, end.t),
        }
    }

    /// The chart at the end of a step, where that was placed; none if it is not regular.
    #[inline(never)]
    fn chart_after(
        &mut self,
        structure: &'static Structure,
        chart: &Chart<T, N, R>,
        end: &State<T, N>,
        placed: Placed<T, N>,
    ) -> Option<Chart<T, N, R>> {
        let (rows, jacobian) = (&self.rows, &self.position.jacobian);
        let other = self.metric.of_chart(&self.position.mass, jacobian, rows);
        let other = other.ok()?;
        let workspace = self.memory.workspace();
        let mut next = Chart::new(
            end,
            placed.tangent,
            other.as_ref().unwrap_or(&self.metric.factor),
            (rows, jacobian),
            (
                self.coordinate_scale,
                &self.sizes,
                accepted(self.session.tolerance),
            ),
            structure.components,
            &workspace,
        )?;
        next.set_drift(&placed.drift, &end.v, Some(chart));
        let factors = next.factors_mut().iter_mut().zip(chart.factors());
        for ((next, before), met) in factors.zip(&placed.met) {
            next.spacing = met.spacing;
            next.gap = met.gap || before.gap && met.sine < window();
        }
        Some(next)
    }

    /// A step on which signs changed, none of whose states is next to a singular
    /// configuration: is there one where sheets cross, at this state of it, or did it leap
    /// over a gap?
    #[inline(never)]
    fn verify_crossing(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        chart: &Chart<T, N, R>,
        state: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let mut point = Point::zeros();
        let (mut solver, workspace, _) = self.lend(mechanism);
        match solver.place(chart, state, &mut point, &workspace) {
            Ok(placement) if placement.is_crossing() => Ok(()),
            _ => Err(self.refusal(mechanism, Obstacle::LeftSheet, state.t)),
        }
    }

    /// All constraint equations, in their own units, at the position in the buffer.
    fn verify_residual(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let (worst, _) = self.residual(&self.position.residual);
        // A comparison with NaN is false, so that a residual that is NaN counts as large.
        match self.is_negligible(worst) || !self.is_projected() {
            true => Ok(()),
            false => Err(self.failed(mechanism, end)),
        }
    }

    /// Refuses a step that ends off the constraints where its sine is not large enough to tell
    /// sheets apart: where they would cross, a constraint error keeps them about the root of itself
    /// apart.
    #[inline(never)]
    fn verify_drift(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        end: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        mechanism.position(end, &mut self.position);
        let (worst, _) = self.residual(&self.position.residual);
        if !worst.is_finite() {
            let (t, quantity) = (end.t, Watched::ConstraintError);
            return Err(DynamicsError::WatchedNotFinite { t, quantity });
        }
        let drift = worst / self.coordinate_scale.range;
        let tolerance = self.session.tolerance.unwrap_or(T::zero());
        let is_accurate = drift <= excusable::<T>().max(tolerance * T::from_f64(DRIFT));
        // A step with a chart may have crossed another sheet.
        let squared_sine = match self.session.chart.is_some() && self.is_beside() {
            true => T::zero(),
            false => self.session.trial.lowest.min(self.session.trial.end),
        };
        match is_accurate || squared_sine > drift * T::from_f64(GAPS) {
            true => Ok(()),
            false => Err(self.refusal(mechanism, Obstacle::Drifted, end.t)),
        }
    }
}
