//! What the border costs.

use bricard_capi::{Handle, Status};
use bricard_embedding::engine::Engine;
use bricard_embedding::engine_interface;
use bricard_runtime::{Interface, Options, State, Stepper, assemble};
use std::ptr;
use std::time::Instant;

/// Measurements of each, of which the best counts.
const TRIALS: usize = 15;
/// Steps of a measurement.
const STEPS: usize = 400;
/// What the border may cost. On a machine that others use, measurements are off by more
/// than the few per cent that are meant; a second allocation or a lock would cost more.
const BOUND: f64 = 1.25;

fn best(mut once: impl FnMut()) -> f64 {
    let times = (0..TRIALS).map(|_| {
        let begun = Instant::now();
        once();
        begun.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_step_through_the_border_costs_what_a_step_costs() {
    let engine = Engine::default();
    let start: State<f64, 3> = assemble(&engine, &engine.start(), 0.0).expect("it assembles");
    let options = Options::dop853(0.0, 1e-9);
    let new = || {
        Stepper::new(options.method, options.step_control, options.settings)
            .expect("a step control")
    };
    let rust = best(|| {
        let (mut stepper, mut state) = (new(), start);
        for _ in 0..STEPS {
            stepper.step(&engine, &mut state, 1e-3).expect("it goes on");
        }
    });
    // SAFETY: the table is there for this version, and the handle is what `create` gave.
    let border = unsafe {
        let table = engine_interface(bricard_capi::ABI)
            .as_ref()
            .expect("it is there");
        let mut handle: *mut Handle = ptr::null_mut();
        assert_eq!((table.create)(&raw mut handle), Status::Ok);
        let border = best(|| {
            assert_eq!((table.assemble)(handle, 0.0), Status::Ok);
            for _ in 0..STEPS {
                assert_eq!((table.step)(handle, 1e-3), Status::Ok);
            }
        });
        (table.free)(&raw mut handle);
        border
    };
    println!(
        "{:.3} µs in Rust, {:.3} through the border",
        rust * 1e6,
        border * 1e6
    );
    assert!(border < rust * BOUND, "{border} {rust}");
}
