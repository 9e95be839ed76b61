//! Buffers that another mechanism has filled: what code does not write again is cleared, or
//! written by the mechanism that takes them over.

use bricard::double_four_bar::DoubleFourBar;
use bricard::four_bar::FourBar;
use bricard::quick_return::QuickReturn;
use bricard::scissor_lift::ScissorLift;
use bricard::scotch_yoke::ScotchYoke;
use bricard::slider_crank::SliderCrank;
use bricard::slider_crank_driven::SliderCrankDriven;
use bricard::watt_six_bar::WattSixBar;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Linearised, Mechanism, Method, Options, Position, SimulateError, State, Stepper, Terms, Whole,
    assemble,
};
use bricard_testkit::Random;

/// Buffers of all kinds.
type Buffers<const N: usize, const R: usize> =
    (Terms<f64, N, R>, Position<f64, N, R>, Linearised<f64, N, R>);

/// Some that nobody has filled.
fn empty<const N: usize, const R: usize>() -> Buffers<N, R> {
    (Terms::default(), Position::default(), Linearised::default())
}

/// What one mechanism writes into buffers.
fn fill<const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<f64, N, R>,
    state: &State<f64, N>,
    buffers: &mut Buffers<N, R>,
) -> Vec<f64> {
    let (terms, position, linearised) = buffers;
    mechanism.terms(state, terms);
    mechanism.position(state, position);
    let (still, free) = (SVector::zeros(), SVector::zeros());
    assert!(mechanism.linearised(state, &still, &free, linearised));
    let parts = [
        terms.mass.as_slice(),
        terms.force.as_slice(),
        terms.jacobian.as_slice(),
        terms.bias.as_slice(),
        position.mass.as_slice(),
        position.residual.as_slice(),
        position.jacobian.as_slice(),
        position.drift.as_slice(),
        linearised.force_by_position.as_slice(),
        linearised.force_by_velocity.as_slice(),
        linearised.row_by_position.as_slice(),
        linearised.row_by_velocity.as_slice(),
    ];
    parts.concat()
}

/// Lets mechanisms of the same sizes take over buffers from each other.
fn take_over<const N: usize, const R: usize>(mechanisms: &[&dyn Mechanism<f64, N, R>]) {
    let mut random = Random::seeded(N as u64);
    for (i, first) in mechanisms.iter().enumerate() {
        for (j, second) in mechanisms.iter().enumerate() {
            let mut state = || State::<f64, N> {
                t: random.within(1.0),
                q: [(); N].map(|()| random.within(1.5)).into(),
                v: [(); N].map(|()| random.within(2.0)).into(),
            };
            let (before, state) = (state(), state());
            let mut buffers = empty();
            fill(*first, &before, &mut buffers);
            let found = fill(*second, &state, &mut buffers);
            let exact = fill(*second, &state, &mut empty());
            assert_eq!(found, exact, "{j} after {i}");
        }
    }
}

#[test]
fn a_buffer_may_have_been_of_another_mechanism() {
    take_over::<3, 2>(&[
        &SliderCrank::default(),
        &SliderCrankDriven::default(),
        &ScotchYoke::default(),
        &FourBar::default(),
    ]);
    take_over::<5, 4>(&[
        &DoubleFourBar::default(),
        &QuickReturn::default(),
        &ScissorLift::default(),
        &WattSixBar::default(),
    ]);
}

/// Cuts off steps after every number of evaluations, and goes on with the same stepper.
fn goes_on_when_cut_off<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    options: &Options<f64>,
) {
    const SPAN: f64 = 0.02;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
    let stepper = || -> Stepper<f64, N, R> {
        Stepper::new(options.method, options.step_control, options.settings)
            .expect("the step control is usable")
    };
    let name = format!("{} {:?}", mechanism.structure().name, options.method);
    let mut exact = start;
    let needed = stepper().step_within(mechanism, &mut exact, SPAN, u32::MAX);
    for most in 0..needed.unwrap_or_else(|error| panic!("{name}: {error}")) {
        let (mut cut, mut state) = (stepper(), start);
        let ended = cut.step_within(mechanism, &mut state, SPAN, most);
        let too_much = matches!(ended, Err(SimulateError::TooMuchWork { .. }));
        assert!(too_much, "{name}, {most}: {ended:?}");
        let rest = exact.t - state.t;
        if rest > 0.0 {
            let went_on = cut.step(mechanism, &mut state, rest);
            assert!(went_on.is_ok(), "{name}, {most}: {went_on:?}");
        }
        let off = (state.q - exact.q).norm() + (state.v - exact.v).norm();
        assert!(off < 1e-6, "{name}, {most}: {off:e}");
    }
}

/// Generated code does not write again what is constant.
#[test]
fn a_stepper_that_was_cut_off_goes_on() {
    for method in [Method::Dp5, Method::Dop853, Method::Radau5, Method::Radau9] {
        let adaptive = Options {
            method,
            ..Options::dop853(1.0, 1e-9)
        };
        for options in [adaptive, Options::rk4(1.0, 0.002)] {
            goes_on_when_cut_off::<3, 2>(&SliderCrank::default(), &options);
            goes_on_when_cut_off::<5, 4>(&DoubleFourBar::default(), &options);
            goes_on_when_cut_off::<3, 2>(&ScotchYoke::default(), &options);
        }
    }
}
