//! The motions of `boundaries` in Rust: medians of what they take, in microseconds.

use slider_crank::bricard_runtime::{
    Interface, Options, Recorder, State, Stepper, assemble, simulate,
};
use slider_crank::slider_crank::SliderCrank;
use std::error::Error;
use std::time::Instant;

const TRIALS: usize = 101;
/// Few, so that trials end before other programs have their turn.
const STEPS: usize = 200;

/// The median of some trials (µs).
fn median(mut once: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut times = Vec::new();
    for _ in 0..TRIALS {
        let begun = Instant::now();
        once()?;
        times.push(begun.elapsed().as_secs_f64() * 1e6);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[TRIALS / 2])
}

fn main() -> Result<(), Box<dyn Error>> {
    let mechanism = SliderCrank::<f64>::default();
    let start: State<f64, 3> = assemble(&mechanism, &mechanism.start(), 0.0)?;
    let options = Options::dop853(8.0, 1e-9);
    let stepper = || Stepper::new(options.method, options.step_control, options.settings);
    let step = median(|| {
        let (mut stepper, mut state) = (stepper()?, start);
        for _ in 0..STEPS {
            stepper.step(&mechanism, &mut state, 1e-3)?;
        }
        Ok(())
    })?;
    let span = median(|| {
        let (mut stepper, mut state) = (stepper()?, start);
        Ok(stepper.step(&mechanism, &mut state, 8.0)?)
    })?;
    let run = median(|| {
        let mut recorder = Recorder::new(0.01)?;
        simulate(&mechanism, &start, &options, &mut [&mut recorder])?;
        Ok(())
    })?;
    println!("step {}\nspan {span}\nrun {run}", step / STEPS as f64);
    Ok(())
}
