//! Who is told of a run.
//!
//! In:  steps, events, passages.
//! Out: rows in a place of the program around, calls of its functions. Nothing is
//!      allocated.

use crate::callback::{Callback, EventFunction, GoOnFunction, PassageFunction, TakeFunction};
use bricard_runtime::{
    DynamicsError, Grid, Observer, Occurrence, Passage, Probe, State, Step, Structure,
};
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, Ordering};

/// Steps between questions whether to go on.
const STEPS_BETWEEN_QUESTIONS: u64 = 64;
/// Most rows within a step.
pub(crate) const MOST_INSIDE: u32 = 32;

/// What rows hold besides time, coordinates and velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Columns(u32);

impl Columns {
    const OUTPUTS: u32 = 1;
    const REACTIONS: u32 = 2;
    const ENERGIES: u32 = 4;
    const ERRORS: u32 = 8;
    const ALL: u32 = 15;

    /// The columns of some bits, if all of them mean something.
    pub(crate) fn of(bits: u32) -> Option<Self> {
        (bits & !Self::ALL == 0).then_some(Self(bits))
    }

    fn has(self, bit: u32) -> bool {
        self.0 & bit != 0
    }

    /// Numbers in a row.
    pub(crate) fn width(self, structure: &Structure, n: usize) -> usize {
        let outputs = structure.outputs.len();
        let added = [
            (Self::OUTPUTS, outputs),
            (Self::REACTIONS, structure.freedoms().len()),
            (Self::ENERGIES, 2),
            (Self::ERRORS, 2),
        ];
        let added = added.iter().filter(|(bit, _)| self.has(*bit));
        1 + structure.freedoms().len() + n + added.map(|(_, count)| count).sum::<usize>()
    }

    /// Writes a row, which is as long as [`width`](Self::width) says.
    fn write<const N: usize>(
        self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
        row: &mut [f64],
    ) -> Result<(), DynamicsError<f64>> {
        let freedoms = probe.structure().freedoms().len();
        row[0] = state.t;
        row[1..=freedoms].copy_from_slice(&state.q.as_slice()[..freedoms]);
        let (velocities, mut rest) = row[1 + freedoms..].split_at_mut(N);
        velocities.copy_from_slice(state.v.as_slice());
        if self.has(Self::OUTPUTS) {
            let (outputs, left) = rest.split_at_mut(probe.structure().outputs.len());
            probe.outputs(state, outputs, &mut [])?;
            rest = left;
        }
        if self.has(Self::REACTIONS) {
            let (reactions, left) = rest.split_at_mut(freedoms);
            reactions.copy_from_slice(&probe.reaction(state)?.as_slice()[..freedoms]);
            rest = left;
        }
        if self.has(Self::ENERGIES) {
            let energy = probe.energy(state);
            let (energies, left) = rest.split_at_mut(2);
            energies.copy_from_slice(&[energy.kinetic, energy.potential]);
            rest = left;
        }
        if self.has(Self::ERRORS) {
            let error = probe.constraint_error(state);
            rest.copy_from_slice(&[error.position, error.velocity]);
        }
        Ok(())
    }
}

/// Where rows go.
#[derive(Debug)]
pub struct Sheet<'a> {
    pub(crate) columns: Columns,
    /// Numbers in a row.
    pub(crate) width: usize,
    pub(crate) rows: &'a mut [f64],
    /// Rows that were written and not taken.
    pub(crate) written: usize,
    pub(crate) take: Option<Callback<TakeFunction>>,
    /// Whether rows are not wanted at all.
    pub(crate) none: bool,
}

/// Why a run ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Somebody wanted it to.
    Stopped,
    /// The rows are full.
    Full,
}

impl Sheet<'_> {
    /// Adds a row; why not, if it could not.
    fn add<const N: usize>(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<Option<Ended>, DynamicsError<f64>> {
        if self.none {
            return Ok(None);
        }
        if (self.written + 1) * self.width > self.rows.len() {
            if self.take.is_none() {
                return Ok(Some(Ended::Full));
            }
            if !self.hand_over() {
                return Ok(Some(Ended::Stopped));
            }
        }
        let begin = self.written * self.width;
        let row = &mut self.rows[begin..begin + self.width];
        self.columns.write(state, probe, row)?;
        self.written += 1;
        Ok(None)
    }

    /// Gives away what was written; whether to go on.
    pub(crate) fn hand_over(&mut self) -> bool {
        match (&self.take, self.written) {
            (Some(take), count) if count > 0 => {
                self.written = 0;
                take.take(self.rows, count)
            }
            _ => true,
        }
    }
}

