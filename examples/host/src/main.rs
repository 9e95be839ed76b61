//! A motor controller around an engine: every millisecond it reads the crank's
//! speed and sets the motor's torque, while the engine runs through its dead centres.

use bricard_runtime::{
    Interface, Mechanism, Method, Settings, State, StepControl, Stepper, assemble,
};
use engine::Engine;
use std::error::Error;

bricard_runtime::include_mechanism!("engine");

/// The time between two decisions of the controller (s).
const PERIOD: f64 = 1e-3;

/// A proportional–integral controller of the crank's speed.
struct Controller {
    wanted: f64,
    proportional: f64,
    integral: f64,
    sum: f64,
}

impl Controller {
    /// The torque (N·m) for a speed (rad/s).
    fn torque(&mut self, speed: f64) -> f64 {
        let error = self.wanted - speed;
        self.sum += error * PERIOD;
        self.proportional * error + self.integral * self.sum
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut engine = Engine::<f64>::default();
    let mut state: State<f64, 3> = assemble(&engine, &engine.start(), 0.0)?;
    let mut stepper = Stepper::new(
        Method::Rk4,
        StepControl::Fixed { step: PERIOD },
        Settings::default(),
    )?;
    let mut controller = Controller {
        wanted: 10.0,
        proportional: 20.0,
        integral: 200.0,
        sum: 0.0,
    };

    println!("  time    crank    speed   torque  energy");
    for tick in 0..5000 {
        let torque = controller.torque(state.v[0]);
        engine.inputs.torque = Some(torque);
        if tick % 500 == 0 {
            report(&engine, &state, torque);
        }
        stepper.step(&engine, &mut state, PERIOD)?;
    }
    report(&engine, &state, controller.torque(state.v[0]));

    let error = stepper.solver().on(&engine).constraint_error(&state);
    let counters = stepper.counters();
    println!(
        "{} revolutions, each through two singular positions; largest constraint error {:.0e} m; \
         {} accelerations by the cheap path, {} by the robust one",
        (state.q[0] / std::f64::consts::TAU).floor(),
        error.position,
        counters.cheap_accelerations,
        counters.robust_accelerations,
    );
    if error.position > 1e-12 {
        return Err("the engine has come apart".into());
    }
    Ok(())
}

fn report(engine: &Engine<f64>, state: &State<f64, 3>, torque: f64) {
    let energy = engine.energy(state);
    println!(
        "{:6.3} {:8.3} {:8.3} {:8.2} {:7.2}",
        state.t,
        state.q[0],
        state.v[0],
        torque,
        energy.kinetic + energy.potential
    );
}
