//! A start exactly in a singular position: the velocity chooses the branch, and the
//! motion stays on it with the accuracy of a regular start.

use crate::fixtures::system_of;
use crate::mechanisms::{FourBars, Parallelogram, Passing, Reduction, SliderCrank};
use bricard_runtime::{
    ConstraintError, DynamicsError, Integrator, Mechanism, Rk4, Settings, Solver, State,
};

/// How long a motion is followed (s).
const SPAN: f64 = 0.4;

/// Error that RK4 with `h = 0.01 s` makes from regular starts of these mechanisms in
/// that time, at most.
const REGULAR: f64 = 1e-6;

/// The state after fixed RK4 steps.
fn after<M, const N: usize, const R: usize>(
    mechanism: &M,
    start: &State<f64, N>,
    steps: u32,
) -> State<f64, N>
where
    M: Mechanism<f64, N, R>,
{
    let mut solver = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, mechanism);
    let mut method = Rk4::new();
    let mut state = *start;
    for i in 1..=steps {
        let bound = start.t + SPAN * f64::from(i) / f64::from(steps);
        state = *method.step(&mut system, &state, bound).unwrap().end();
    }
    state
}

/// A start at a singular angle, on the branch of the reduction.
fn hit<P, const N: usize, const R: usize>(mechanism: &P)
where
    P: Passing<N, R>,
{
    for direction in [1.0, -1.0] {
        let (angle, rate) = mechanism.singular();
        let rate = rate * direction;
        let start = mechanism.state(0.0, angle, rate);
        let found = after::<_, N, R>(mechanism, &start, 40);
        let (angle, rate) = mechanism.reduction().after(SPAN, (angle, rate));
        let exact = mechanism.state(SPAN, angle, rate);
        let error = (found.q - exact.q).amax();
        assert!(error < REGULAR, "{error:e}");
    }
}

#[test]
fn a_start_in_a_singular_position_keeps_to_the_branch_of_its_velocity() {
    hit::<_, 3, 2>(&SliderCrank::default());
    hit::<_, 3, 2>(&SliderCrank::DRIVEN);
    hit::<_, 5, 4>(&FourBars);
    hit::<_, 11, 10>(&FourBars);
    hit::<_, 6, 6>(&Parallelogram);
}

/// The other branch of the slider–crank: the slider rests in the axis of the crank, on
/// which the rod lies folded back.
#[test]
fn a_start_in_a_dead_centre_may_take_the_folded_branch() {
    let folded = Reduction {
        // Crank about its end, rod about the same axis through its far end.
        constant: 2.0 * (1.0 * 0.25 * 0.25 + 0.1),
        ripple: 0.0,
        weight: 9.81 * (1.0 * 0.25 + 1.0 * (0.5 - 0.25)),
        drive: 0.0,
        damping: 0.0,
    };
    for rate in [5.0, -3.0] {
        let down = -core::f64::consts::FRAC_PI_2;
        let state = |t: f64, angle: f64, rate: f64| {
            let other = -core::f64::consts::PI - angle;
            State::new(t, [angle, other, 0.0].into(), [rate, -rate, 0.0].into())
        };
        let start = state(0.0, down, rate);
        let found = after::<_, 3, 2>(&SliderCrank::default(), &start, 40);
        let (angle, rate) = folded.after(SPAN, (down, rate));
        let error = (found.q - state(SPAN, angle, rate).q).amax();
        assert!(error < REGULAR, "{error:e}");
    }
}

/// A parallelogram may turn over: `q₂` is then as much slower or faster than `q₀` as
/// the second derivative of the loop says. There is no closed form, but the motion
/// can be turned back to where it began, keeps its energy, and leaves the
/// parallelogram.
#[test]
fn a_start_with_all_links_in_a_line_may_turn_over() {
    let ratio = 0.4 / 0.7;
    let first = 2.0;
    let third = -first * (1.0 + ratio) / (1.0 - ratio);
    let coupler = ratio * (third - first);
    let start = State::new(0.0, [0.0; 3].into(), [first, coupler, third].into());
    let there = after::<_, 3, 2>(&FourBars, &start, 400);
    assert!((there.q[0] - there.q[2]).abs() > 0.5, "{}", there.q);
    let energy = |state: &State<f64, 3>| Mechanism::<f64, 3, 2>::energy(&FourBars, state).balance;
    let change = energy(&there) - energy(&start);
    assert!(change.abs() < 1e-6, "{change:e}");
    let back = after::<_, 3, 2>(&FourBars, &State::new(0.0, there.q, -there.v), 400);
    assert!((back.q - start.q).amax() < 1e-7, "{}", back.q);
    assert!((back.v + start.v).amax() < 1e-6, "{}", back.v);
}

/// At rest no branch is chosen: the least acceleration that the constraints allow is
/// returned, and a run says that the choice was not determined.
#[test]
fn rest_in_a_singular_position_is_seen_and_does_no_harm() -> Result<(), DynamicsError<f64>> {
    let down = -core::f64::consts::FRAC_PI_2;
    let start = Passing::<3, 2>::state(&SliderCrank::default(), 0.0, down, 0.0);
    let mut solver: Solver<f64, 3, 2> = Solver::new(Settings::default());
    let mechanism = SliderCrank::default();
    let mut system = system_of(&mut solver, &mechanism);
    let acceleration = system.acceleration(&start)?;
    assert!(acceleration.amax() < 1e-12, "{acceleration}");
    assert!(system.counters().undetermined > 0);
    let ConstraintError { position, velocity } = system.constraint_error(&start);
    assert!(position < 1e-15 && velocity < 1e-15);
    Ok(())
}
