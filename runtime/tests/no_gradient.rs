//! A constraint whose gradient is zero everywhere, so that nothing tells how large its row is: it is
//! held against the states all the same.

use crate::fixtures::{BEAD, Framed, simulate};
use bricard_runtime::{
    ConstraintRow, DynamicsError, Energy, Form, IntegrateError, Mechanism, Options, Position,
    SimulateError, State, Structure, Terms,
};

/// A mass on the line `y = 0`, beside an equation `growth·t = 0`.
#[derive(Clone, Copy, Debug)]
struct Beside {
    growth: f64,
}

static BESIDE: Structure = Structure {
    conservative: false,
    constraints: &[row("y = 0"), row("growth*t = 0")],
    ..BEAD
};

const fn row(text: &'static str) -> ConstraintRow {
    ConstraintRow {
        text,
        line: 1,
        holonomic: true,
    }
}

impl Mechanism<f64, 2, 2> for Beside {
    fn structure(&self) -> &'static Structure {
        &BESIDE
    }

    fn terms(&self, _: &State<f64, 2>, out: &mut Terms<f64, 2, 2>) {
        out.mass.fill_with_identity();
        out.jacobian[(0, 1)] = 1.0;
    }

    fn position(&self, state: &State<f64, 2>, out: &mut Position<f64, 2, 2>) {
        out.mass.fill_with_identity();
        out.jacobian[(0, 1)] = 1.0;
        out.residual = [state.q[1], self.growth * state.t].into();
    }

    fn energy(&self, state: &State<f64, 2>) -> Energy<f64> {
        crate::mechanisms::supplied(0.5 * state.v.norm_squared(), 0.0, 0.0)
    }
}

#[test]
fn what_nothing_can_hold_ends_the_run() {
    let start = State::new(0.0, [1.0, 0.0].into(), [0.5, 0.0].into());
    for form in [Form::Reduced, Form::Full] {
        let mut options = Options::dop853(1.0, 1e-9);
        options.settings.form = form;
        let beside = |growth| Framed::new(Beside { growth }, &BESIDE);
        let fulfilled = simulate(&beside(0.0), &start, &options, &mut []);
        assert!(fulfilled.is_ok(), "{form:?}: {fulfilled:?}");
        let violated = simulate(&beside(1.0), &start, &options, &mut []);
        let failure = violated.expect_err("the equation does not hold");
        assert!(
            matches!(
                failure.error,
                SimulateError::Integrate(IntegrateError::Dynamics(
                    DynamicsError::ProjectionFailed { row: 1, .. }
                ))
            ),
            "{form:?}: {failure}"
        );
    }
}
