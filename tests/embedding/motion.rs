//! What the program in C says, held against the same in Rust.

use crate::program::{Language, Linked, compile, finished};
use bricard_capi::{Choices, Interface as Table, Point, Summary, Watch};
use bricard_embedding::double_pendulum::DoublePendulum;
use bricard_embedding::engine::Engine;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    DynamicsError, Initial, Interface, Mechanism, Method, Observer, Occurrence, Options, Passage,
    Position, Probe, Recorder, Settings, Solver, State, Step, StepControl, Stepper, Terms,
    assemble, simulate,
};
use std::mem::{offset_of, size_of};
use std::ops::ControlFlow;
use std::process::Command;
use std::sync::LazyLock;

/// What the program in C said: words, each with numbers.
static SAID: LazyLock<Vec<(String, Vec<f64>)>> = LazyLock::new(|| {
    let program = compile("motion", Language::C, Linked::Shared);
    let text = finished(&mut Command::new(program));
    text.lines().map(line).collect()
});

fn line(line: &str) -> (String, Vec<f64>) {
    let mut words = line.split_whitespace();
    let word = words.next().expect("no empty lines").to_string();
    (word, words.map(number).collect())
}

/// A number as `%a` prints it.
fn number(text: &str) -> f64 {
    let (sign, text) = match text.strip_prefix('-') {
        Some(text) => (-1.0, text),
        None => (1.0, text),
    };
    let parts = text
        .strip_prefix("0x")
        .and_then(|text| text.split_once('p'));
    let (digits, power) = parts.unwrap_or_else(|| panic!("{text} is no number"));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mantissa = u64::from_str_radix(&format!("{whole}{fraction}"), 16).expect("digits");
    let power: i32 = power.parse().expect("a power of two");
    // Each factor is exact: at most 53 bits, and powers of two.
    sign * mantissa as f64 * 2.0_f64.powi(power - 4 * fraction.len() as i32)
}

/// All that was said with a word.
fn said(wanted: &str) -> Vec<Vec<f64>> {
    let with = SAID.iter().filter(|(word, _)| word == wanted);
    with.map(|(_, numbers)| numbers.clone()).collect()
}

fn row(state: &State<f64, 3>) -> Vec<f64> {
    let values = state.q.iter().chain(state.v.iter());
    std::iter::once(&state.t).chain(values).copied().collect()
}

fn engine() -> (Engine<f64>, State<f64, 3>) {
    let engine = Engine::default();
    let state = assemble(&engine, &engine.start(), 0.0).expect("it assembles");
    (engine, state)
}

/// Writes down what the program in C is told.
#[derive(Default)]
struct Diary {
    rows: Vec<Vec<f64>>,
    events: Vec<Vec<f64>>,
    passages: Vec<Vec<f64>>,
}

impl Diary {
    fn add(
        &mut self,
        state: &State<f64, 3>,
        probe: &mut dyn Probe<f64, 3>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let mut row = row(state);
        let mut outputs = [0.0; 3];
        probe.outputs(state, &mut outputs, &mut [])?;
        row.extend(outputs);
        row.extend(&probe.reaction(state)?);
        let energy = probe.energy(state);
        row.extend([energy.kinetic, energy.potential]);
        let error = probe.constraint_error(state);
        row.extend([error.position, error.velocity]);
        self.rows.push(row);
        Ok(ControlFlow::Continue(()))
    }
}

impl Observer<f64, 3> for Diary {
    fn begin(
        &mut self,
        state: &State<f64, 3>,
        probe: &mut dyn Probe<f64, 3>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        self.add(state, probe)
    }

    fn step(
        &mut self,
        step: &Step<f64, 3>,
        probe: &mut dyn Probe<f64, 3>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        self.add(step.end(), probe)
    }

    fn event(&mut self, occurrence: &Occurrence<f64, 3>) -> ControlFlow<()> {
        let State { t, q, v } = occurrence.state;
        let rising = f64::from(u8::from(occurrence.rising));
        let event = vec![occurrence.index as f64, rising, t, q[0], v[0]];
        self.events.push(event);
        ControlFlow::Continue(())
    }

