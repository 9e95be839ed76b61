//! Parameters set to degenerate values between runs, and back.

use crate::judge::start;
use bricard_runtime::{Interface, Mechanism, Options, Visitor, Whole, simulate};

struct ThereAndBack;

impl Visitor<f64> for ThereAndBack {
    type Output = ();

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M)
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let options = Options::dop853(0.5, 1e-9);
        let run = |mechanism: &dyn Whole<f64, N, R>| {
            let state = start(mechanism, &[])?;
            let ran = simulate(mechanism, &state, &options, &mut []);
            ran.map(|summary| summary.end)
                .map_err(|failure| failure.error.to_string())
        };
        let first = run(&mechanism).expect("it runs with its own parameters");
        let parameters = mechanism.structure().parameters;
        for (place, parameter) in parameters.iter().enumerate() {
            let usual = mechanism.parameter(place).expect("it is a parameter");
            for value in [0.0, -usual, f64::NAN, f64::INFINITY, 1e300, 1e-300] {
                mechanism.set_parameter(place, value);
                // Whatever it comes to, it ends, and nothing of it stays behind.
                let _ended: Result<_, String> = run(&mechanism);
            }
            mechanism.set_parameter(place, usual);
            let again = run(&mechanism).expect("it runs as before");
            assert_eq!(first, again, "after {}", parameter.name);
        }
    }
}

#[test]
fn degenerate_parameters_between_runs_leave_no_trace() {
    for name in [
        "double_pendulum",
        "four_bar",
        "slider_crank",
        "point_pendulum",
    ] {
        bricard_stress::visit(name, ThereAndBack).expect("it is in the catalogue");
    }
}
