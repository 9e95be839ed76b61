//! The passage through a singular configuration costs no accuracy, wherever the stages
//! of a step are placed.
//!
//! Beside exact reductions, for each method, with constraints written twice, too.
//!
//! Every day some of the distances are tried; with `BRICARD_LONG` set, all of them.

use crate::fixtures::system_of;
use crate::mechanisms::{
    FourBars, Hung, HungReduced, Parallelogram, Passage, Passing, Reduced, SliderCrank, Twice,
};
use bricard_runtime::{Dop853, Dp5, Integrator, Mechanism, Method, Rk4, Settings, Solver, State};
use bricard_testkit::placement::{
    Placements, SPAN, STEPS, complaints, distances, some_distances, stages,
};

/// The errors of all placements, by the distance of the stage.
type Placed = Placements<f64>;

/// A distance that is far away from a singular position (rad).
const FAR: f64 = 0.09;

/// Largest error of the coordinates after fixed steps from `start`.
fn error<M, I, const N: usize, const R: usize>(
    mut method: I,
    mechanism: &M,
    start: State<f64, N>,
    steps: u32,
    exact: &State<f64, N>,
) -> f64
where
    M: Mechanism<f64, N, R>,
    I: Integrator<f64, N>,
{
    let mut solver = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, mechanism);
    let mut state = start;
    for i in 1..=steps {
        let bound = start.t + SPAN * f64::from(i) / f64::from(steps);
        while state.t < bound {
            state = *method.step(&mut system, &state, bound).unwrap().end();
        }
    }
    (state.q - exact.q).amax()
}

/// When steps begin of which a stage lies beside the singular position, that is passed at
/// time zero, and at which distance it lies.
fn starts(method: Method, rate: f64, steps: u32) -> Vec<(f64, f64)> {
    let distances = match std::env::var_os("BRICARD_LONG") {
        Some(_) => distances(),
        None => some_distances(),
    };
    let start = |stage: f64, d: f64| d / rate.abs() - stage * SPAN / f64::from(steps);
    let placed = |stage| distances.iter().map(move |&d| (start(stage, d), d));
    stages(method.abscissae())
        .into_iter()
        .flat_map(placed)
        .collect()
}

/// The errors of the runs from some starts.
fn placed(starts: Vec<(f64, f64)>, error: impl Fn(f64) -> f64) -> Placed {
    let errors = starts.into_iter().map(|(t, distance)| (error(t), distance));
    Placements::of(errors.collect()).expect("some placements")
}

/// All placements of a mechanism with one method and step size.
fn placements<P, I, const N: usize, const R: usize>(
    method: impl Fn() -> I,
    name: Method,
    mechanism: &P,
    steps: u32,
) -> Placed
where
    P: Passing<N, R>,
    I: Integrator<f64, N>,
{
    let (angle, rate) = mechanism.singular();
    let passage = Passage::new(mechanism.reduction(), (angle, rate), SPAN + 0.1);
    let state = |t: f64| {
        let (angle, rate) = passage.at(t);
        mechanism.state(t, angle, rate)
    };
    placed(starts(name, rate, steps), |t| {
        error(method(), mechanism, state(t), steps, &state(t + SPAN))
    })
}

/// All placements of the exact reduction of a mechanism with one method and step size.
fn reduced_placements<I: Integrator<f64, 1>>(
    method: impl Fn() -> I,
    name: Method,
    (reduced, (angle, rate)): (&Reduced, (f64, f64)),
    steps: u32,
) -> Placed {
    placed(starts(name, rate, steps), |t| {
        let state = |t: f64| {
            let (angle, rate) = reduced.0.after(t, (angle, rate));
            State::new(t, [angle].into(), [rate].into())
        };
        error::<_, _, 1, 0>(method(), reduced, state(t), steps, &state(t + SPAN))
    })
}

/// RK4 keeps its order and no placement is much worse than the median.
fn judge_rk4(placements: impl Fn(u32) -> Placed) {
    let complaints = complaints(3.7, placements);
    assert!(complaints.is_empty(), "RK4:\n{}", complaints.join("\n"));
}

/// No placement of a method of high order is much worse than the median, at the steps
/// that RK4 takes; where the median is round-off, none is above 1e-11.
///
/// Starts at different distances are different motions, and the error of a method of
/// high order may differ from one to the next. So the worst may also be as bad as that
/// of a start far away, or as the same method makes it on the exact reduction, which
/// has no singular position.
fn judge_high(name: &str, placements: impl Fn(u32) -> [Placed; 2]) {
    let is_far = |distance: f64| distance.abs() > FAR;
    let is_near = |distance: f64| !is_far(distance);
    for steps in STEPS {
        let [found, reduced] = placements(steps);
        let alone = reduced.worst_of(is_near);
        let usual = found.median().max(found.worst_of(is_far)).max(alone);
        let (worst, bound) = (found.worst_of(is_near), found.bound(usual));
        assert!(
            worst <= bound,
            "{name}, {steps} steps: {worst:e}, {found:?}"
        );
    }
}

