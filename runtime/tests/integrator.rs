//! Steps: order, interpolants, step-size control, typed errors.

use crate::fixtures::{Free, distance, kepler, kepler_exact, kepler_start};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Dop853, Dp5, DynamicsError, IntegrateError, Integrator, Rk4, Singularity, State, Structure,
    System, Tolerance,
};

/// Time at the end of the runs.
const END: f64 = 6.0;
/// Eccentricity of the orbits in these tests.
const E: f64 = 0.2;

/// Error at the end of a fixed number of equal steps, and the largest error of
/// the interpolant at four inner points of every step.
fn errors<I: Integrator<f64, 2>>(mut method: I, steps: u32, end: f64) -> (f64, f64) {
    let mut system = Free(kepler);
    let mut state = kepler_start(E);
    let mut inside = 0.0_f64;
    let h = end / f64::from(steps);
    for i in 1..=steps {
        while state.t < f64::from(i) * h {
            let step = method.step(&mut system, &state, f64::from(i) * h).unwrap();
            for theta in [0.15, 0.4, 0.6, 0.85] {
                let t = step.start().t + theta * step.length();
                inside = inside.max(distance(&step.at(t), &kepler_exact(E, t)));
            }
            state = *step.end();
        }
    }
    (distance(&state, &kepler_exact(E, end)), inside)
}

/// Observed order between two numbers of steps a factor `2^halvings` apart.
fn order<I: Integrator<f64, 2>>(method: impl Fn() -> I, steps: u32, halvings: u32) -> f64 {
    let (coarse, _) = errors(method(), steps, END);
    let (fine, _) = errors(method(), steps << halvings, END);
    (coarse / fine).log2() / f64::from(halvings)
}

/// Order of the largest error inside one step from the exact state.
pub fn inside_order<I: Integrator<f64, 2>>(method: impl Fn() -> I, h: f64) -> f64 {
    let error = |h: f64| {
        let mut method = method();
        let start = kepler_exact(E, 1.0);
        let step = method.step(&mut Free(kepler), &start, 1.0 + h).unwrap();
        assert_eq!(step.end().t, 1.0 + h, "the step was cut short");
        (1..20).fold(0.0_f64, |most, i| {
            let t = 1.0 + h * f64::from(i) / 20.0;
            most.max(distance(&step.at(t), &kepler_exact(E, t)))
        })
    };
    (error(h) / error(h / 4.0)).log2() / 2.0
}

/// A tolerance at which every step is accepted.
fn lax() -> Tolerance<f64, 2> {
    Tolerance::uniform(1e6, 1e6).unwrap()
}

/// A method that has grown past its cautious first steps, so that it goes
/// wherever it is sent in one step.
fn warm<I: Integrator<f64, 2>>(mut method: I) -> I {
    let mut state = kepler_start(E);
    while state.t < 100.0 {
        state = *method
            .step(
                &mut Free(|_: &State<f64, 2>| SVector::zeros()),
                &state,
                100.0,
            )
            .unwrap()
            .end();
    }
    method
}

#[test]
fn rk4_converges_with_order_4() {
    let observed = order(Rk4::new, 80, 5);
    assert!((observed - 4.0).abs() < 0.2, "{observed}");
}

#[test]
fn dp5_converges_with_order_5() {
    let observed = order(|| warm(Dp5::adaptive(lax())), 64, 4);
    assert!((observed - 5.0).abs() < 0.2, "{observed}");
}

#[test]
fn dop853_converges_with_order_8() {
    let observed = order(|| warm(Dop853::adaptive(lax())), 48, 1);
    assert!((observed - 8.0).abs() < 0.3, "{observed}");
}

