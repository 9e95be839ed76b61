//! Steps with a limit on the evaluations of the equations.

use crate::mechanisms::{FourBars, Passing, SliderCrank};
use bricard_runtime::{
    Acceleration, Condition, Correction, Energy, Linearised, Mechanism, Method, Position, Settings,
    SimulateError, State, StepControl, Stepper, Structure, Switches, Terms,
};
use nalgebra::SVector;
use std::cell::Cell;

/// Length of a step (s).
const STEP: f64 = 0.004;
/// Evaluations after the last that was granted with which a step may come to its end.
const FEW: u32 = 48;

/// Counts the evaluations of a mechanism by its own.
struct Counted<M> {
    mechanism: M,
    asked: Cell<u32>,
}

impl<M> Counted<M> {
    fn new(mechanism: M) -> Self {
        let asked = Cell::new(0);
        Self { mechanism, asked }
    }

    fn count(&self) {
        self.asked.set(self.asked.get() + 1);
    }
}

impl<M: Mechanism<f64, N, R>, const N: usize, const R: usize> Mechanism<f64, N, R> for Counted<M> {
    fn structure(&self) -> &'static Structure {
        self.mechanism.structure()
    }
    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        self.count();
        self.mechanism.terms(state, out);
    }
    fn acceleration(&self, state: &State<f64, N>, out: &mut Acceleration<f64, N, R>) -> bool {
        self.count();
        self.mechanism.acceleration(state, out)
    }
    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        self.count();
        self.mechanism.position(state, out);
    }
    fn correction(&self, state: &State<f64, N>, out: &mut Correction<f64, N, R>) -> bool {
        self.count();
        self.mechanism.correction(state, out)
    }
    fn switches(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        out: &mut Switches<'_, f64>,
    ) -> &'static [Condition] {
        self.mechanism.switches(state, acceleration, out)
    }
    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        self.mechanism.energy(state)
    }
    fn linearised(
        &self,
        state: &State<f64, N>,
        acceleration: &SVector<f64, N>,
        multiplier: &SVector<f64, R>,
        out: &mut Linearised<f64, N, R>,
    ) -> bool {
        self.count();
        let mechanism = &self.mechanism;
        mechanism.linearised(state, acceleration, multiplier, out)
    }
}

fn stepper<const N: usize, const R: usize>(method: Method) -> Stepper<f64, N, R> {
    Stepper::new(
        method,
        StepControl::Fixed { step: STEP },
        Settings::default(),
    )
    .unwrap()
}

/// A state a few steps before the singular position.
fn before<M: Passing<N, R>, const N: usize, const R: usize>(mechanism: &M) -> State<f64, N> {
    let (angle, rate) = mechanism.singular();
    mechanism.state(0.0, angle - 10.3 * STEP * rate, rate)
}

/// Steps through a singular position, without a limit and with one that is never met.
fn agrees<M: Passing<N, R>, const N: usize, const R: usize>(mechanism: M, method: Method) {
    let counted = Counted::new(mechanism);
    let mechanism: &dyn Mechanism<f64, N, R> = &counted;
    let start = before(&counted.mechanism);
    let (mut free, mut limited) = (stepper::<N, R>(method), stepper::<N, R>(method));
    let mut states = [start; 2];
    let mut most = 0;
    for _ in 0..20 {
        free.step(mechanism, &mut states[0], STEP).unwrap();
        counted.asked.set(0);
        let limit = u32::MAX;
        let told = limited.step_within(mechanism, &mut states[1], STEP, limit);
        assert_eq!(told, Ok(counted.asked.get()), "{method}");
        assert_eq!(states[0], states[1], "{method}");
        most = most.max(counted.asked.get());
    }
    assert_eq!(free.counters(), limited.counters(), "{method}");
    assert!(free.counters().robust_accelerations > 0, "no passage");
    assert!(most > 20, "{most}");
}

#[test]
fn a_limit_that_is_not_met_changes_nothing_and_evaluations_are_told() {
    for method in [Method::Rk4, Method::Dop853, Method::Radau5] {
        agrees::<_, 3, 2>(SliderCrank::default(), method);
        agrees::<_, 5, 4>(FourBars, method);
    }
}

/// Cuts off each step near a singular position after every number of evaluations.
fn is_cut_off<M: Passing<N, R>, const N: usize, const R: usize>(mechanism: M, method: Method) {
    let counted = Counted::new(mechanism);
    let mechanism: &dyn Mechanism<f64, N, R> = &counted;
    let mut stepper = stepper::<N, R>(method);
    let mut state = before(&counted.mechanism);
    let (mut cuts, mut longest) = (0, 0);
    for _ in 0..20 {
        let mut plain = (stepper.clone(), state);
        let needed = plain.0.step_within(mechanism, &mut plain.1, STEP, u32::MAX);
        let needed = needed.unwrap();
        for most in 0..needed {
            let (mut cut, mut reached) = (stepper.clone(), state);
            counted.asked.set(0);
            let error = cut.step_within(mechanism, &mut reached, STEP, most);
            let t = reached.t;
            assert_eq!(
                error,
                Err(SimulateError::TooMuchWork { t, most }),
                "{method}"
            );
            longest = longest.max(counted.asked.get() - most);
            assert!(reached.is_finite(), "{method}, {most}: {reached:?}");
            // Nothing that was spoilt is left.
            let rest = plain.1.t - t;
            if rest > 0.0 {
                cut.step(mechanism, &mut reached, rest).unwrap();
            }
            let off = (reached.q - plain.1.q).norm() + (reached.v - plain.1.v).norm();
            assert!(off < 1e-7, "{method}, {most} at t = {t}: {off:e}");
            cuts += 1;
        }
        (stepper, state) = plain;
    }
    assert!(cuts > 200, "{cuts}");
    assert!(longest <= FEW, "{method}: {longest} more than were granted");
}

#[test]
fn a_step_that_is_cut_off_ends_soon_and_leaves_a_state_to_go_on_from() {
    for method in [Method::Rk4, Method::Radau5] {
        is_cut_off::<_, 3, 2>(SliderCrank::default(), method);
        is_cut_off::<_, 5, 4>(FourBars, method);
    }
}

#[test]
fn what_needs_too_much_work_is_told_with_what_to_do() {
    let error = SimulateError::TooMuchWork { t: 0.25, most: 9 };
    assert_eq!(
        error.to_string(),
        "9 evaluations of the equations are too few for the step at t = 0.25 s; grant more, or \
         take a shorter step"
    );
}
