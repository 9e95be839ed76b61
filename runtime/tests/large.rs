//! Large mechanisms on the small stacks of threads.

use crate::fixtures::{Framed, distance, simulate};
use crate::mechanisms::{Hanging, RODS, Row, place, sizes};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Initial, Mechanism, Method, Options, Position, Recorder, Settings, Solver, Start, State,
    StepControl, Stepper, Terms, Whole, assemble, with_room,
};
use std::thread;

/// What a thread has if nobody says otherwise.
const STACK: usize = 2 << 20;

/// Does something in a thread as most of them are.
fn in_a_thread(work: impl FnOnce() + Send + 'static) {
    in_a_thread_of(STACK, work);
}

/// Does something in a thread with a stack of this size.
fn in_a_thread_of(stack: usize, work: impl FnOnce() + Send + 'static) {
    let thread = thread::Builder::new().stack_size(stack).spawn(work);
    thread.expect("a thread").join().expect("it ends well");
}

/// Guesses of some positions, at rest.
fn start<const N: usize>(position: impl Fn(usize) -> f64) -> Start<f64, N> {
    let guess = |value| Initial { value, held: false };
    Start {
        q: std::array::from_fn(|i| guess(position(i))),
        v: [guess(0.0); N],
    }
}

/// A row whose cranks lean by this angle.
fn leaning<const N: usize>(angle: f64) -> Start<f64, N> {
    start(|i| match i % 2 {
        0 => (i / 2) as f64 + angle.sin(),
        _ => angle.cos(),
    })
}

/// Velocities of a row whose cranks lean by 0.3 rad and turn at 1 rad/s.
fn leaning_rates<const N: usize>() -> SVector<f64, N> {
    let (sin, cos) = 0.3_f64.sin_cos();
    SVector::from_fn(|i, _| if i % 2 == 0 { cos } else { -sin })
}

/// Assembles a mechanism and follows its motion with everyone who watches.
fn run<M, const N: usize, const R: usize>(
    mechanism: M,
    start: &Start<f64, N>,
    options: &Options<f64>,
) -> State<f64, N>
where
    M: Mechanism<f64, N, R>,
{
    let structure = mechanism.structure();
    let framed = Framed::new(mechanism, structure);
    let start = assemble(&framed, start, 0.0).unwrap_or_else(|error| panic!("{error}"));
    let mut recorder = Recorder::new(options.until / 8.0).expect("an interval");
    let summary = simulate(&framed, &start, options, &mut [&mut recorder]);
    let summary = summary.unwrap_or_else(|failure| panic!("{}", failure.error));
    let energy = summary.energy_error.expect("an audit");
    assert!(energy < 1e-5, "energy off by {energy:e} J");
    let error = summary.constraint_error.expect("an audit");
    assert!(
        error.position < 1e-11,
        "constraints off by {:e}",
        error.position
    );
    summary.end
}

#[test]
fn fifty_bodies_in_space_run_in_a_thread_of_2_mb() {
    in_a_thread(|| {
        let root = 0.5_f64.sqrt();
        // A V: each rod leans by the angle of the 3, 4, 5 triangle.
        let tilt = 0.6_f64.asin();
        let (s, c) = (tilt / 2.0).sin_cos();
        let start = start(|i| {
            let (kind, rod) = (i / RODS, i % RODS);
            let falls = rod < RODS / 2;
            let side = if falls { -s } else { s };
            let along = rod as f64 + 0.5;
            match kind {
                0 => 0.0,
                1 => 0.8 * along,
                2 => -0.6 * along.min(RODS as f64 - along),
                3 => root * c,
                4 => root * side,
                5 => -root * side,
                _ => root * c,
            }
        });
        assert_eq!(place(1, 0), RODS);
        let end = run(Hanging::default(), &start, &Options::dop853(0.01, 1e-8));
        assert!(end.v.norm() > 0.0);
    });
}

#[test]
fn a_row_of_160_loops_runs_in_a_thread_of_2_mb() {
    in_a_thread(|| {
        const SIZES: (usize, usize) = sizes(160);
        let start = leaning::<{ SIZES.0 }>(0.3);
        let options = Options::dop853(0.02, 1e-8);
        let long = run::<_, { SIZES.0 }, { SIZES.1 }>(Row::<160>, &start, &options);
        // All corners of a row move alike, and so do those of a short one but for its mass.
        let first = long.q[0];
        let last = long.q[SIZES.0 - 2] - 160.0;
        assert!((first - last).abs() < 1e-9, "{first} and {last}");
        const SHORT: (usize, usize) = sizes(3);
        let start = leaning::<{ SHORT.0 }>(0.3);
        let short = run::<_, { SHORT.0 }, { SHORT.1 }>(Row::<3>, &start, &options);
        assert!(
            (first - short.q[0]).abs() < 1e-8,
            "{first} and {}",
            short.q[0]
        );
    });
}