#[test]
fn interpolants_have_the_order_of_their_method_or_one_less() {
    let rk4 = inside_order(Rk4::new, 0.1);
    assert!((rk4 - 4.0).abs() < 0.3, "{rk4}");
    let dp5 = inside_order(|| warm(Dp5::adaptive(lax())), 0.1);
    assert!((dp5 - 5.0).abs() < 0.3, "{dp5}");
    let dop853 = inside_order(|| warm(Dop853::adaptive(lax())), 0.4);
    assert!((dop853 - 8.0).abs() < 0.5, "{dop853}");
}

/// Errors at the end of ten periods for a tolerance, with the work.
fn adaptive<I: Integrator<f64, 2>>(mut method: I) -> (f64, u32, u32, u32) {
    let end = 20.0 * core::f64::consts::PI;
    let mut state = kepler_start(0.5);
    let (mut steps, mut rejected, mut evaluations) = (0, 0, 0);
    while state.t < end {
        let step = method.step(&mut Free(kepler), &state, end).unwrap();
        steps += 1;
        rejected += step.rejected();
        evaluations += step.evaluations();
        state = *step.end();
    }
    (
        distance(&state, &kepler_exact(0.5, end)),
        steps,
        rejected,
        evaluations,
    )
}

#[test]
fn errors_follow_the_tolerance_with_few_rejected_steps() {
    for exponent in [-6, -8, -10, -12] {
        let tolerance = Tolerance::uniform(10_f64.powi(exponent), 10_f64.powi(exponent)).unwrap();
        for (error, steps, rejected, evaluations) in [
            adaptive(Dp5::adaptive(tolerance)),
            adaptive(Dop853::adaptive(tolerance)),
        ] {
            println!("1e{exponent}: {error:e} {steps} {rejected} {evaluations}");
            assert!(
                error < 1e5 * 10_f64.powi(exponent),
                "{error} at 1e{exponent}"
            );
            assert!(
                rejected * 3 <= steps,
                "{rejected} of {steps} rejected at 1e{exponent}"
            );
        }
    }
}

#[test]
fn a_shorter_bound_does_not_shorten_the_steps_after_it() {
    let tolerance = Tolerance::uniform(1e-8, 1e-8).unwrap();
    let mut method = Dp5::adaptive(tolerance);
    let mut state = kepler_start(E);
    for _ in 0..20 {
        state = *method.step(&mut Free(kepler), &state, 100.0).unwrap().end();
    }
    let before = method.step(&mut Free(kepler), &state, 100.0).unwrap();
    let (usual, state) = (before.length(), *before.end());
    let bound = state.t + usual / 1000.0;
    let state = *method.step(&mut Free(kepler), &state, bound).unwrap().end();
    let after = method.step(&mut Free(kepler), &state, 100.0).unwrap();
    assert!(
        after.length() > usual / 2.0,
        "{} after {usual}",
        after.length()
    );
}

#[test]
fn the_last_step_ends_at_the_bound_exactly() {
    let mut method = Dop853::adaptive(Tolerance::uniform(1e-9, 1e-9).unwrap());
    let mut state = kepler_start(E);
    let bound = 7.123_456_789;
    let mut shortest = f64::INFINITY;
    while state.t < bound {
        let step = method.step(&mut Free(kepler), &state, bound).unwrap();
        state = *step.end();
        shortest = shortest.min(step.length());
    }
    assert_eq!(state.t, bound);
    assert!(shortest > 1e-3, "a tiny step of {shortest} remained");
}

#[test]
fn a_force_that_blows_up_ends_in_a_typed_error_at_its_time() {
    // v' = v² from v = 1 goes to infinity at t = 1.
    let blow = |state: &State<f64, 1>| state.v.component_mul(&state.v);
    let start = State::new(0.0, SVector::from([0.0]), SVector::from([1.0]));
    let mut method = Dp5::adaptive(Tolerance::uniform(1e-8, 1e-8).unwrap());
    let mut state = start;
    let error = loop {
        match method.step(&mut Free(blow), &state, 2.0) {
            Ok(step) => state = *step.end(),
            Err(error) => break error,
        }
    };
    match error {
        IntegrateError::StepUnderflow { t, .. }
        | IntegrateError::NotFinite { t }
        | IntegrateError::Dynamics(DynamicsError::NotFinite { t }) => {
            assert!((t - 1.0).abs() < 1e-6, "{error}");
        }
        other => panic!("{other}"),
    }
}