    fn passage(&mut self, passage: &Passage<f64>) -> ControlFlow<()> {
        let ranks = [passage.rank as f64, passage.regular as f64];
        self.passages
            .push(vec![passage.t, passage.sine, ranks[0], ranks[1]]);
        ControlFlow::Continue(())
    }
}

#[test]
fn a_run_has_the_bits_of_the_run_in_rust() {
    let (engine, start) = engine();
    let mut diary = Diary::default();
    let options = Options::dop853(8.0, 1e-9);
    let done = simulate(&engine, &start, &options, &mut [&mut diary]).expect("it runs");
    assert!(done.events > 1 && done.passages.is_some_and(|passages| passages > 2));
    assert_eq!(said("row"), diary.rows);
    assert_eq!(said("event"), diary.events);
    assert_eq!(said("passage"), diary.passages);
    assert_eq!(said("end"), [row(&done.end)]);
    let summary = vec![
        done.steps as f64,
        done.rejected as f64,
        done.evaluations as f64,
        done.events as f64,
        done.passages.unwrap_or(0) as f64,
        done.constraint_error.map_or(0.0, |error| error.position),
        done.energy_error.unwrap_or(0.0),
        done.energy_supplied.unwrap_or(0.0),
    ];
    assert_eq!(said("summary"), [summary]);
}

#[test]
fn rows_at_equal_distances_are_those_of_the_recorder() {
    let (engine, start) = engine();
    let mut recorder = Recorder::new(0.03).expect("a distance");
    let options = Options::dop853(2.0, 1e-9);
    simulate(&engine, &start, &options, &mut [&mut recorder]).expect("it runs");
    let rows: Vec<_> = recorder.rows().iter().map(row).collect();
    assert_eq!(rows.len(), 67);
    assert_eq!(said("sampled"), rows);
}

#[test]
fn a_controller_in_c_does_what_one_in_rust_does() {
    let (mut engine, mut state) = engine();
    engine.parameters.ms = 0.75;
    let step_control = StepControl::Fixed { step: 1e-3 };
    let mut stepper =
        Stepper::new(Method::Rk4, step_control, Settings::default()).expect("a step control");
    for _ in 0..2000 {
        engine.inputs.torque = Some(20.0 * (10.0 - state.v[0]));
        stepper.step(&engine, &mut state, 1e-3).expect("it goes on");
    }
    assert_eq!(said("controlled"), [row(&state)]);
}

#[test]
fn adaptive_steps_one_by_one_are_those_of_rust_and_of_a_copy() {
    let engine = Engine::default();
    let mut start = engine.start();
    let held = |value| Initial { value, held: true };
    (start.q[0], start.v[0]) = (held(0.5), held(3.0));
    let mut state: State<f64, 3> = assemble(&engine, &start, 0.25).expect("it assembles");
    let step_control = StepControl::Adaptive {
        relative: 1e-7,
        absolute: 1e-7,
    };
    let mut stepper =
        Stepper::new(Method::Dp5, step_control, Settings::default()).expect("a step control");
    for _ in 0..40 {
        stepper
            .step_once(&engine, &mut state, 100.0)
            .expect("it goes on");
    }
    assert_eq!(said("stepped"), [row(&state)]);
    assert_eq!(said("again"), [row(&state)]);
    let (copied, loaded) = (said("copied"), said("loaded"));
    assert_eq!(copied[0][0], loaded[0][0]);
    for (copied, loaded) in copied[0].iter().zip(&loaded[0]) {
        // A mechanism that is loaded has the default tolerance instead.
        assert!((copied - loaded).abs() < 1e-5, "{copied} {loaded}");
    }
}

