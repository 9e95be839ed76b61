//! Several loops that become singular at the same instant.

use bricard_runtime::{Form, Interface, Method, Options, assemble, simulate};
use bricard_singular::descriptions::scissor_lift::ScissorLift;
use bricard_singular::descriptions::scissor_lift_reduced::ScissorLiftReduced;
use bricard_singular::descriptions::three_folds::ThreeFolds;
use bricard_singular::descriptions::two_folds::TwoFolds;

/// `tan(p/2)/tan(r/2)` of an antiparallelogram with links of these lengths.
fn ratio(short: f64, long: f64) -> f64 {
    (short - long) / (short + long)
}

/// By how much the half angles of crank and rocker miss a ratio.
fn off(crank: f64, rocker: f64, ratio: f64) -> f64 {
    let ((s, c), (sin, cos)) = ((crank / 2.0).sin_cos(), (rocker / 2.0).sin_cos());
    (s * cos - ratio * sin * c).abs()
}

/// Each loop is on the sheet where it began, and each fold was passed once: far from it some of the
/// loops seem regular.
#[test]
fn loops_of_unlike_masses_that_fold_together_stay_on_their_sheets() {
    let mut mechanism = ThreeFolds::default();
    let methods = [Method::Dp5, Method::Radau5];
    for (w, heavy) in [(-5.621, 5.0), (-6.266, 5.0), (-5.847, 50.0), (-7.3, 50.0)] {
        mechanism.parameters.m2 = heavy;
        let mut start = mechanism.start();
        start.v[0].value = w;
        let start = assemble::<f64, _, 7, 6>(&mechanism, &start, 0.0).expect("a start");
        for method in methods {
            for tolerance in [1e-8, 1e-9, 1e-10, 1e-11] {
                for form in [Form::Reduced, Form::Full] {
                    let name = format!("{w} {heavy} {method:?} {tolerance:e} {form:?}");
                    let mut options = Options::dop853(2.0, tolerance);
                    (options.method, options.settings.form) = (method, form);
                    let done = simulate::<_, _, 7, 6>(&mechanism, &start, &options, &mut [])
                        .unwrap_or_else(|failure| panic!("{name}: {failure}"));
                    let [p0, _, r0, c1, r1, _, r2] = done.end.q.into();
                    let wrong = [
                        off(p0, r0, ratio(0.499, 1.209)),
                        (r1 - r0).abs().max(c1.abs()),
                        off(r1, r2, ratio(0.781, 1.233)),
                    ];
                    assert!(wrong.iter().all(|off| *off < 1e-9), "{name}: {wrong:?}");
                    assert_eq!(done.passages, Some(done.events), "{name}");
                }
            }
        }
    }
}

/// A step goes over both, and the constraints have the same determinant on its two sides. Folds that
/// are nearer to each other than what a step may be off may count as one.
#[test]
fn loops_that_fold_shortly_one_after_the_other_are_two_passages() {
    for (bent, tolerance) in [(1e-3, 1e-6), (1e-4, 1e-7), (1e-4, 1e-9), (1e-5, 1e-9)] {
        for round in 0..12 {
            let mut mechanism = TwoFolds::default();
            let k = f64::from(round);
            let parameters = &mut mechanism.parameters;
            parameters.bent = bent;
            (parameters.q0, parameters.w0) = (-0.692 - 0.11 * k, 8.038 - 0.33 * k);
            let start = assemble::<f64, _, 5, 4>(&mechanism, &mechanism.start(), 0.0);
            let start = start.expect("it can be assembled");
            for method in [Method::Dop853, Method::Dp5, Method::Radau9] {
                let mut options = Options::dop853(2.0, tolerance);
                options.method = method;
                let done = simulate::<_, _, 5, 4>(&mechanism, &start, &options, &mut []);
                let name = format!("{bent:e} {tolerance:e} {round} {method:?}");
                let done = done.unwrap_or_else(|failure| panic!("{name}: {failure}"));
                assert_eq!(done.passages, Some(done.events), "{name}");
            }
        }
    }
}

/// Beside the configuration where all storeys fold no nodes are narrow enough for a tight
/// tolerance, and the equations at the state itself are exact enough.
#[test]
fn storeys_that_fold_together_pass_at_any_tolerance() {
    let (lift, reduced) = (ScissorLift::<f64>::default(), ScissorLiftReduced::default());
    let start = assemble::<f64, _, 1, 0>(&reduced, &reduced.start(), 0.0).expect("a start");
    let exact = simulate::<_, _, 1, 0>(&reduced, &start, &Options::dop853(2.0, 1e-13), &mut []);
    let exact = exact.expect("it has no constraints").end.q[0];
    let start = assemble::<f64, _, 13, 12>(&lift, &lift.start(), 0.0).expect("a start");
    for method in [Method::Dop853, Method::Dp5, Method::Radau9] {
        for tolerance in [1e-8, 1e-10, 1e-11, 1e-12] {
            let name = format!("{method:?} {tolerance:e}");
            let options = Options {
                method,
                ..Options::dop853(2.0, tolerance)
            };
            let done = simulate::<_, _, 13, 12>(&lift, &start, &options, &mut [])
                .unwrap_or_else(|failure| panic!("{name}: {failure}"));
            let angles = done.end.q.iter().skip(1);
            let off = angles.fold(0.0_f64, |off, angle| off.max((angle - exact).abs()));
            assert!(off < 200.0 * tolerance + 1e-9, "{name}: {off:e}");
            assert_eq!(done.passages, Some(6), "{name}");
        }
    }
}