#[test]
fn a_force_that_turns_nan_is_an_error_at_its_time() {
    let sick = |state: &State<f64, 1>| SVector::from([if state.t > 0.5 { f64::NAN } else { 0.0 }]);
    let start = State::new(0.0, SVector::from([0.0]), SVector::from([1.0]));
    let mut method = Dop853::adaptive(Tolerance::uniform(1e-8, 1e-8).unwrap());
    let mut state = start;
    let error = loop {
        match method.step(&mut Free(sick), &state, 2.0) {
            Ok(step) => state = *step.end(),
            Err(error) => break error,
        }
    };
    let IntegrateError::Dynamics(DynamicsError::NotFinite { t }) = error else {
        panic!("{error}")
    };
    assert!((t - 0.5).abs() < 1e-6, "{error}");
    assert!(
        (state.t - 0.5).abs() < 1e-6,
        "the last good state is at {}",
        state.t
    );
}

#[test]
fn bad_tolerances_and_bounds_are_typed_errors() {
    let tolerance = |relative, absolute| Tolerance::<f64, 1>::uniform(relative, absolute);
    for bad in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
        let positive = |error| matches!(error, IntegrateError::ToleranceNotPositive { .. });
        assert!(positive(tolerance(bad, 1e-6).unwrap_err()));
        assert!(positive(tolerance(1e-6, bad).unwrap_err()));
    }
    let error = tolerance(1e-17, 1e-6).unwrap_err();
    assert!(
        matches!(error, IntegrateError::ToleranceTooSmall { .. }),
        "{error}"
    );
    for bound in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Rk4::new()
            .step(&mut Free(kepler), &kepler_start(E), bound)
            .unwrap_err();
        assert!(matches!(error, IntegrateError::BadBound { .. }), "{error}");
    }
}

/// Pulls every state onto the unit circle, and counts.
struct Circle {
    evaluations: u32,
    off: f64,
}

impl System<f64, 2> for Circle {
    fn acceleration(
        &mut self,
        state: &State<f64, 2>,
    ) -> Result<SVector<f64, 2>, DynamicsError<f64>> {
        self.evaluations += 1;
        Ok(-state.q * state.v.norm_squared() / state.q.norm_squared())
    }

    fn project(&mut self, state: &mut State<f64, 2>) -> Result<(), DynamicsError<f64>> {
        self.off = self.off.max((state.q.norm() - 1.0).abs());
        state.q /= state.q.norm();
        let radial = state.q.dot(&state.v);
        state.v -= state.q * radial;
        Ok(())
    }
}

#[test]
fn projection_costs_no_acceleration_and_leaves_no_kink() {
    let mut system = Circle {
        evaluations: 0,
        off: 0.0,
    };
    let mut method = Dp5::adaptive(Tolerance::uniform(1e-7, 1e-7).unwrap());
    let mut state = State::new(0.0, SVector::from([1.0, 0.0]), SVector::from([0.0, 1.0]));
    let mut last_slope = SVector::from([0.0, 1.0]);
    let (mut steps, mut trials) = (0, 0);
    while state.t < 10.0 {
        let step = method.step(&mut system, &state, 10.0).unwrap();
        steps += 1;
        trials += 1 + step.rejected();
        let tiny = 1e-6 * step.length();
        let first = (step.at(state.t + tiny).q - state.q) / tiny;
        assert!(
            (first - last_slope).amax() < 1e-5,
            "kink of {}",
            (first - last_slope).amax()
        );
        state = *step.end();
        last_slope = (state.q - step.at(state.t - tiny).q) / tiny;
        assert!((state.q.norm() - 1.0).abs() < 1e-15);
    }
    assert!(system.off > 0.0, "nothing was projected");
    // One at the start, one for the first step's size, then six per trial.
    assert_eq!(system.evaluations, 2 + 6 * trials, "{steps} steps");
    assert!((state.q[0] - 10_f64.cos()).abs() < 1e-5);
}

