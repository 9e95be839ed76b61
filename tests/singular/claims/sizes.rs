//! Descriptions of one mechanism in other units are the same mechanism.

use bricard_runtime::{Options, State, StepControl, Whole, assemble, simulate};
use bricard_singular::descriptions::unitless::Unitless;

/// Where it is after some passages, in lengths of its links, and how many those were.
fn moved(l: f64) -> ([f64; 4], Option<u64>) {
    let mut mechanism = Unitless::<f64>::default();
    mechanism.parameters.l = l;
    let mechanism: &dyn Whole<f64, 4, 3> = &mechanism;
    let start: State<f64, 4> = assemble(mechanism, &mechanism.start(), 0.0)
        .unwrap_or_else(|failure| panic!("length {l:e}: {failure}"));
    let control = StepControl::Adaptive {
        relative: 1e-9,
        absolute: 1e-9 * l,
    };
    let options = Options {
        step_control: control,
        ..Options::dop853(5.0, 1e-9)
    };
    let ran = simulate(mechanism, &start, &options, &mut []);
    let summary = ran.unwrap_or_else(|failure| panic!("length {l:e}: {failure}"));
    ((summary.end.q / l).into(), summary.passages)
}

#[test]
fn lengths_without_a_unit_may_be_of_any_size() {
    let (wanted, passages) = moved(1.0);
    assert!(passages > Some(3), "{passages:?}");
    for l in [1e8, 1e4, 1e-2, 1e-5, 1e-8] {
        let (found, count) = moved(l);
        assert_eq!(count, passages, "length {l:e}");
        for (found, wanted) in found.into_iter().zip(wanted) {
            let error = (found - wanted).abs();
            assert!(error < 1e-6, "length {l:e}: {found} instead of {wanted}");
        }
    }
}
