//! Simulates a part of a run and turns its states into rows.
//!
//! In:  a mechanism, a state, a [`Segment`].
//! Out: rows to a [`Watch`], [`Reached`].
//!
//! Compiled once for each pair of sizes.

use crate::column::Column;
use crate::segment::{CALM_SINE, EXTRA_STEPS, Reached, STEPS, Segment, Watch};
use bricard_runtime::{
    BadInterval, DynamicsError, Grid, Observer, Occurrence, Origin, Passage, Probe, State, Step,
    Summary, Whole, simulate,
};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Simulates a part of a run from a state.
///
/// # Errors
///
/// In words, why it could not begin. That it could not go on is no error here: what was
/// done until then is kept.
#[inline(never)]
pub(crate) fn segment<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    state: State<f64, N>,
    segment: &Segment,
    watch: &mut dyn Watch,
) -> Result<Reached, String> {
    let mut writer = Writer::new(segment, state, watch).map_err(|error| error.to_string())?;
    let begun = Instant::now();
    let result = simulate(mechanism, &state, &segment.options, &mut [&mut writer]);
    let wall = begun.elapsed();
    let (summary, error) = match result {
        Ok(summary) => (summary, None),
        Err(failure) => (failure.summary, Some(failure.error.to_string())),
    };
    Ok(Reached {
        error,
        wall,
        ..writer.reached(&summary)
    })
}

/// What is left of the last interval between rows is round-off up to this part of it, or of
/// the run, if that is shorter.
const SHORT: f64 = 1e-9;

/// Turns states into rows, and takes note of what happened on the way.
struct Writer<'a, const N: usize> {
    segment: &'a Segment,
    watch: &'a mut dyn Watch,
    /// The rows at equal distances, if they are.
    grid: Option<Grid<f64>>,
    /// States that are rows, and not written yet.
    sampled: Vec<State<f64, N>>,
    rows: u64,
    steps: u64,
    /// The state that this part begins with.
    first: State<f64, N>,
    /// The time of the last row (s).
    last: f64,
    /// The beginning of the run, once it has begun.
    origin: Option<Origin<f64>>,
    passages: Vec<Passage<f64>>,
    events: Vec<(usize, f64)>,
}

impl<'a, const N: usize> Writer<'a, N> {
    #[inline(never)]
    fn new(
        segment: &'a Segment,
        first: State<f64, N>,
        watch: &'a mut dyn Watch,
    ) -> Result<Self, BadInterval<f64>> {
        let mut grid = segment.every.map(Grid::new).transpose()?;
        let origin = segment.options.origin;
        if let (Some(grid), Some(origin)) = (&mut grid, origin) {
            grid.go_on(origin.t, segment.rows);
        }
        Ok(Self {
            segment,
            watch,
            grid,
            sampled: Vec::new(),
            rows: segment.rows,
            steps: 0,
            first,
            last: first.t,
            origin,
            passages: Vec::new(),
            events: Vec::new(),
        })
    }

    /// Where this part ended, and what was done in it.
    #[inline(never)]
    fn reached(self, summary: &Summary<f64, N>) -> Reached {
        let supplied = summary.energy_supplied.unwrap_or(0.0);
        let origin = self.origin.unwrap_or(Origin {
            t: self.first.t,
            energy: 0.0,
            supplied,
        });
        let constraint = summary.constraint_error.map_or(0.0, |error| error.position);
        Reached {
            state: row_of(&summary.end),
            origin: Origin { supplied, ..origin },
            rows: self.rows,
            error: None,
            steps: summary.steps,
            rejected: summary.rejected,
            wall: Duration::ZERO,
            constraint_error: constraint,
            energy_error: summary.energy_error.unwrap_or(0.0),
            energy_exchanged: summary.energy_exchanged.unwrap_or(0.0),
            passages: self.passages,
            events: self.events,
            counters: summary.counters,
        }
    }

    /// Whether this part ends with a state: where it is long enough, and the state is not
    /// next to a singular position.
    fn is_over(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<bool, DynamicsError<f64>> {
        self.steps += 1;
        Ok(self.segment.short
            && self.steps >= STEPS
            && (self.steps >= STEPS + EXTRA_STEPS || probe.rank(state)?.sine >= CALM_SINE))
    }

    /// Adds a row at the end of the run, where the last interval is a short one.
    fn end(&mut self, state: &State<f64, N>) {
        let until = self.segment.options.until;
        let Some(every) = self.segment.every.filter(|_| state.t >= until) else {
            return;
        };
        let last = self.sampled.last().map_or(self.last, |row| row.t);
        if state.t - last > every.min(until.abs()) * SHORT {
            self.sampled.push(*state);
        }
    }

    /// Hands the sampled states over as rows.
    #[inline(never)]
    fn write(
        &mut self,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        for state in std::mem::take(&mut self.sampled) {
            let row = row(&state, &self.segment.columns, probe)?;
            if self.watch.row(&row).is_break() {
                return Ok(ControlFlow::Break(()));
            }
            self.rows += 1;
            self.last = state.t;
        }
        Ok(ControlFlow::Continue(()))
    }
}

impl<const N: usize> Observer<f64, N> for Writer<'_, N> {
    fn begin(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        if self.origin.is_some() {
            // A later part: its first row is the last one of the part before.
            return Ok(ControlFlow::Continue(()));
        }
        let energy = probe.energy(state).balance;
        self.origin = Some(Origin {
            t: state.t,
            energy,
            supplied: 0.0,
        });
        // The projection of the start may have moved what is held by its round-off.
        let first = self.first;
        if let Some(grid) = &mut self.grid {
            grid.begin(first.t);
        }
        self.sampled.push(first);
        self.write(probe)
    }

