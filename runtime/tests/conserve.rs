//! Long runs: the energy stays where it was, through singular positions.
//!
//! `BRICARD_LONG=1` makes a million passages instead of two hundred.

use crate::fixtures::{Framed, Oscillator, PLAIN, simulate};
use crate::mechanisms::{FourBars, Passing, SliderCrank};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Method, Options, SimulateError, State, StepControl, Structure};

static CONSERVATIVE: Structure = Structure {
    conservative: true,
    ..PLAIN
};

/// Energy error and passages of a run from rest at an angle.
fn run<P, const N: usize, const R: usize>(
    mechanism: P,
    angle: f64,
    options: &Options<f64>,
) -> (f64, u64, State<f64, N>)
where
    P: Passing<N, R> + Copy,
{
    let framed = Framed::<P, N>::new(mechanism, &CONSERVATIVE);
    let start = mechanism.state(0.0, angle.to_radians(), 0.0);
    let summary = simulate::<N, R>(&framed, &start, options, &mut [])
        .unwrap_or_else(|failure| panic!("{failure}"));
    let constraints = summary.constraint_error.unwrap();
    assert!(constraints.position < 1e-12, "{constraints:?}");
    (
        summary.energy_error.unwrap(),
        summary.passages.unwrap(),
        summary.end,
    )
}

/// A long run of a method, with and without keeping the energy.
fn kept(method: Method, step_control: StepControl<f64>, bound: f64) {
    let mut options = Options::new(200.0, method, step_control);
    let (drift, _, _) = run::<_, 5, 4>(FourBars, 80.0, &options);
    options.keep_energy = true;
    let (error, passages, _) = run::<_, 5, 4>(FourBars, 80.0, &options);
    assert!(error < bound, "{method}: {error:e}");
    assert!(
        error < drift / 10.0,
        "{method}: {error:e} instead of {drift:e}"
    );
    assert_eq!(passages, 225, "{method}");
}

#[test]
fn no_method_drifts_when_the_energy_is_kept() {
    kept(Method::Rk4, StepControl::Fixed { step: 0.01 }, 1e-9);
    kept(Method::Dp5, StepControl::Fixed { step: 0.02 }, 1e-9);
    kept(Method::Dop853, StepControl::Fixed { step: 0.05 }, 1e-12);
    let tolerance = |relative| StepControl::Adaptive {
        relative,
        absolute: relative,
    };
    kept(Method::Dp5, tolerance(1e-7), 1e-7);
    kept(Method::Dop853, tolerance(1e-9), 1e-10);
}

#[test]
fn the_energy_error_does_not_grow_with_the_length_of_the_run() {
    let mut options = Options::rk4(20.0, 0.01);
    options.keep_energy = true;
    let (short, _, _) = run::<_, 3, 2>(SliderCrank::default(), 45.0, &options);
    options.until = 400.0;
    let (long, _, _) = run::<_, 3, 2>(SliderCrank::default(), 45.0, &options);
    assert!(long < 5.0 * short.max(1e-9), "{long:e} after {short:e}");
}

#[test]
fn a_million_passages_later_the_motion_is_still_on_its_branch() {
    let passages = match std::env::var_os("BRICARD_LONG") {
        Some(_) => 1_000_000.0,
        None => 200.0,
    };
    // A passage every 0.8895 s.
    let step_control = StepControl::Fixed { step: 0.05 };
    let mut options = Options::new(passages * 0.89, Method::Dop853, step_control);
    options.keep_energy = true;
    let (error, count, end) = run::<_, 5, 4>(FourBars, 80.0, &options);
    assert!(count as f64 >= passages, "{count}");
    assert!(error < 1e-12, "{error:e}");
    // Cranks parallel, couplers level.
    let off = (end.q[0] - end.q[2]).abs().max((end.q[0] - end.q[4]).abs());
    let off = off.max(end.q[1].abs()).max(end.q[3].abs());
    assert!(off < 1e-12, "{:?} left the branch", end.q);
}

#[test]
fn energy_is_not_kept_where_it_is_not_conserved() {
    let mechanism = Framed::new(Oscillator { damping: 0.1 }, &PLAIN);
    let start = State::new(0.0, SVector::from([1.0]), SVector::from([0.0]));
    let mut options = Options::rk4(1.0, 0.1);
    options.keep_energy = true;
    let failure = simulate::<1, 0>(&mechanism, &start, &options, &mut []).unwrap_err();
    assert_eq!(failure.error, SimulateError::NotConservative);
}