/// A motion that is refused behind a place, unless the step is next to nothing.
struct Barrier {
    at: f64,
    refused: u32,
}

impl System<f64, 1> for Barrier {
    fn acceleration(&mut self, _: &State<f64, 1>) -> Result<SVector<f64, 1>, DynamicsError<f64>> {
        Ok([0.0].into())
    }

    fn project(&mut self, _: &mut State<f64, 1>) -> Result<(), DynamicsError<f64>> {
        Ok(())
    }

    fn verify(
        &mut self,
        start: &State<f64, 1>,
        end: &State<f64, 1>,
    ) -> Result<(), DynamicsError<f64>> {
        if end.t < self.at || end.t - start.t < 1e-13 {
            return Ok(());
        }
        self.refused += 1;
        assert!(self.refused < 1000, "it creeps");
        Err(DynamicsError::SingularConfiguration {
            t: end.t,
            kind: Singularity::Unresolved,
            row: 0,
            structure: &Structure::PLAIN,
        })
    }
}

#[test]
fn steps_do_not_creep_on_where_a_singular_configuration_stands_in_the_way() {
    let mut system = Barrier {
        at: 0.7,
        refused: 0,
    };
    let mut method = Dop853::adaptive(Tolerance::uniform(1e-9, 1e-9).unwrap());
    let mut state = State::new(0.0, [0.3].into(), [0.2].into());
    let error = loop {
        match method.step(&mut system, &state, 1.0) {
            Ok(step) => state = *step.end(),
            Err(error) => break error,
        }
    };
    assert!((state.t - 0.7).abs() < 1e-9, "{state:?}");
    assert!(
        matches!(
            error,
            IntegrateError::Dynamics(DynamicsError::SingularConfiguration { .. })
        ),
        "{error:?}"
    );
}

/// Acceleration and energy of a slider–crank of unit masses and lengths, in the angle of its
/// crank: its inertia changes tenfold in a quarter of a turn.
fn slider_crank(state: &State<f64, 1>) -> (SVector<f64, 1>, f64) {
    let ((sin, cos), rate) = (state.q[0].sin_cos(), state.v[0]);
    let inertia = 2.0 / 3.0 + 6.0 * sin * sin;
    let torque = -cos * (6.0 * sin * rate * rate + 9.81);
    let energy = 0.5 * inertia * rate * rate + 9.81 * sin;
    (SVector::from([torque / inertia]), energy)
}

/// Energy that a step may lose, relative, in units of the tolerance: the error estimate is
/// one of the state, and not a bound.
const MOST_LOST: f64 = 300.0;

#[test]
fn no_step_is_so_long_that_its_error_is_missed_by_chance() {
    for relative in [1e-4, 1e-5, 1e-6] {
        let mut worst = 0.0_f64;
        for k in 0..500 {
            let tolerance = Tolerance::uniform(relative, relative).unwrap();
            let mut method = Dop853::adaptive(tolerance);
            let mut system = Free(|state: &State<f64, 1>| slider_crank(state).0);
            let (q, v) = (-1.4 + 0.0056 * f64::from(k), 3.0 + 0.01 * f64::from(k));
            let mut state = State::new(0.0, SVector::from([q]), SVector::from([v]));
            while state.t < 3.0 {
                let end = *method.step(&mut system, &state, 3.0).unwrap().end();
                let [before, after] = [&state, &end].map(|state| slider_crank(state).1);
                worst = worst.max((after - before).abs() / (9.81 + before.abs()));
                state = end;
            }
        }
        let lost = worst / relative;
        assert!(
            lost < MOST_LOST,
            "at {relative} a step lost {lost} of its tolerance"
        );
    }
}
