//! The sheet of a mechanism as the product of those of its parts.
//!
//! In:  a [`Product`] of charts, a state near the sheet.
//! Out: what is asked of the [`Sheet`] of each part, put together.
//!
//! What happens in one part says nothing of the others: each is placed for itself, between
//! nodes of its own where its constraints are nearly singular.

use super::found::{Found, Searched};
use super::obstacle::Obstacle;
use super::part::{Frozen, Part, PartOf, Place};
use super::place::Placement;
use super::point::PointSlices;
use super::product::{ChartView, Product};
use super::sheet::{Kind, PointView, Sheet};
use super::stored_nodes::NodesSlices;
use crate::Real;
use crate::equations::{At, Equations};
use crate::linalg::{Workspace, is_finite};
use crate::once::compiled_once;
use core::cell::Cell;

/// What evaluates the sheet of a mechanism.
pub(crate) struct Sheets<'a, T> {
    pub(super) equations: &'a mut dyn Equations<T>,
    pub(super) chart: Product<'a, T>,
    pub(super) nodes: NodesSlices<'a, T>,
    /// Which rows restrict positions.
    pub(super) holonomic: &'a [bool],
    /// The row that came last where constraints were nearest to dependence.
    pub(super) weakest: &'a mut usize,
}

/// Something that is done on the sheet of a part.
type Work<'a, T> =
    &'a mut dyn FnMut(&Place, &mut Sheet<'_, T>, &Workspace<'_, T>) -> Result<(), Obstacle>;

impl<T: Real> Sheets<'_, T> {
    /// Does something on the sheet of each part that has constraints, until it fails. The
    /// other coordinates are those of a state, or where they were moved before.
    fn on_each(
        &mut self,
        state: At<'_, T>,
        workspace: &Workspace<'_, T>,
        work: Work<'_, T>,
    ) -> Result<(), Obstacle> {
        workspace.scope(|workspace| {
            let mut frozen = Frozen::new(state, workspace);
            let mut least = T::from_f64(f64::INFINITY);
            for (place, chart) in self.chart.factors() {
                if chart.rows.is_empty() {
                    continue;
                }
                let known = (&mut frozen, &mut least);
                workspace.scope(|inner| self.on_part(&place, chart, known, inner, work))?;
            }
            Ok(())
        })
    }

    /// Which of the rows of a chart restrict velocities only: one for each that does, zero for
    /// the others; empty if there are none.
    fn velocity_rows<'b>(
        &self,
        part: Part,
        chart: &ChartView<'_, T>,
        workspace: &Workspace<'b, T>,
    ) -> &'b [T] {
        let is_velocity = |row: &usize| !self.holonomic[part.row(*row)];
        if !chart.rows.iter().any(is_velocity) {
            return &[];
        }
        let velocity = workspace.numbers(chart.n());
        for (target, row) in velocity.iter_mut().zip(chart.rows) {
            if is_velocity(row) {
                *target = T::one();
            }
        }
        velocity
    }

    /// Does something on the sheet of a part.
    fn on_part(
        &mut self,
        place: &Place,
        chart: ChartView<'_, T>,
        (frozen, least): (&mut Frozen<'_, T>, &mut T),
        workspace: &Workspace<'_, T>,
        work: Work<'_, T>,
    ) -> Result<(), Obstacle> {
        let part = place.part;
        let is_curve = chart.freedoms == 1 && part.is_scleronomic(self.equations.structure());
        let holonomic = (0..part.r).any(|row| self.holonomic[part.row(row)]);
        let velocity = self.velocity_rows(part, &chart, workspace);
        let nodes = self.nodes.of(place.index, place.coordinates.clone());
        let mut own;
        let equations: &mut dyn Equations<T> = match part.is_whole() {
            true => self.equations,
            false => {
                own = PartOf::new(part, self.equations, frozen, workspace);
                &mut own
            }
        };
        let kind = Kind {
            holonomic,
            velocity,
            is_curve,
        };
        // Slices for those who hold borrows of their own.
        let mut free = workspace.all();
        let workspace = free.workspace();
        let mut sheet = Sheet::new(equations, chart, nodes, kind, &workspace);
        let done = work(place, &mut sheet, &workspace);
        let sine = sheet.smallest();
        if done.is_err() || sine < *least {
            *least = sine;
            // What comes last may be a row of the tangent space.
            let row = chart.rows.get(sheet.weakest_row()).or(chart.rows.first());
            *self.weakest = row.map_or(0, |row| part.row(*row));
        }
        done
    }
}

