//! What the boundary costs, in instructions: times of one program say little where others run.

use bricard_capi::{Handle, Status};
use bricard_embedding::engine::Engine;
use bricard_embedding::engine_interface;
use bricard_runtime::{Interface, Options, State, Stepper, assemble};
use bricard_testkit::callgrind::{counted_in, is_there};
use std::ptr;

const STEPS: usize = 400;
/// The seconds of a step.
const STEP: f64 = 1e-3;
/// What the boundary may cost: the handle is checked, and the state copied. A second
/// evaluation a step would be a twelfth.
const BOUND: f64 = 1.03;

/// Assembles the mechanism, and moves it in Rust.
#[inline(never)]
fn moved_in_rust() -> State<f64, 3> {
    let engine = Engine::default();
    let mut state = assemble(&engine, &engine.start(), 0.0).expect("it assembles");
    let options = Options::dop853(0.0, 1e-9);
    let stepper = Stepper::new(options.method, options.step_control, options.settings);
    let mut stepper = stepper.expect("a step control");
    for _ in 0..STEPS {
        stepper.step(&engine, &mut state, STEP).expect("it goes on");
    }
    state
}

/// Assembles the mechanism, and moves it through the C interface.
#[inline(never)]
fn moved_through_the_boundary() {
    // SAFETY: the table is there for this version, and the handle is what `create` gave.
    unsafe {
        let table = engine_interface(bricard_capi::ABI)
            .as_ref()
            .expect("it is there");
        let mut handle: *mut Handle = ptr::null_mut();
        assert_eq!((table.create)(&raw mut handle), Status::Ok);
        assert_eq!((table.assemble)(handle, 0.0), Status::Ok);
        for _ in 0..STEPS {
            assert_eq!((table.step)(handle, STEP), Status::Ok);
        }
        (table.free)(&raw mut handle);
    }
}

#[test]
fn steps_in_rust() {
    let reached = moved_in_rust().t - STEPS as f64 * STEP;
    assert!(reached.abs() < 1e-9, "{reached}");
}

#[test]
fn steps_through_the_boundary() {
    moved_through_the_boundary();
}

/// Instructions are counted where valgrind is installed.
#[test]
fn a_step_through_the_boundary_costs_what_a_step_costs() {
    if !is_there() {
        return;
    }
    let count = |function, test| {
        let counted = counted_in(function, &["--exact", test]);
        counted.unwrap_or_else(|error| panic!("{error}"))
    };
    let rust = count("moved_in_rust", "speed::steps_in_rust");
    let boundary = count(
        "moved_through_the_boundary",
        "speed::steps_through_the_boundary",
    );
    let each = STEPS as f64;
    println!("a step: {} instructions, {}", rust / each, boundary / each);
    assert!(boundary > 0.9 * rust, "{boundary} {rust}");
    assert!(boundary < rust * BOUND, "{boundary} {rust}");
}