    fn step(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        match &mut self.grid {
            Some(grid) => {
                while let Some(row) = grid.row(step, probe)? {
                    self.sampled.push(row);
                }
            }
            None => self.sampled.push(*step.end()),
        }
        self.end(step.end());
        if self.write(probe)?.is_break() || self.watch.at(step.end().t, 1).is_break() {
            return Ok(ControlFlow::Break(()));
        }
        match self.is_over(step.end(), probe)? {
            true => Ok(ControlFlow::Break(())),
            false => Ok(ControlFlow::Continue(())),
        }
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        self.passages.push(*passage);
        ControlFlow::Continue(())
    }

    fn event(&mut self, occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        self.events.push((occurrence.index, occurrence.state.t));
        ControlFlow::Continue(())
    }

    fn looks_inside(&self) -> bool {
        self.grid.is_some()
    }
}

/// The numbers of a row.
#[inline(never)]
fn row<const N: usize>(
    state: &State<f64, N>,
    columns: &[Column],
    probe: &mut dyn Probe<f64, N>,
) -> Result<Vec<f64>, DynamicsError<f64>> {
    let freedoms = probe.structure().freedoms().len();
    let mut row = vec![state.t];
    row.extend_from_slice(&state.q.as_slice()[..freedoms]);
    row.extend_from_slice(state.v.as_slice());
    let known = Known::of(state, columns, probe)?;
    for column in columns {
        row.push(match column {
            Column::Energy => {
                let energy = probe.energy(state);
                energy.kinetic + energy.potential
            }
            Column::Kinetic => probe.energy(state).kinetic,
            Column::Potential => probe.energy(state).potential,
            Column::ConstraintError => probe.constraint_error(state).position,
            Column::VelocityError => probe.constraint_error(state).velocity,
            Column::Rank => probe.rank(state)?.rank as f64,
            Column::Reaction(i) => known.reactions[*i],
            Column::Output(i) => known.outputs[*i],
            Column::Acceleration(i) => known.accelerations[*i],
            Column::Multiplier(i) => multiplier(state.t, *i, &known.multipliers, probe)?,
            Column::Input(i) => known.inputs[*i],
        });
    }
    Ok(row)
}

/// What is computed for all columns of a kind at once; nothing where no column asks.
#[derive(Default)]
struct Known {
    reactions: Vec<f64>,
    outputs: Vec<f64>,
    accelerations: Vec<f64>,
    multipliers: Vec<Option<f64>>,
    inputs: Vec<f64>,
}

impl Known {
    #[inline(never)]
    fn of<const N: usize>(
        state: &State<f64, N>,
        columns: &[Column],
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<Self, DynamicsError<f64>> {
        let structure = probe.structure();
        let mut known = Self::default();
        let any = |wanted: fn(&Column) -> bool| columns.iter().any(wanted);
        if any(|column| matches!(column, Column::Reaction(_))) {
            known.reactions = probe.reaction(state)?.as_slice().to_vec();
        }
        if any(|column| matches!(column, Column::Multiplier(_))) {
            known.multipliers = vec![None; structure.constraints.len()];
        }
        if any(|column| matches!(column, Column::Acceleration(_) | Column::Multiplier(_))) {
            let acceleration = probe.acceleration(state, &mut known.multipliers)?;
            known.accelerations = acceleration.as_slice().to_vec();
        }
        if any(|column| matches!(column, Column::Output(_))) {
            known.outputs = vec![0.0; structure.outputs.len()];
        }
        if any(|column| matches!(column, Column::Input(_))) {
            known.inputs = vec![0.0; structure.inputs.len()];
        }
        if !(known.outputs.is_empty() && known.inputs.is_empty()) {
            probe.outputs(state, &mut known.outputs, &mut known.inputs)?;
        }
        Ok(known)
    }
}

/// A multiplier, if the constraints determine it.
#[inline(never)]
fn multiplier<const N: usize>(
    t: f64,
    place: usize,
    known: &[Option<f64>],
    probe: &dyn Probe<f64, N>,
) -> Result<f64, DynamicsError<f64>> {
    let structure = probe.structure();
    let row = structure.multipliers[place].row;
    known[row].ok_or(DynamicsError::SharedReaction { t, row, structure })
}

/// A state as a row, with the integrals of states of the first order in it.
#[inline(never)]
fn row_of<const N: usize>(state: &State<f64, N>) -> Vec<f64> {
    let parts = [&[state.t], state.q.as_slice(), state.v.as_slice()];
    parts.concat()
}
