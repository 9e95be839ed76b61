//! Stiff mechanisms of the library against published and computed references.

use crate::library::{Inspect, inspect};
use bricard::slider_crank::SliderCrank;
use bricard_runtime::{
    Initial, Interface, Method, Options, StepControl, Summary, Whole, assemble, simulate,
};

/// Height of the sleeve of the flyball governor after 10 s (m): an implicit method of
/// order 5 at tolerance 1e-12, on the equations in three coordinates.
const SLEEVE: f64 = 0.6196229170613131;

/// Coordinates of the slider–crank with flexible rod after 0.1 s (rad, m): the reference
/// of the published test set, which keeps an error of 2e-10 m of its start in `x3`.
const FLEXIBLE: [f64; 7] = [
    15.00000000000104,
    -0.331173498825626,
    0.169737332842786,
    0.0001893192899613509,
    2.375751249879174e-05,
    -5.323896770569702e-06,
    -8.363313279112129e-06,
];

/// Runs a mechanism of the library from its own start.
struct Run {
    options: Options<f64>,
}

impl Inspect<f64> for Run {
    type Output = (Vec<f64>, u64);

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> Self::Output {
        let mechanism = &*mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        let run = simulate(mechanism, &start, &self.options, &mut []);
        let Summary {
            end,
            steps,
            rejected,
            ..
        } = run.unwrap_or_else(|failure| panic!("{failure}"));
        (end.q.as_slice().to_vec(), steps + rejected)
    }
}

fn run(name: &str, until: f64, method: Method, tolerance: f64) -> (Vec<f64>, u64) {
    let step_control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let options = Options::new(until, method, step_control);
    inspect(name, Run { options })
}

#[test]
fn the_flyball_governor_takes_a_fiftieth_of_the_steps_of_dp5() {
    let governor = |method, tolerance| {
        let (q, steps) = run("flyball_governor", 10.0, method, tolerance);
        let error = (q[2] - SLEEVE).abs();
        assert!(error <= 1e-7, "{method}: s is off by {error:e}");
        steps
    };
    let explicit = governor(Method::Dp5, 1e-7).min(governor(Method::Dp5, 1e-5));
    let implicit = governor(Method::Radau9, 1e-7);
    assert!(
        50 * implicit <= explicit,
        "{implicit} steps instead of {explicit}"
    );
}

#[test]
fn the_flexible_slider_crank_ends_at_the_published_reference() {
    for method in [Method::Dop853, Method::Radau9] {
        let (q, _) = run("flexible_slider_crank", 0.1, method, 1e-12);
        for (i, (found, exact)) in q.iter().zip(FLEXIBLE).enumerate() {
            let error = ((found - exact) / exact).abs();
            assert!(
                error <= 1e-7,
                "{method}: q[{i}] = {found:e} is off by {error:e}"
            );
        }
    }
}

/// The equations of a step of this length can't be solved beside the second passage.
#[test]
fn implicit_steps_of_fixed_length_pass_singular_positions_at_speed() {
    let mechanism = SliderCrank::<f64>::default();
    let mut start = mechanism.start();
    start.v[0] = Initial {
        value: 20.0,
        held: true,
    };
    let start = assemble::<f64, _, 3, 2>(&mechanism, &start, 0.0).expect("the start assembles");
    let run = |options: &Options<f64>| {
        simulate::<_, _, 3, 2>(&mechanism, &start, options, &mut [])
            .unwrap_or_else(|failure| panic!("{:?}: {failure}", options.method))
    };
    let exact = run(&Options::dop853(2.0, 1e-11));
    for method in [Method::Radau5, Method::Radau9] {
        let fixed = run(&Options::new(
            2.0,
            method,
            StepControl::Fixed { step: 0.01 },
        ));
        assert_eq!(fixed.passages, exact.passages, "{method}");
        let off = (fixed.end.q - exact.end.q).norm();
        assert!(off < 0.02, "{method}: {off}");
    }
}