/// A mechanism with RK4.
fn check<P, const N: usize, const R: usize>(mechanism: &P)
where
    P: Passing<N, R>,
{
    judge_rk4(|steps| placements(Rk4::new, Method::Rk4, mechanism, steps));
}

/// A mechanism with the methods of higher order.
fn check_high<P, const N: usize, const R: usize>(mechanism: &P)
where
    P: Passing<N, R>,
{
    let reduced = Reduced(mechanism.reduction());
    let reduced = (&reduced, mechanism.singular());
    judge_high("DP5", |steps| {
        let alone = reduced_placements(Dp5::fixed, Method::Dp5, reduced, steps);
        [placements(Dp5::fixed, Method::Dp5, mechanism, steps), alone]
    });
    judge_high("DOP853", |steps| {
        let alone = reduced_placements(Dop853::fixed, Method::Dop853, reduced, steps);
        [
            placements(Dop853::fixed, Method::Dop853, mechanism, steps),
            alone,
        ]
    });
}

#[test]
fn every_placement_of_the_slider_crank_is_as_good_as_any_other() {
    check::<_, 3, 2>(&SliderCrank::default());
}

#[test]
fn every_placement_of_the_double_four_bar_is_as_good_as_any_other() {
    check::<_, 5, 4>(&FourBars);
}

#[test]
fn every_placement_of_five_loops_in_a_row_is_as_good_as_any_other() {
    check::<_, 11, 10>(&FourBars);
}

#[test]
fn every_placement_of_a_redundant_parallelogram_is_as_good_as_any_other() {
    check::<_, 6, 6>(&Parallelogram);
}

#[test]
fn constraints_written_twice_change_no_placement() {
    check::<_, 3, 4>(&Twice::<_, 2>(SliderCrank::default()));
    check::<_, 5, 8>(&Twice::<_, 4>(FourBars));
    check::<_, 6, 12>(&Twice::<_, 6>(Parallelogram));
    check::<_, 11, 20>(&Twice::<_, 10>(FourBars));
}

#[test]
fn no_placement_of_a_method_of_high_order_is_worse_than_another() {
    check_high::<_, 3, 2>(&SliderCrank::default());
    check_high::<_, 5, 4>(&FourBars);
    check_high::<_, 6, 6>(&Parallelogram);
    check_high::<_, 3, 4>(&Twice::<_, 2>(SliderCrank::default()));
}

/// The exact motion of the reduced system, `span` seconds after (before) a state:
/// steps so short that only round-off remains.
fn after(span: f64, start: &State<f64, 2>) -> State<f64, 2> {
    let mut solver: Solver<f64, 2, 0> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &HungReduced);
    let mut method = Dop853::fixed();
    // A motion without damping runs backwards with its velocities turned round.
    let sign = span.signum();
    let mut state = State::new(0.0, start.q, start.v * sign);
    let steps = (span.abs() / 4e-3).ceil().max(1.0) as u32;
    for i in 1..=steps {
        let bound = span.abs() * f64::from(i) / f64::from(steps);
        state = *method.step(&mut system, &state, bound).unwrap().end();
    }
    State::new(start.t + span, state.q, state.v * sign)
}

/// All placements of the linkage of two degrees of freedom, or of its reduction: `full`
/// makes a state of it from one of the reduction.
fn hung_placements<M, I, const N: usize, const R: usize>(
    method: impl Fn() -> I,
    name: Method,
    (mechanism, full): (&M, impl Fn(&State<f64, 2>) -> State<f64, N>),
    steps: u32,
) -> Placed
where
    M: Mechanism<f64, N, R>,
    I: Integrator<f64, N>,
{
    let rate: f64 = -6.0;
    let singular = State::new(0.0, [0.0, -1.2].into(), [rate, 2.0].into());
    placed(starts(name, rate, steps), |t| {
        let start = after(t, &singular);
        let end = full(&after(SPAN, &start));
        error(method(), mechanism, full(&start), steps, &end)
    })
}

#[test]
fn a_second_degree_of_freedom_changes_no_placement() {
    let once = (&Hung, Hung::state);
    judge_rk4(|steps| hung_placements::<_, _, 6, 4>(Rk4::new, Method::Rk4, once, steps));
    let twice = (&Twice::<_, 4>(Hung), Hung::state);
    judge_rk4(|steps| hung_placements::<_, _, 6, 8>(Rk4::new, Method::Rk4, twice, steps));
    let reduced = (&HungReduced, |state: &State<f64, 2>| *state);
    judge_high("DP5", |steps| {
        let alone = hung_placements::<_, _, 2, 0>(Dp5::fixed, Method::Dp5, reduced, steps);
        [
            hung_placements::<_, _, 6, 4>(Dp5::fixed, Method::Dp5, once, steps),
            alone,
        ]
    });
    judge_high("DOP853", |steps| {
        let alone = hung_placements::<_, _, 2, 0>(Dop853::fixed, Method::Dop853, reduced, steps);
        [
            hung_placements::<_, _, 6, 4>(Dop853::fixed, Method::Dop853, once, steps),
            alone,
        ]
    });
}
