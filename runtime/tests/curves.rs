//! Branches that are curves: singular positions are crossed between regular states on
//! both sides, as accurately as anything else and without rank decisions.
//!
//! `BRICARD_LONG=1` takes forty loops in a row for 20 s instead of ten for 5 s.

use crate::fixtures::system_of;
use crate::mechanisms::{FourBars, Passing, Reduced, Reduction, SliderCrank};
use bricard_runtime::{Dop853, Integrator, Rk4, Settings, Solver, State, Tolerance};

/// Rank decisions that a run may take to learn at its start what the rank is.
const HANDFUL: u64 = 5;

/// Accelerations in and beside the singular position, against the exact reduction.
fn check<P, const N: usize, const R: usize>(mechanism: &P)
where
    P: Passing<N, R>,
{
    let (angle, rate) = mechanism.singular();
    let mut solver: Solver<f64, N, R> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, mechanism);
    for away in [0.0, 1e-12, -1e-8, 1e-5, -1e-3, 7e-3] {
        let state = mechanism.state(0.0, angle + away, rate);
        let exact = mechanism.reduction().acceleration(angle + away, rate);
        let found = system.acceleration(&state).unwrap();
        assert!(
            (found[0] - exact).abs() < 1e-11,
            "{away}: {}",
            found[0] - exact
        );
    }
}

/// Rank decisions of a run that passes the singular position.
fn decisions<P, const N: usize, const R: usize>(mechanism: &P)
where
    P: Passing<N, R>,
{
    let (angle, rate) = mechanism.singular();
    let mut solver: Solver<f64, N, R> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, mechanism);
    let mut method = Rk4::new();
    let mut state = mechanism.state(0.0, angle - 0.2 * rate.signum(), rate);
    while (state.q[0] - angle) * rate.signum() < 0.2 {
        let bound = state.t + 1e-3;
        state = *method.step(&mut system, &state, bound).unwrap().end();
    }
    let counters = system.counters();
    assert!(counters.robust_accelerations > 0, "{counters:?}");
    assert!(counters.rank_decisions <= HANDFUL, "{counters:?}");
}

#[test]
fn accelerations_in_singular_positions_are_exact() {
    check::<_, 3, 2>(&SliderCrank::default());
    check::<_, 3, 2>(&SliderCrank::DRIVEN);
    check::<_, 5, 4>(&FourBars);
    check::<_, 11, 10>(&FourBars);
}

#[test]
fn singular_positions_are_passed_without_rank_decisions() {
    decisions::<_, 3, 2>(&SliderCrank::default());
    decisions::<_, 3, 2>(&SliderCrank::DRIVEN);
    decisions::<_, 5, 4>(&FourBars);
    decisions::<_, 11, 10>(&FourBars);
}

/// The error that the method makes at the same tolerance without any constraints.
fn own_error(reduction: Reduction, start: f64, span: f64) -> f64 {
    let (angle, _) = reduction.after(span, (start, 0.0));
    let mechanism = Reduced(reduction);
    let mut solver: Solver<f64, 1, 0> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &mechanism);
    let mut method = Dop853::adaptive(Tolerance::uniform(1e-12, 1e-12).unwrap());
    let mut state = State::new(0.0, [start].into(), [0.0].into());
    while state.t < span {
        state = *method.step(&mut system, &state, span).unwrap().end();
    }
    (state.q[0] - angle).abs()
}

/// Loops in a row, from rest at 80°, against the exact reduction.
fn follow<const N: usize, const R: usize>(span: f64) {
    let start = Passing::<N, R>::state(&FourBars, 0.0, 80.0_f64.to_radians(), 0.0);
    let reduction = Passing::<N, R>::reduction(&FourBars);
    let (angle, _) = reduction.after(span, (start.q[0], 0.0));
    let mut solver: Solver<f64, N, R> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &FourBars);
    let mut method = Dop853::adaptive(Tolerance::uniform(1e-12, 1e-12).unwrap());
    let mut state: State<f64, N> = start;
    while state.t < span {
        state = *method.step(&mut system, &state, span).unwrap().end();
    }
    let own = own_error(reduction, start.q[0], span);
    for i in 0..N {
        let exact = if i.is_multiple_of(2) { angle } else { 0.0 };
        let parallel = if i.is_multiple_of(2) { state.q[0] } else { 0.0 };
        assert!(
            (state.q[i] - exact).abs() < 1e-9 + 2.0 * own,
            "{i}: {}",
            state.q[i] - exact
        );
        assert!(
            (state.q[i] - parallel).abs() < 1e-10,
            "{i}: {}",
            state.q[i] - parallel
        );
    }
}

#[test]
fn rods_of_many_loops_stay_parallel() {
    let work = || match std::env::var_os("BRICARD_LONG") {
        Some(_) => follow::<81, 80>(20.0),
        None => follow::<21, 20>(5.0),
    };
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(work);
    thread.unwrap().join().unwrap();
}
