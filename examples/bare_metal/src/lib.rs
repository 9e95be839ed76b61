//! A motor controller around an engine, a thousand times a second, as it runs on a
//! microcontroller: no standard library, no allocation, bounded work in each tick.
#![no_std]
#![forbid(unsafe_code)]

use bricard_runtime::{
    Interface, Method, Real, Settings, SimulateError, State, StepControl, Stepper, assemble,
};
use engine::Engine;

bricard_runtime::include_mechanism!("engine");

/// The time between two decisions of the controller (s).
pub const PERIOD: f64 = 1e-3;
/// Decisions in a run, which ends after five seconds.
pub const TICKS: u32 = 5000;
/// The speed that the crank is brought to in a run (rad/s).
pub const SPEED: f64 = 10.0;
/// Ticks after which a state is reported.
pub const REPORTED: u32 = 50;
/// Evaluations of the equations of motion that one tick may take.
pub const MOST_EVALUATIONS: u32 = 2000;

/// The engine, its motor, and the controller between them.
pub struct Loop<T: Real> {
    engine: Engine<T>,
    state: State<T, 3>,
    stepper: Stepper<T, 3, 2>,
    controller: Controller<T>,
}

impl<T: Real> Loop<T> {
    /// The engine at rest where its description starts it, to be brought to a speed
    /// (rad/s). None if it can't be assembled.
    pub fn new(speed: f64) -> Option<Self> {
        let engine = Engine::<T>::default();
        let state = assemble(&engine, &engine.start(), T::zero()).ok()?;
        let step = T::from_f64(PERIOD);
        let step_control = StepControl::Fixed { step };
        let stepper = Stepper::new(Method::Rk4, step_control, Settings::default()).ok()?;
        Some(Self {
            engine,
            state,
            stepper,
            controller: Controller::new(T::from_f64(speed)),
        })
    }

    /// One tick: the controller reads the speed and sets the torque, and the engine moves
    /// on. The number of evaluations that this took.
    pub fn tick(&mut self) -> Result<u32, SimulateError<T>> {
        let torque = self.controller.torque(self.state.v[0]);
        self.engine.inputs.torque = Some(torque);
        let period = T::from_f64(PERIOD);
        let Self {
            engine,
            state,
            stepper,
            ..
        } = self;
        stepper.step_within(engine, state, period, MOST_EVALUATIONS)
    }

    /// Coordinates, then velocities.
    pub fn state(&self) -> [f64; 6] {
        let [q1, q2, q3] = self.state.q.data.0[0].map(T::to_f64);
        let [v1, v2, v3] = self.state.v.data.0[0].map(T::to_f64);
        [q1, q2, q3, v1, v2, v3]
    }

    /// Accelerations next to singular positions, which the motion passes.
    pub fn beside(&self) -> u64 {
        let counters = self.stepper.counters();
        counters.beside_accelerations + counters.robust_accelerations
    }
}

/// A proportional–integral controller of the crank's speed.
struct Controller<T> {
    wanted: T,
    proportional: T,
    integral: T,
    sum: T,
}

impl<T: Real> Controller<T> {
    fn new(wanted: T) -> Self {
        Self {
            wanted,
            proportional: T::from_f64(20.0),
            integral: T::from_f64(200.0),
            sum: T::zero(),
        }
    }

    /// The torque (N·m) for a speed (rad/s).
    fn torque(&mut self, speed: T) -> T {
        let error = self.wanted - speed;
        self.sum += error * T::from_f64(PERIOD);
        self.proportional * error + self.integral * self.sum
    }
}