impl<T: Real> Sheets<'_, T> {
    /// Puts a state onto the sheet, and evaluates all terms there unless sheets cross nearby.
    fn place(
        &mut self,
        state: At<'_, T>,
        point: &mut PointSlices<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<Placement, Obstacle> {
        if !(state.t.is_finite() && is_finite(state.q) && is_finite(state.v)) {
            return Err(Obstacle::NotFinite);
        }
        let mut all = Placement::Regular;
        point.begin(state, &self.chart);
        self.on_each(state, workspace, &mut |place, sheet, workspace| {
            let own = place.part.state(state, workspace);
            let mut there = PointView::new(sheet.chart(), workspace);
            let placement = sheet.place(own, &mut there, workspace)?;
            point.keep(place, &there, placement);
            all = all.and(placement);
            Ok(())
        })?;
        // The terms at hand are those of the part that was measured last.
        if self.chart.has_several() && !all.is_crossing() {
            self.equations.evaluate(point.at());
        }
        Ok(all)
    }

    /// The geometry at a state as it is.
    fn measure(
        &mut self,
        state: At<'_, T>,
        point: &mut PointSlices<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Result<(), Obstacle> {
        point.begin(state, &self.chart);
        self.on_each(state, workspace, &mut |place, sheet, workspace| {
            let own = place.part.state(state, workspace);
            let mut there = PointView::new(sheet.chart(), workspace);
            sheet.measure_here(own, &mut there)?;
            point.keep(place, &there, Placement::Regular);
            Ok(())
        })
    }

    /// Counts the sheets crossed on the way from one state to another, `None` where that
    /// can't be told. If it is sought, also the fraction of the way up to which no crossing
    /// is seen.
    fn crossed(
        &mut self,
        (start, end): (At<'_, T>, At<'_, T>),
        seeks: bool,
        workspace: &Workspace<'_, T>,
    ) -> (Option<usize>, T) {
        let (mut count, mut part) = (Some(0), T::one());
        // No part returns an error here.
        let _ = self.on_each(start, workspace, &mut |place, sheet, workspace| {
            let ends = [start, end].map(|state| place.part.state(state, workspace));
            let (own, until) = sheet.crossed((ends[0], ends[1]), seeks, workspace);
            count = count.zip(own).map(|(count, own)| count + own);
            part = part.min(until);
            Ok(())
        });
        (count, part)
    }

    /// Whether no sheet is seen to be crossed on the way from one state to another.
    fn stays(
        &mut self,
        (start, end): (At<'_, T>, At<'_, T>),
        looks: usize,
        workspace: &Workspace<'_, T>,
    ) -> bool {
        let stays = self.on_each(start, workspace, &mut |place, sheet, workspace| {
            let ends = [start, end].map(|state| place.part.state(state, workspace));
            match sheet.stays((ends[0], ends[1]), looks, workspace) {
                true => Ok(()),
                false => Err(Obstacle::LeftSheet),
            }
        });
        stays.is_ok()
    }

    /// Whether other rows are far more independent than the chosen ones on the way from one state
    /// to another.
    fn chose_poorly(
        &mut self,
        (start, end): (At<'_, T>, At<'_, T>),
        workspace: &Workspace<'_, T>,
    ) -> bool {
        let mut poorly = false;
        // No part returns an error here.
        let _ = self.on_each(start, workspace, &mut |place, sheet, workspace| {
            let ends = [start, end].map(|state| place.part.state(state, workspace));
            poorly |= sheet.chose_poorly_between((ends[0], ends[1]), workspace);
            Ok(())
        });
        poorly
    }

    /// The passages of a step.
    fn passages(&mut self, step: &Searched<'_, T>, workspace: &Workspace<'_, T>) -> Found<T> {
        let mut found = Found::new(step);
        let (several, regular) = (self.chart.has_several(), self.chart.rank());
        let _ = self.on_each(step.start, workspace, &mut |place, sheet, workspace| {
            let n = step.start.q.len();
            let whole = Cell::new(workspace.any(n));
            let at = |t: T, q: &mut [T]| {
                let all = whole.take();
                (step.at)(t, all);
                place.part.take(all, q);
                whole.set(all);
            };
            let open = step.open.map(|(t, q)| {
                let own = workspace.any(sheet.chart().n());
                place.part.take(q, own);
                (t, &*own)
            });
            let own_step = Searched {
                start: place.part.state(step.start, workspace),
                at: &at,
                open,
                ..*step
            };
            let mut own = Found::new(step);
            sheet.passages(&own_step, &mut own, workspace);
            match several {
                true => found.add(&own, regular),
                false => found = own,
            }
            Ok(())
        });
        found
    }
}

compiled_once! {
    /// [`Sheets::place`].
    pub(crate) fn placing<T>: fn(
        &mut Sheets<'_, T>,
        At<'_, T>,
        &mut PointSlices<'_, T>,
        &Workspace<'_, T>,
    ) -> Result<Placement, Obstacle> =
        |sheets, state, point, workspace| sheets.place(state, point, workspace);

    /// [`Sheets::measure`].
    pub(crate) fn measuring<T>: fn(
        &mut Sheets<'_, T>,
        At<'_, T>,
        &mut PointSlices<'_, T>,
        &Workspace<'_, T>,
    ) -> Result<(), Obstacle> =
        |sheets, state, point, workspace| sheets.measure(state, point, workspace);

    /// [`Sheets::crossed`].
    pub(crate) fn counting<T>: fn(
        &mut Sheets<'_, T>,
        (At<'_, T>, At<'_, T>),
        bool,
        &Workspace<'_, T>,
    ) -> (Option<usize>, T) =
        |sheets, ends, seeks, workspace| sheets.crossed(ends, seeks, workspace);

    /// [`Sheets::stays`].
    pub(crate) fn staying<T>:
        fn(&mut Sheets<'_, T>, (At<'_, T>, At<'_, T>), usize, &Workspace<'_, T>) -> bool =
        |sheets, ends, looks, workspace| sheets.stays(ends, looks, workspace);

    /// [`Sheets::chose_poorly`].
    pub(crate) fn choosing_poorly<T>:
        fn(&mut Sheets<'_, T>, (At<'_, T>, At<'_, T>), &Workspace<'_, T>) -> bool =
        |sheets, ends, workspace| sheets.chose_poorly(ends, workspace);

    /// [`Sheets::passages`].
    pub(crate) fn finding<T>:
        fn(&mut Sheets<'_, T>, &Searched<'_, T>, &Workspace<'_, T>) -> Found<T> =
        |sheets, step, workspace| sheets.passages(step, workspace);
}
