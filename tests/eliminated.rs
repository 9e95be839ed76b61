//! Coordinates that constraints give can be left out: the motion stays the same.
//!
//! Each mechanism is compiled twice, with all coordinates and without those that are
//! given; the second one's `described` must say what the first one's state says.

use crate::passage::judged;
use crate::reduction::Reduction;
use bricard_fixtures::eliminated as less;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Described, Method, Options, Recorder, Settings, Solver, State, StepControl, Structure, Whole,
    assemble, simulate,
};

/// The tolerance of the runs, per step.
const TOLERANCE: f64 = 1e-11;

/// How far two such runs may be apart after a few seconds.
const APART: f64 = 1e-8;

/// Round-off of a reaction, relative to the largest; a Jacobian at a regular state
/// magnifies it.
const ROUND_OFF: f64 = 1e-9;

/// Distance of the states that are compared, and end (s): no multiple of what happens.
const EVERY: f64 = 0.0831;
const UNTIL: f64 = 3.0;

/// The least sine of the weakest constraint where reactions are compared.
const REGULAR: f64 = 0.05;

/// One motion: the coordinates as declared, energies and outputs at each time.
struct Course {
    structure: &'static Structure,
    rows: Vec<Row>,
}

/// A state in the words of the description.
struct Row {
    t: f64,
    coordinates: Vec<Described<f64>>,
    values: Vec<f64>,
    sine: f64,
}

/// The motion of a mechanism from its start.
fn course<const N: usize, const R: usize>(mechanism: &dyn Whole<f64, N, R>) -> Course {
    let structure = mechanism.structure();
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
    let mut recorder = Recorder::new(EVERY).expect("a positive interval");
    let step_control = StepControl::Adaptive {
        relative: TOLERANCE,
        absolute: TOLERANCE,
    };
    let options = Options::new(UNTIL, Method::Dop853, step_control);
    let ended = simulate(mechanism, &start, &options, &mut [&mut recorder]);
    assert!(ended.is_ok(), "{}: {:?}", structure.name, ended.err());
    let mut solver = Solver::new(Settings::default());
    let mut row = |state: &State<f64, N>| {
        let mut system = solver.on(mechanism);
        let (acceleration, reaction) = system.reaction(state).expect("a reaction");
        let sine = system.rank(state).expect("a rank").sine;
        let energy = mechanism.energy(state);
        let mut values = vec![0.0; structure.outputs.len()];
        mechanism.outputs(state, &mut values);
        let mut events = vec![0.0; structure.events.len()];
        mechanism.events(state, &mut events);
        values.extend(events);
        values.extend([energy.kinetic, energy.potential]);
        let mut coordinates = vec![Described::default(); structure.described.len()];
        mechanism.described(state, &acceleration, &mut coordinates);
        if structure.described.is_empty() {
            coordinates.extend((0..N).map(|i| Described {
                position: state.q[i],
                velocity: state.v[i],
                acceleration: acceleration[i],
                reaction: reaction[i],
            }));
        }
        Row {
            t: state.t,
            coordinates,
            values,
            sine,
        }
    };
    let rows = recorder.rows().iter().map(&mut row).collect();
    Course { structure, rows }
}

/// What differs between two motions.
fn differences(whole: &Course, less: &Course) -> Vec<String> {
    let mut found = Vec::new();
    let name = whole.structure.name;
    for (a, b) in whole.rows.iter().zip(&less.rows) {
        let regular = a.sine > REGULAR && b.sine > REGULAR;
        let largest = a
            .coordinates
            .iter()
            .map(|c| c.reaction.abs())
            .fold(1.0, f64::max);
        for (i, (x, y)) in a.coordinates.iter().zip(&b.coordinates).enumerate() {
            let apart = [
                (x.position - y.position) / (1.0 + x.position.abs()),
                (x.velocity - y.velocity) / (1.0 + x.velocity.abs()),
            ];
            let forces = [
                (x.acceleration - y.acceleration) / (1.0 + x.acceleration.abs()),
                (x.reaction - y.reaction) / largest,
            ];
            let most = |parts: [f64; 2]| parts[0].abs().max(parts[1].abs());
            if most(apart) > APART || regular && most(forces) > 100.0 * APART {
                found.push(format!("{name}, t = {}: coordinate {i}: {x:?} {y:?}", a.t));
            }
        }
        for (x, y) in a.values.iter().zip(&b.values) {
            if (x - y).abs() > APART * (1.0 + x.abs()) {
                found.push(format!("{name}, t = {}: {x} {y}", a.t));
            }
        }
    }
    found
}

