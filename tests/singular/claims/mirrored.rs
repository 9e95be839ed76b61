//! What is known of one singular configuration is no knowledge of another that looks alike.

use crate::largest::Largest;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Form, Method, Options, StepControl, Whole, assemble, simulate};
use bricard_singular::descriptions::mirrored::Mirrored;

/// By how much the bars of the parallelogram are not parallel (m).
fn skew(q: &SVector<f64, 4>) -> f64 {
    (q[2] - 1.0 - q[0]).abs().max((q[3] - q[1]).abs())
}

/// Fixed steps of all lengths, and all methods with step control.
fn settings() -> impl Iterator<Item = Options<f64>> {
    let fixed = [0.01, 0.005, 0.0025, 0.001].map(|step| Options::rk4(6.0, step));
    let adaptive = Method::ALL[1..].iter().flat_map(|method| {
        [1e-6, 1e-8, 1e-9, 1e-10].map(|tolerance| {
            let control = StepControl::Adaptive {
                relative: tolerance,
                absolute: tolerance,
            };
            Options::new(6.0, *method, control)
        })
    });
    fixed.into_iter().chain(adaptive)
}

/// All settings, in the null-space form and with all coordinates.
fn forms() -> impl Iterator<Item = Options<f64>> {
    settings().flat_map(|reduced| {
        let mut full = reduced;
        full.settings.form = Form::Full;
        [reduced, full]
    })
}

#[test]
fn nodes_of_a_passage_do_not_serve_its_mirror_image() {
    let mechanism: &dyn Whole<f64, 4, 3> = &Mirrored::default();
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    for options in forms() {
        let mut largest = Largest::of(skew);
        let name = format!(
            "{:?} {:?} {:?}",
            options.settings.form, options.method, options.step_control
        );
        let ran = simulate(mechanism, &start, &options, &mut [&mut largest]);
        let summary = ran.unwrap_or_else(|failure| panic!("{name}: {failure}"));
        assert_eq!(summary.passages, Some(4), "{name}");
        assert_eq!(summary.events, 4, "{name}");
        assert!(largest.value < 1e-7, "{name}: {}", largest.value);
        let lost = summary.energy_error.expect("audited");
        assert!(lost < 1e-4, "{name}: {lost} J");
    }
}
