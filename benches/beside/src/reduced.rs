//! A closed loop's motion in one coordinate and without constraints, written by hand: what is
//! left of a run when everything that loops cost is gone.

use bricard_runtime::{
    Acceleration, Energy, Mechanism, Method, Settings, State, StepControl, Stepper, Structure,
    Terms,
};
use bricard_testkit::Reduction;
use std::error::Error;

/// An exact reduction as a mechanism with an emitted solve, as generated code has.
#[derive(Clone, Copy, Debug)]
pub struct Reduced(pub Reduction);

static REDUCED: Structure = Structure {
    name: "Reduced",
    ..Structure::PLAIN
};

impl Reduced {
    /// The coordinate after `span` seconds, from `start` at rest.
    ///
    /// # Errors
    ///
    /// A method that doesn't take that step control; a run that fails.
    pub fn after(
        &self,
        span: f64,
        start: f64,
        (method, control): (Method, StepControl<f64>),
    ) -> Result<f64, Box<dyn Error>> {
        let mut stepper = Stepper::<f64, 1, 0>::new(method, control, Settings::default())?;
        let mut state = State::new(0.0, [start].into(), [0.0].into());
        stepper.step(self, &mut state, span)?;
        Ok(state.q[0])
    }
}

impl Mechanism<f64, 1, 0> for Reduced {
    fn structure(&self) -> &'static Structure {
        &REDUCED
    }

    fn terms(&self, state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        out.mass[(0, 0)] = self.0.mass(state.q[0]);
        out.force[0] = out.mass[(0, 0)] * self.0.acceleration(state.q[0], state.v[0]);
    }

    fn acceleration(&self, state: &State<f64, 1>, out: &mut Acceleration<f64, 1, 0>) -> bool {
        out.acceleration[0] = self.0.acceleration(state.q[0], state.v[0]);
        true
    }

    fn energy(&self, _state: &State<f64, 1>) -> Energy<f64> {
        Energy::default()
    }
}
