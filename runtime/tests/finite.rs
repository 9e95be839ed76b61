//! What is not a number is not swallowed: a run whose energy, power or event functions stop
//! being numbers says which.

use crate::fixtures::{Framed, Oscillator, PLAIN, simulate};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Audit, Direction, DynamicsError, Energy, Event, IntegrateError, Mechanism, Method, Options,
    Settings, SimulateError, State, StepControl, Stepper, Structure, Terms, Watched, Whole,
};

static CONSERVATIVE: Structure = Structure {
    conservative: true,
    ..PLAIN
};

static WITH_EVENT: Structure = Structure {
    events: &[Event {
        name: "halved",
        direction: Direction::Crossing,
    }],
    ..PLAIN
};

/// An oscillator that is sound but for its energies, which are spoiled from the
/// displacement 1/2 downwards.
#[derive(Clone, Copy, Debug)]
struct Spoiled(Spoiler);

type Spoiler = fn(&mut Energy<f64>);

impl Mechanism<f64, 1, 0> for Spoiled {
    fn structure(&self) -> &'static Structure {
        &PLAIN
    }

    fn terms(&self, state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        Oscillator::default().terms(state, out);
    }

    fn energy(&self, state: &State<f64, 1>) -> Energy<f64> {
        let mut energy = Oscillator::default().energy(state);
        if state.q[0] < 0.5 {
            (self.0)(&mut energy);
        }
        energy
    }
}

fn start(q: f64) -> State<f64, 1> {
    State::new(0.0, SVector::from([q]), SVector::from([0.0]))
}

/// Which quantity a run complained of, and when.
fn complaint(error: SimulateError<f64>) -> (f64, Watched) {
    match error {
        SimulateError::Observe(DynamicsError::WatchedNotFinite { t, quantity }) => (t, quantity),
        error => panic!("{error:?}"),
    }
}

#[test]
fn a_run_ends_where_an_energy_or_the_power_stops_being_a_number() {
    let spoilers: [(Spoiler, Watched, &str); 4] = [
        (
            |energy| (energy.potential, energy.balance) = (f64::NAN, f64::NAN),
            Watched::PotentialEnergy,
            "the potential energy is infinite or NaN",
        ),
        (
            |energy| (energy.kinetic, energy.balance) = (f64::NAN, f64::NAN),
            Watched::KineticEnergy,
            "the kinetic energy is infinite or NaN",
        ),
        (
            |energy| energy.balance = f64::INFINITY,
            Watched::PotentialEnergy,
            "the potential energy",
        ),
        (
            |energy| energy.power = f64::NAN,
            Watched::Power,
            "the power that is supplied",
        ),
    ];
    for (spoil, quantity, said) in spoilers {
        let mechanism = Framed::new(Spoiled(spoil), &PLAIN);
        let options = Options::rk4(3.0, 0.125);
        let failure = simulate::<1, 0>(&mechanism, &start(1.0), &options, &mut [])
            .expect_err("the energy is spoiled");
        let (t, found) = complaint(failure.error);
        assert_eq!(found, quantity);
        // cos(π/3) = 1/2, rounded up to the end of a step, or a node of its power.
        assert!((1.047..=1.13).contains(&t), "{t}");
        assert!(failure.error.to_string().contains(said), "{failure}");
        assert!(failure.summary.end.t < t, "the last good state is kept");
        let early = simulate::<1, 0>(&mechanism, &start(0.25), &options, &mut []);
        assert!(early.is_err(), "{quantity:?} at the start");
    }
}

#[test]
fn energy_that_is_not_a_number_cannot_be_kept() {
    let spoil = |energy: &mut Energy<f64>| energy.balance = f64::NAN;
    let mechanism = Framed::new(Spoiled(spoil), &CONSERVATIVE);
    let mut options = Options::rk4(3.0, 0.125);
    options.keep_energy = true;
    options.audit = Audit::NONE;
    for (q, early) in [(1.0, false), (0.25, true)] {
        let failure = simulate::<1, 0>(&mechanism, &start(q), &options, &mut [])
            .expect_err("the energy is spoiled");
        let SimulateError::Integrate(IntegrateError::Dynamics(DynamicsError::WatchedNotFinite {
            t,
            quantity,
        })) = failure.error
        else {
            panic!("{failure:?}");
        };
        assert_eq!(quantity, Watched::PotentialEnergy);
        assert_eq!(t == 0.0, early);
    }
}

#[test]
fn an_event_function_that_is_not_a_number_is_named() {
    let mut mechanism = Framed::new(Oscillator::default(), &WITH_EVENT);
    mechanism.events = |state, values| values[0] = (state.q[0] - 0.5).sqrt() - 0.1;
    let options = Options::dp5(3.0, 1e-6);
    let failure = simulate::<1, 0>(&mechanism, &start(1.0), &options, &mut [])
        .expect_err("a root of a negative number");
    let (t, quantity) = complaint(failure.error);
    assert_eq!(quantity, Watched::Event("halved"));
    assert!(t > 1.047 && failure.to_string().contains("event `halved`"));
}

/// An acceleration that is a number, and too large to step with.
#[derive(Clone, Copy, Debug)]
struct Huge;

impl Mechanism<f64, 1, 0> for Huge {
    fn structure(&self) -> &'static Structure {
        &PLAIN
    }

    fn terms(&self, _state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        out.mass[0] = 1.0;
        out.force[0] = 1e308;
    }

    fn energy(&self, _state: &State<f64, 1>) -> Energy<f64> {
        Energy::default()
    }
}

#[test]
fn a_step_of_fixed_length_that_overflows_is_refused() {
    let refused = |error: SimulateError<f64>| {
        let not_finite = DynamicsError::NotFinite { t: 4.0 };
        assert_eq!(
            error,
            SimulateError::Integrate(IntegrateError::Dynamics(not_finite))
        );
    };
    let mechanism: &dyn Whole<f64, 1, 0> = &Framed::new(Huge, &PLAIN);
    for method in [Method::Rk4, Method::Dp5, Method::Dop853] {
        let step_control = StepControl::Fixed { step: 4.0 };
        let mut options = Options::new(4.0, method, step_control);
        options.audit = Audit::NONE;
        let failure = simulate(mechanism, &start(0.0), &options, &mut []);
        refused(failure.expect_err("beyond the largest number").error);
        let mut stepper = Stepper::<f64, 1, 0>::new(method, step_control, Settings::default())
            .expect("the step is positive");
        let mut state = start(0.0);
        let error = stepper.step(mechanism, &mut state, 4.0);
        refused(error.expect_err("beyond the largest number"));
        assert_eq!(state, start(0.0), "the last good state");
    }
}
