//! The implicit method: order, stiffness, singular positions.

use crate::fixtures::{
    Framed, Free, PLAIN, distance, kepler, kepler_exact, kepler_start, simulate,
};
use crate::integrator::inside_order;
use crate::mechanisms::{FourBars, Passing};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Dp5, Integrator, Method, Options, Radau5, Radau9, State, StepControl, Structure, Tolerance,
};

/// Eccentricity and end of the orbits in these tests.
const E: f64 = 0.2;
const END: f64 = 6.0;

fn kepler_error(mut method: impl Integrator<f64, 2>, steps: u32) -> f64 {
    let mut state = kepler_start(E);
    for i in 1..=steps {
        let bound = END * f64::from(i) / f64::from(steps);
        state = *method.step(&mut Free(kepler), &state, bound).unwrap().end();
    }
    distance(&state, &kepler_exact(E, END))
}

#[test]
fn radau5_converges_with_order_5() {
    let coarse = kepler_error(Radau5::fixed(), 20);
    let fine = kepler_error(Radau5::fixed(), 160);
    let order = (coarse / fine).log2() / 3.0;
    assert!((order - 5.0).abs() < 0.2, "{order} {coarse:e} {fine:e}");
}

#[test]
fn radau9_converges_with_order_9() {
    let coarse = kepler_error(Radau9::fixed(), 12);
    let fine = kepler_error(Radau9::fixed(), 24);
    let order = (coarse / fine).log2();
    assert!((order - 9.0).abs() < 0.4, "{order} {coarse:e} {fine:e}");
}

#[test]
fn interpolants_have_the_order_of_the_stages() {
    let radau5 = inside_order(Radau5::fixed, 0.1);
    assert!((radau5 - 4.0).abs() < 0.3, "{radau5}");
    let radau9 = inside_order(Radau9::fixed, 0.4);
    assert!((radau9 - 6.0).abs() < 0.4, "{radau9}");
}

/// Steps and accelerations of a run to `end`.
fn work<I, F, const N: usize>(
    mut method: I,
    start: State<f64, N>,
    force: F,
    end: f64,
) -> (State<f64, N>, u32, u32)
where
    I: Integrator<f64, N>,
    F: FnMut(&State<f64, N>) -> SVector<f64, N>,
{
    let mut system = Free(force);
    let mut state = start;
    let (mut steps, mut evaluations) = (0, 0);
    while state.t < end {
        let step = method
            .step(&mut system, &state, end)
            .unwrap_or_else(|e| panic!("{e}"));
        steps += 1 + step.rejected();
        evaluations += step.evaluations();
        state = *step.end();
    }
    (state, steps, evaluations)
}

#[test]
fn a_strong_damper_costs_no_steps() {
    // q̈ = −λ(q̇ + sin t) − cos t, λ = 10⁶: after the start q̇ = −sin t.
    let stiff = |state: &State<f64, 1>| {
        let (s, c) = state.t.sin_cos();
        SVector::from([-1e6 * (state.v[0] + s) - c])
    };
    let start = State::new(0.0, SVector::from([1.0]), SVector::from([0.5]));
    let tolerance = Tolerance::uniform(1e-6, 1e-6).unwrap();
    let (end, steps, evaluations) = work(Radau5::adaptive(tolerance), start, stiff, 10.0);
    assert!(evaluations < 1500, "{evaluations} accelerations");
    assert!(steps < 200, "{steps} steps");
    assert!((end.v[0] + 10_f64.sin()).abs() < 1e-5, "{end:?}");
    assert!((end.q[0] - 10_f64.cos()).abs() < 1e-5, "{end:?}");
}

