//! The stages of a passage share the nodes between which they are interpolated, where the
//! sheet is a curve that stays where it is; what they come to is what nodes of their own
//! would say. Where constraints are independent by their form, no configuration is looked at
//! that is not on the way.

use crate::fixtures::system_of;
use crate::mechanisms::{FourBars, Passing, Sled, SliderCrank};
use bricard_runtime::{
    Acceleration, Correction, Energy, Integrator, Mechanism, Method, Position, Rk4, Settings,
    Solver, State, StepControl, Stepper, Structure, Terms,
};
use std::cell::Cell;

/// A mechanism that counts how often its position is asked for, with a structure of its
/// own.
struct Counted<'a, P> {
    mechanism: &'a P,
    structure: &'static Structure,
    positions: Cell<u32>,
}

impl<P, const N: usize, const R: usize> Mechanism<f64, N, R> for Counted<'_, P>
where
    P: Mechanism<f64, N, R>,
{
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        self.mechanism.terms(state, out);
    }

    fn acceleration(&self, state: &State<f64, N>, out: &mut Acceleration<f64, N, R>) -> bool {
        self.mechanism.acceleration(state, out)
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        self.positions.set(self.positions.get() + 1);
        self.mechanism.position(state, out);
    }

    fn correction(&self, state: &State<f64, N>, out: &mut Correction<f64, N, R>) -> bool {
        self.mechanism.correction(state, out)
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        self.mechanism.energy(state)
    }
}

/// Where fixed steps through a singular position lead, and positions asked for.
fn passed<P, const N: usize, const R: usize>(
    mechanism: &P,
    structure: &'static Structure,
) -> (State<f64, N>, u32)
where
    P: Passing<N, R>,
{
    let counted = Counted {
        mechanism,
        structure,
        positions: Cell::new(0),
    };
    let (angle, rate) = mechanism.singular();
    let mut solver: Solver<f64, N, R> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &counted);
    let mut method = Rk4::new();
    let mut state = mechanism.state(0.0, angle - 0.2 * rate.signum(), rate);
    while (state.q[0] - angle) * rate.signum() < 0.2 {
        let bound = state.t + 1e-3;
        state = *method.step(&mut system, &state, bound).unwrap().end();
    }
    (state, counted.positions.get())
}

fn check<P, const N: usize, const R: usize>(mechanism: &P)
where
    P: Passing<N, R>,
{
    let resting = mechanism.structure();
    assert!(resting.scleronomic);
    let moving = Box::leak(Box::new(Structure {
        scleronomic: false,
        ..*resting
    }));
    let (shared, few) = passed(mechanism, resting);
    let (own, many) = passed(mechanism, moving);
    assert_eq!(shared.t, own.t);
    assert!((shared.q - own.q).amax() < 1e-12, "{shared:?} {own:?}");
    assert!((shared.v - own.v).amax() < 1e-11, "{shared:?} {own:?}");
    assert!(3 * few < 2 * many, "{few} positions beside {many}");
}

#[test]
fn stages_of_a_passage_share_their_nodes() {
    check::<_, 3, 2>(&SliderCrank::default());
    check::<_, 5, 4>(&FourBars);
    check::<_, 11, 10>(&FourBars);
}

/// Where adaptive steps lead from a state, and positions asked for.
fn moved<P, const N: usize, const R: usize>(
    mechanism: &P,
    structure: &'static Structure,
    mut state: State<f64, N>,
) -> (State<f64, N>, u32)
where
    P: Mechanism<f64, N, R>,
{
    let counted = Counted {
        mechanism,
        structure,
        positions: Cell::new(0),
    };
    let tolerance = 1e-9;
    let control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let settings = Settings::default();
    let mut stepper = Stepper::<f64, N, R>::new(Method::Dop853, control, settings).unwrap();
    let mechanism: &dyn Mechanism<f64, N, R> = &counted;
    stepper.step(mechanism, &mut state, 5.0).unwrap();
    (state, counted.positions.get())
}

#[test]
fn constraints_that_are_independent_by_their_form_are_looked_at_on_the_way_alone() {
    let usual = Mechanism::<f64, 3, 1>::structure(&Sled);
    let by_form = Box::leak(Box::new(Structure {
        independent: true,
        ..*usual
    }));
    let start = State::new(0.0, [0.2, 0.1, 0.3].into(), [0.0, 0.0, 0.7].into());
    let (searched, many) = moved::<_, 3, 1>(&Sled, usual, start);
    let (known, few) = moved::<_, 3, 1>(&Sled, by_form, start);
    assert!(
        (searched.q - known.q).amax() < 1e-8,
        "{searched:?} {known:?}"
    );
    assert!(
        (searched.v - known.v).amax() < 1e-8,
        "{searched:?} {known:?}"
    );
    // The angles are turned eight times for the sizes of the rows.
    assert!(few + 8 <= many, "{few} positions beside {many}");
}
