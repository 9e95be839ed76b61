//! Runs in single precision: as many passages through singular positions as in double precision.

use bricard::double_four_bar::DoubleFourBar;
use bricard_runtime::{Interface, Options, Real, Summary, assemble, simulate};

/// How many passages a run of four seconds has.
fn passages<T: Real>(options: Options<T>) -> Option<u64> {
    let mechanism = DoubleFourBar::<T>::default();
    let start = assemble(&mechanism, &mechanism.start(), T::zero()).expect("the start assembles");
    let summary: Summary<T, 5> =
        simulate(&mechanism, &start, &options, &mut []).expect("the run ends");
    summary.passages
}

/// Both loops become singular at once, and count as one passage, though round-off puts them at
/// times that differ.
#[test]
fn loops_that_become_singular_at_once_count_once() {
    let until = 4.0;
    let exact = passages(Options::dop853(until, 1e-9));
    assert_eq!(exact, Some(4));
    let until = 4.0_f32;
    for step in [1e-3, 2e-3, 5e-3, 1e-2] {
        assert_eq!(passages(Options::rk4(until, step)), exact, "step {step}");
    }
    for tolerance in [2e-6, 1e-5, 3e-5, 1e-4] {
        let options = [
            Options::dop853(until, tolerance),
            Options::dp5(until, tolerance),
        ];
        for options in options {
            let method = options.method;
            assert_eq!(passages(options), exact, "{method}, {tolerance}");
        }
    }
}