#[test]
fn a_row_of_40_loops_goes_through_its_singular_position_in_a_thread_of_2_mb() {
    in_a_thread(|| {
        const SIZES: (usize, usize) = sizes(40);
        let mut start = leaning::<{ SIZES.0 }>(1.55);
        // Towards the line of all rods, at 1 rad/s.
        for corner in 0..=40 {
            start.v[2 * corner].value = 1.55_f64.cos();
            start.v[2 * corner + 1].value = -1.55_f64.sin();
        }
        let options = Options::dop853(0.04, 1e-8);
        let end = run::<_, { SIZES.0 }, { SIZES.1 }>(Row::<40>, &start, &options);
        assert!(end.q[1] < -0.01, "the first corner is at {}", end.q[1]);
        let differences = (0..=40).map(|corner| (end.q[2 * corner + 1] - end.q[1]).abs());
        assert!(differences.fold(0.0, f64::max) < 1e-7, "it stays a row");
    });
}

#[test]
fn a_row_of_40_loops_is_stepped_by_every_method_in_a_thread_of_2_mb() {
    in_a_thread(|| {
        const SIZES: (usize, usize) = sizes(40);
        let start = leaning::<{ SIZES.0 }>(0.3);
        let framed: &dyn Whole<f64, { SIZES.0 }, { SIZES.1 }> =
            &Framed::new(Row::<40>, Row::<40>.structure());
        let start = assemble(framed, &start, 0.0).unwrap_or_else(|error| panic!("{error}"));
        let ends = [Method::Rk4, Method::Dp5, Method::Dop853, Method::Radau9].map(|method| {
            let step_control = StepControl::Fixed { step: 1e-3 };
            let stepper = Stepper::<f64, { SIZES.0 }, { SIZES.1 }>::new;
            let mut stepper =
                stepper(method, step_control, Settings::default()).expect("a step control");
            // A copy goes on to the same bits.
            let mut copy = stepper.clone();
            let (mut state, mut other) = (start, start);
            let stepped = stepper.step(framed, &mut state, 1e-3);
            stepped.unwrap_or_else(|error| panic!("{method}: {error}"));
            copy.step(framed, &mut other, 1e-3).expect("the same");
            assert_eq!(state, other, "{method}");
            state
        });
        for end in &ends[1..] {
            assert!(distance(&ends[0], end) < 1e-9);
        }
    });
}

/// As the page on modelling says: a debug build has the largest frames.
#[test]
fn small_mechanisms_run_in_threads_of_256_kb() {
    in_a_thread_of(256 << 10, || {
        const SIZES: (usize, usize) = sizes(3);
        let start = leaning::<{ SIZES.0 }>(0.3);
        for options in [
            Options::dop853(0.02, 1e-8),
            Options::new(
                0.02,
                Method::Radau9,
                Options::dop853(0.02, 1e-8).step_control,
            ),
        ] {
            run::<_, { SIZES.0 }, { SIZES.1 }>(Row::<3>, &start, &options);
        }
    });
}

#[test]
fn equations_of_160_loops_are_evaluated_in_a_thread_that_has_no_room_for_them() {
    in_a_thread_of(STACK / 8, || {
        const SIZES: (usize, usize) = sizes(160);
        let row = Row::<160>;
        let start = leaning::<{ SIZES.0 }>(0.3);
        let mut state = assemble(&row, &start, 0.0).unwrap_or_else(|error| panic!("{error}"));
        state.v = leaning_rates();
        let mut solver = Solver::<f64, { SIZES.0 }, { SIZES.1 }>::new(Settings::default());
        let acceleration = solver.on(&row).acceleration(&state);
        let acceleration = acceleration.expect("an acceleration");
        with_room::<f64, _, { SIZES.0 }, { SIZES.1 }>(|| {
            let mut terms = Terms::default();
            row.terms(&state, &mut terms);
            let off = terms.jacobian * acceleration - terms.bias;
            assert!(terms.bias.amax() > 0.1, "it is bent");
            assert!(off.amax() < 1e-9, "rows are off by {:e}", off.amax());
            let mut position = Position::default();
            row.position(&state, &mut position);
            let rate = position.jacobian * state.v + position.drift;
            let off = rate.amax().max(position.residual.amax());
            assert!(off < 1e-12, "constraints are off by {off:e}");
        });
    });
}