#[test]
fn inputs_follow_functions_at_all_stages() {
    let (mut engine, start) = engine();
    engine.inputs.torque = Some(1.5);
    let options = Options::dop853(3.0, 1e-9);
    let done = simulate(&engine, &start, &options, &mut []).expect("it runs");
    assert_eq!(said("constant"), [row(&done.end)]);
    // Were a function asked once a step, tolerances would lead to different motions.
    let (braked, well) = (said("braked"), said("braked_well"));
    for (braked, well) in braked[0].iter().zip(&well[0]) {
        assert!((braked - well).abs() < 1e-6, "{braked} {well}");
    }
    let supplied = &said("supplied")[0];
    assert!(supplied[0] < -0.5 && supplied[1] < 1e-6, "{supplied:?}");
}

#[test]
fn what_is_evaluated_is_what_rust_evaluates() {
    let (engine, _) = engine();
    let mut solver = Solver::<f64, 3, 2>::new(Settings::default());
    let mut state = State {
        t: 0.5,
        q: SVector::from([0.3, 0.31, 0.95]),
        v: SVector::from([1.0, 1.1, -0.3]),
    };
    solver.on(&engine).project(&mut state).expect("it is near");
    let mut terms = Terms::<f64, 3, 2>::default();
    engine.terms(&state, &mut terms);
    let mut position = Position::<f64, 3, 2>::default();
    engine.position(&state, &mut position);
    let rate = position.jacobian * state.v + position.drift;
    // Columns of the transpose are the rows.
    assert_eq!(said("mass"), [terms.mass.transpose().as_slice()]);
    assert_eq!(said("jacobian"), [terms.jacobian.transpose().as_slice()]);
    assert_eq!(said("force"), [terms.force.as_slice()]);
    assert_eq!(said("bias"), [terms.bias.as_slice()]);
    assert_eq!(said("residual"), [position.residual.as_slice()]);
    assert_eq!(said("rate"), [rate.as_slice()]);
    let (acceleration, reaction) = solver.on(&engine).reaction(&state).expect("regular");
    let twice = [acceleration.as_slice(), acceleration.as_slice()];
    assert_eq!(said("acceleration"), twice);
    assert_eq!(said("reaction"), [reaction.as_slice()]);
    let energy = engine.energy(&state);
    let energies = vec![
        energy.kinetic,
        energy.potential,
        energy.balance,
        energy.power,
    ];
    assert_eq!(said("energy"), [energies]);
    let mut outputs = [0.0; 3];
    engine.outputs(&state, &mut outputs);
    assert_eq!(said("output"), [outputs]);
    let mut functions = [0.0];
    engine.events(&state, &mut functions);
    assert_eq!(said("function"), [functions]);
    let pin = [0.5 * state.q[0].cos(), 0.5 * state.q[0].sin()];
    let line = [
        0.0, 3.0, 0.0, 0.0, 0.0, pin[0], pin[1], 0.0, state.q[2], 0.0, 0.0,
    ];
    for (drawn, wanted) in said("drawn")[0].iter().zip(line) {
        assert!((drawn - wanted).abs() < 1e-15, "{drawn} {wanted}");
    }
    let rank = solver.on(&engine).rank(&state).expect("finite");
    assert_eq!(said("rank"), [[2.0, 2.0, rank.sine]]);
}

#[test]
fn a_second_mechanism_of_the_same_library_moves_too() {
    let pendulum = DoublePendulum::default();
    let start: State<f64, 2> = assemble(&pendulum, &pendulum.start(), 0.0).expect("it assembles");
    let options = Options::dop853(1.0, 1e-9);
    let done = simulate(&pendulum, &start, &options, &mut []).expect("it runs");
    assert_eq!(said("pendulum"), [done.end.q.as_slice()]);
}

#[test]
fn c_and_rust_agree_on_the_layout_of_what_they_share() {
    let bytes = [
        size_of::<Point>(),
        size_of::<Choices>(),
        size_of::<Watch>(),
        size_of::<Summary>(),
        size_of::<Table>(),
        offset_of!(Choices, most_steps),
        offset_of!(Watch, take),
        offset_of!(Summary, energy_supplied),
    ];
    assert_eq!(said("sizes"), [bytes.map(|bytes| bytes as f64)]);
}
