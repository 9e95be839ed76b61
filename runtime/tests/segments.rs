//! A run in parts, each of which knows where the whole began.

use crate::fixtures::{BEAD, Bead, Framed, Oscillator, PLAIN, simulate};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    DynamicsError, Interface, Mechanism, Observer, Options, Origin, Probe, Recorder, Sampler,
    State, Step, Summary,
};
use core::ops::ControlFlow;
use std::cell::RefCell;

/// Breaks a run off after some steps.
struct Segment(u64);

impl<const N: usize> Observer<f64, N> for Segment {
    fn step(
        &mut self,
        _step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        self.0 -= 1;
        Ok(match self.0 {
            0 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })
    }

    fn looks_inside(&self) -> bool {
        false
    }
}

/// A run in parts of some steps.
fn in_parts<M, const N: usize, const R: usize>(
    mechanism: &M,
    start: &State<f64, N>,
    options: &Options<f64>,
    steps: u64,
) -> Vec<Summary<f64, N>>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    let (mut state, mut origin, mut parts) = (*start, None, Vec::new());
    let energy = mechanism.energy(start).balance;
    loop {
        let options = Options { origin, ..*options };
        let part = simulate::<N, R>(mechanism, &state, &options, &mut [&mut Segment(steps)])
            .unwrap_or_else(|failure| panic!("{failure}"));
        parts.push(part);
        if !part.stopped || part.end.t >= options.until {
            return parts;
        }
        state = part.end;
        let supplied = part.energy_supplied.expect("the energy is audited");
        origin = Some(Origin {
            t: start.t,
            energy,
            supplied,
        });
    }
}

fn oscillator() -> (Framed<Oscillator, 1>, State<f64, 1>) {
    let start = State::new(0.3, SVector::from([1.0]), SVector::from([0.0]));
    (Framed::new(Oscillator { damping: 0.1 }, &PLAIN), start)
}

#[test]
fn parts_with_fixed_steps_have_the_bits_of_the_whole() {
    let (mechanism, start) = oscillator();
    for steps in [1, 7, 100] {
        let options = Options::rk4(7.0, 0.013);
        let whole = simulate::<1, 0>(&mechanism, &start, &options, &mut []).unwrap();
        let parts = in_parts::<_, 1, 0>(&mechanism, &start, &options, steps);
        assert_eq!(
            parts.last().map(|part| part.end),
            Some(whole.end),
            "{steps} steps"
        );
        assert_eq!(
            parts.iter().map(|part| part.steps).sum::<u64>(),
            whole.steps
        );
    }
}

#[test]
fn the_energy_of_a_run_in_parts_adds_up_from_its_beginning() {
    let (mechanism, start) = oscillator();
    let options = Options::dop853(20.0, 1e-10);
    let parts = in_parts::<_, 1, 0>(&mechanism, &start, &options, 5);
    let last = parts.last().expect("a part");
    let taken = mechanism.energy(&start).balance - mechanism.energy(&last.end).balance;
    let supplied = last.energy_supplied.expect("it is audited");
    assert!((supplied + taken).abs() < 1e-8, "{supplied} and {taken}");
    assert!(taken > 0.1);
    assert!(
        parts
            .iter()
            .all(|part| part.energy_error.is_some_and(|error| error < 1e-8))
    );
}

#[test]
fn energy_is_kept_where_it_was_when_the_whole_began() {
    let bead = Framed::new(
        Bead {
            radius: 1.0,
            rise: 0.0,
            weight: 9.81,
        },
        &BEAD,
    );
    let start = State::new(0.0, SVector::from([1.0, 0.0]), SVector::from([0.0, 0.0]));
    let mut options = Options::rk4(20.0, 0.01);
    options.keep_energy = true;
    let parts = in_parts::<_, 2, 1>(&bead, &start, &options, 3);
    let off = bead.energy(&parts.last().expect("a part").end).balance - bead.energy(&start).balance;
    assert!(off.abs() < 1e-7, "{off}");
}

#[test]
fn rows_go_on_where_they_ended() {
    let (mechanism, start) = oscillator();
    let options = Options::rk4(1.3, 0.1);
    let times = RefCell::new(Vec::new());
    let collect = |state: &State<f64, 1>| {
        times.borrow_mut().push(state.t);
        ControlFlow::Continue(())
    };
    let mut sampler = Sampler::new(0.25, collect).unwrap();
    sampler.go_on(0.0, 2);
    simulate::<1, 0>(&mechanism, &start, &options, &mut [&mut sampler]).unwrap();
    assert_eq!(times.take(), [0.5, 0.75, 1.0, 1.25]);
    // A run that nobody calls a continuation has a grid of its own.
    simulate::<1, 0>(&mechanism, &start, &options, &mut [&mut sampler]).unwrap();
    assert_eq!(times.take(), [0.3, 0.55, 0.8, 1.05, 1.3]);
}

#[test]
fn a_recorder_that_goes_on_has_the_rows_of_the_whole() {
    let (mechanism, start) = oscillator();
    let whole = Options::rk4(1.8, 0.1);
    let mut all = Recorder::new(0.25).unwrap();
    simulate::<1, 0>(&mechanism, &start, &whole, &mut [&mut all]).unwrap();
    // The part ends at the end of a step of the whole that is no row.
    let part = Options::rk4(1.0, 0.1);
    let mut recorder = Recorder::new(0.25).unwrap();
    let done = simulate::<1, 0>(&mechanism, &start, &part, &mut [&mut recorder]).unwrap();
    recorder.go_on(start.t, recorder.rows().len() as u64);
    let rest = Options {
        origin: Some(Origin {
            t: start.t,
            energy: mechanism.energy(&start).balance,
            supplied: done.energy_supplied.expect("it is audited"),
        }),
        ..whole
    };
    simulate::<1, 0>(&mechanism, &done.end, &rest, &mut [&mut recorder]).unwrap();
    assert_eq!(recorder.rows(), all.rows());
    assert_eq!(recorder.rows().len(), 7);
}