/// Calls a function with each mechanism, whole and with coordinates left out.
macro_rules! each {
    ($compare:ident: $($module:ident :: $whole:ident from $origin:ident),* $(,)?) => {
        [$($compare(
            &$origin::$module::$whole::<f64>::default(),
            &less::$module::$whole::<f64>::default(),
        )),*]
    };
}

/// [`each!`] with all of them.
macro_rules! all {
    ($compare:ident) => {
        each!($compare:
            slider_crank::SliderCrank from bricard,
            slider_crank_driven::SliderCrankDriven from bricard,
            scotch_yoke::ScotchYoke from bricard,
            quick_return::QuickReturn from bricard,
            driven_pivot::DrivenPivot from bricard,
            moving_rail::MovingRail from bricard_fixtures,
            hanging::Hanging from bricard_fixtures,
            towed::Towed from bricard_fixtures,
        )
    };
}

#[test]
fn a_motion_is_the_same_without_the_coordinates_that_constraints_give() {
    fn compare<const N: usize, const R: usize, const K: usize, const S: usize>(
        whole: &dyn Whole<f64, N, R>,
        less: &dyn Whole<f64, K, S>,
    ) -> Vec<String> {
        assert!(K < N && S < R && N - K == R - S, "{N} {R} {K} {S}");
        let (whole, less) = (course(whole), course(less));
        assert_eq!(whole.rows.len(), less.rows.len());
        assert_eq!(less.structure.described.len(), N);
        differences(&whole, &less)
    }
    let found = all!(compare).concat();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn what_was_eliminated_comes_back_with_accelerations_and_reactions_to_round_off() {
    fn compare<const N: usize, const R: usize, const K: usize, const S: usize>(
        whole: &dyn Whole<f64, N, R>,
        less: &dyn Whole<f64, K, S>,
    ) -> Vec<String> {
        let mut found = Vec::new();
        let start = assemble(less, &less.start(), 0.0).expect("the start assembles");
        let mut solver = Solver::new(Settings::default());
        let (acceleration, _) = solver.on(less).reaction(&start).expect("a reaction");
        let mut coordinates = [Described::default(); N];
        less.described(&start, &acceleration, &mut coordinates);
        let state = State::new(
            0.0,
            SVector::<f64, N>::from_fn(|i, _| coordinates[i].position),
            SVector::from_fn(|i, _| coordinates[i].velocity),
        );
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(whole);
        let error = system.constraint_error(&state);
        let (acceleration, reaction) = system.reaction(&state).expect("a reaction");
        let largest = reaction.amax().max(1.0);
        let mut judge = |what: &str, gap: f64| {
            if gap.abs() > ROUND_OFF {
                found.push(format!("{}: {what}: {gap:e}", whole.structure().name));
            }
        };
        judge("constraints", error.position.max(error.velocity));
        for (i, coordinate) in coordinates.iter().enumerate() {
            let gap = coordinate.acceleration - acceleration[i];
            judge("acceleration", gap / acceleration.amax().max(1.0));
            judge("reaction", (coordinate.reaction - reaction[i]) / largest);
        }
        found
    }
    let found = all!(compare).concat();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn no_placement_is_worse_where_a_coordinate_is_left_out() {
    let mut failures = judged(Reduction::SliderCrank, -3.0, &|passage| {
        passage.placed(&less::slider_crank::SliderCrank::default())
    });
    failures.extend(judged(Reduction::SliderCrankDriven, 5.0, &|passage| {
        passage.placed(&less::slider_crank_driven::SliderCrankDriven::default())
    }));
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