/// Who wants to know what.
#[derive(Debug)]
pub struct Listeners<'a> {
    pub(crate) sheet: Sheet<'a>,
    /// Distance of the rows (s); a row after each step if there is none.
    pub(crate) every: Option<f64>,
    /// Rows within each step, where there is one after each.
    pub(crate) inside: u32,
    pub(crate) event: Option<Callback<EventFunction>>,
    pub(crate) passage: Option<Callback<PassageFunction>>,
    pub(crate) go_on: Option<Callback<GoOnFunction>>,
}

impl Listeners<'_> {
    /// Nobody wants to know anything.
    pub(crate) fn quiet() -> Self {
        Self {
            sheet: Sheet {
                columns: Columns::default(),
                width: 0,
                rows: &mut [],
                written: 0,
                take: None,
                none: true,
            },
            every: None,
            inside: 0,
            event: None,
            passage: None,
            go_on: None,
        }
    }
}

/// Makes rows of steps, and tells those who listen.
pub(crate) struct Writer<'a, 'b> {
    listeners: &'b mut Listeners<'a>,
    /// The rows at equal distances, if they are.
    grid: Option<Grid<f64>>,
    stop: &'b AtomicBool,
    steps: u64,
    pub(crate) ended: Option<Ended>,
}

impl<'a, 'b> Writer<'a, 'b> {
    pub(crate) fn new(
        listeners: &'b mut Listeners<'a>,
        grid: Option<Grid<f64>>,
        stop: &'b AtomicBool,
    ) -> Self {
        Self {
            listeners,
            grid,
            stop,
            steps: 0,
            ended: None,
        }
    }

    fn add<const N: usize>(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let ended = self.listeners.sheet.add(state, probe)?;
        Ok(self.end(ended))
    }

    /// Breaks the run off if there is a reason.
    fn end(&mut self, reason: Option<Ended>) -> ControlFlow<()> {
        self.ended = self.ended.or(reason);
        match self.ended {
            None => ControlFlow::Continue(()),
            Some(_) => ControlFlow::Break(()),
        }
    }

    /// The rows of a step.
    fn rows<const N: usize>(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        loop {
            let row = match &mut self.grid {
                Some(grid) => grid.row(step, probe)?,
                None => return self.rows_inside(step, probe),
            };
            let Some(row) = row else {
                return Ok(ControlFlow::Continue(()));
            };
            if self.add(&row, probe)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
    }

    /// A row at the end of a step, and before it others at Chebyshev points, which determine a
    /// polynomial best.
    fn rows_inside<const N: usize>(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let inside = self.listeners.inside;
        let intervals = f64::from(inside + 1);
        for number in 1..=inside {
            let angle = f64::from(number) / intervals * core::f64::consts::PI;
            let t = step.start().t + step.length() * 0.5 * (1.0 - angle.cos());
            if self.add(&step.at(t), probe)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        self.add(step.end(), probe)
    }

    /// Whether somebody wants the run to end.
    fn asked(&mut self, t: f64) -> Option<Ended> {
        self.steps += 1;
        let question = self.steps.is_multiple_of(STEPS_BETWEEN_QUESTIONS);
        let go_on = &self.listeners.go_on;
        let refused = question
            && go_on
                .as_ref()
                .is_some_and(|go_on| !go_on.ask(t, self.steps));
        (refused || self.stop.load(Ordering::Relaxed)).then_some(Ended::Stopped)
    }
}

impl<const N: usize> Observer<f64, N> for Writer<'_, '_> {
    fn begin(
        &mut self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        if let Some(grid) = &mut self.grid {
            grid.begin(state.t);
        }
        self.add(state, probe)
    }

    fn step(
        &mut self,
        step: &Step<f64, N>,
        probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        if self.rows(step, probe)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let ended = self.asked(step.end().t);
        Ok(self.end(ended))
    }

    fn event(&mut self, occurrence: &Occurrence<f64, N>) -> ControlFlow<()> {
        let (index, rising) = (occurrence.index, occurrence.rising);
        let State { t, q, v } = &occurrence.state;
        let told = self.listeners.event.as_ref();
        let on = told.is_none_or(|told| told.tell((index, rising), *t, q.as_slice(), v.as_slice()));
        self.end((!on).then_some(Ended::Stopped))
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        let ranks = (passage.rank, passage.regular);
        let told = self.listeners.passage.as_ref();
        let on = told.is_none_or(|told| told.tell(passage.t, passage.sine, ranks));
        self.end((!on).then_some(Ended::Stopped))
    }

    fn looks_inside(&self) -> bool {
        self.grid.is_some() || self.listeners.inside > 0
    }
}