/// The flyball governor in its three independent coordinates: angle of the shaft,
/// angle of the rods below the horizontal, height of the slider. Parameters and
/// reference: the stiff governor of the multibody benchmark library, computed by
/// an implicit method of order 5 at tolerance 1e-12.
fn governor(state: &State<f64, 3>) -> SVector<f64, 3> {
    let (mass_rod, mass_point, mass_slider) = (0.3, 5.0, 3.0);
    let (axial, across) = (5e-6, 0.0250025);
    let (spring, damper, rest) = (8e5, 4e4, 0.5);
    let (alpha, s) = (state.q[1], state.q[2]);
    let (omega, rate, speed) = (state.v[0], state.v[1], state.v[2]);
    let (sin, cos) = alpha.sin_cos();
    let (near, far) = (0.05 + 0.5 * cos, 0.05 + cos);
    let about = 5e-6
        + 0.005
        + 2.0
            * (mass_rod * near * near
                + mass_point * far * far
                + axial * sin * sin
                + across * cos * cos);
    let slope = 2.0
        * (-mass_rod * near * sin - 2.0 * mass_point * far * sin
            + 2.0 * (axial - across) * sin * cos);
    let swing = 2.0 * (mass_rod / 4.0 + mass_point + across);
    // Spring and damper between the slider and the middles of the rods.
    let gap = 1.0 - 0.5 * sin - s;
    let length = (0.25 * cos * cos + gap * gap).sqrt();
    let by_alpha = (-0.25 * sin * cos - 0.5 * gap * cos) / length;
    let by_s = -gap / length;
    let stretch = by_alpha * rate + by_s * speed;
    let pull = 2.0 * spring * (length - rest) + 2.0 * damper * stretch;
    let weight = 9.81;
    SVector::from([
        -slope * rate * omega / about,
        (0.5 * slope * omega * omega + weight * cos * (mass_rod + 2.0 * mass_point)
            - pull * by_alpha)
            / swing,
        (-weight * mass_slider - pull * by_s) / mass_slider,
    ])
}

/// Height of the slider of the governor after 10 s.
const GOVERNOR_HEIGHT: f64 = 0.6196229170613131;

#[test]
fn the_stiff_governor_takes_few_of_the_steps_of_dp5() {
    let start = State::new(
        0.0,
        SVector::from([0.0, 30_f64.to_radians(), 0.5]),
        SVector::from([2.0 * core::f64::consts::PI, 0.0, 0.0]),
    );
    let tolerance = Tolerance::uniform(1e-7, 1e-7).unwrap();
    let (implicit, few, _) = work(Radau5::adaptive(tolerance), start, governor, 10.0);
    let (high, fewer, _) = work(Radau9::adaptive(tolerance), start, governor, 10.0);
    let (explicit, many, _) = work(Dp5::adaptive(tolerance), start, governor, 10.0);
    let error = |state: &State<f64, 3>| (state.q[2] - GOVERNOR_HEIGHT).abs();
    assert!(error(&implicit) < 1e-7, "{:e}", error(&implicit));
    assert!(error(&explicit) < 1e-7, "{:e}", error(&explicit));
    assert!(error(&high) < 1e-7, "{:e}", error(&high));
    assert!(many > 20 * few, "{few} steps instead of {many}");
    assert!(many > 80 * fewer, "{fewer} steps instead of {many}");
}

#[test]
fn implicit_methods_pass_singular_positions() {
    static CONSERVATIVE: Structure = Structure {
        conservative: true,
        ..PLAIN
    };
    let mechanism = Framed::<FourBars, 5>::new(FourBars, &CONSERVATIVE);
    let angle = 80_f64.to_radians();
    let start = Passing::<5, 4>::state(&FourBars, 0.0, angle, 0.0);
    let (angle, rate) = Passing::<5, 4>::reduction(&FourBars).after(8.0, (angle, 0.0));
    let exact = Passing::<5, 4>::state(&FourBars, 8.0, angle, rate);
    let fixed = |step| StepControl::Fixed { step };
    let adaptive = StepControl::Adaptive {
        relative: 1e-8,
        absolute: 1e-8,
    };
    for (method, step_control, bound) in [
        (Method::Radau5, fixed(0.01), 1e-5),
        (Method::Radau5, adaptive, 1e-5),
        (Method::Radau9, fixed(0.02), 1e-7),
        // The iterates of its stages lie on both sides of the window in which states are
        // interpolated, which costs it digits (2.2e-6 was measured).
        (Method::Radau9, adaptive, 4e-6),
    ] {
        let options = Options::new(8.0, method, step_control);
        let summary = simulate::<5, 4>(&mechanism, &start, &options, &mut [])
            .unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(summary.passages, Some(9));
        let error = distance(&summary.end, &exact);
        assert!(error < bound, "{method}, {step_control:?}: {error:e}");
    }
}
