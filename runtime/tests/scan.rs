//! Adaptive runs from many starts: none leaves its branch, none is much worse
//! than the others.
//!
//! `BRICARD_LONG=1` takes 200 starts instead of 12.

use crate::mechanisms::{FourBars, Passing, SliderCrank};
use crate::toys::{Framed, PLAIN};
use bricard_runtime::{Audit, Options, Structure, simulate};

static CONSERVATIVE: Structure = Structure {
    conservative: true,
    ..PLAIN
};

/// The end of the runs (s).
const END: f64 = 8.0;

/// Errors of the coordinates at the end, sorted, from starts at rest between two
/// angles (degrees).
fn errors<P, const N: usize, const R: usize>(
    mechanism: P,
    (low, high): (f64, f64),
    options: &Options<f64>,
) -> Vec<f64>
where
    P: Passing<N, R> + Copy,
{
    let starts = match std::env::var_os("BRICARD_LONG") {
        Some(_) => 200,
        None => 12,
    };
    let framed = Framed::<P, N>::new(mechanism, &CONSERVATIVE);
    let run = |i: usize| {
        let part = (i as f64 + 0.37) / starts as f64;
        let angle = (low + (high - low) * part).to_radians();
        let start = mechanism.state(0.0, angle, 0.0);
        let summary = simulate::<_, _, N, R>(&framed, &start, options, &mut [])
            .unwrap_or_else(|failure| panic!("from {angle}: {failure}"));
        let (angle, rate) = mechanism.reduction().after(END, (angle, 0.0));
        (summary.end.q - mechanism.state(END, angle, rate).q).amax()
    };
    let mut errors: Vec<f64> = (0..starts).map(run).collect();
    errors.sort_by(f64::total_cmp);
    errors
}

/// No run is off by more than the sensitivity of the motion explains: a lost
/// branch would be an error of the order of one.
fn check<P, const N: usize, const R: usize>(mechanism: P, angles: (f64, f64))
where
    P: Passing<N, R> + Copy,
{
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        for mut options in [
            Options::dp5(END, tolerance),
            Options::dop853(END, tolerance),
        ] {
            options.audit = Audit::NONE;
            options.most_steps = Some(50_000);
            let errors = errors(mechanism, angles, &options);
            let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
            println!("{} at {tolerance:e}: {median:e} {worst:e}", options.scheme);
            assert!(
                worst < 1e4 * tolerance,
                "{} at {tolerance:e}: {worst:e}",
                options.scheme
            );
        }
    }
}

#[test]
fn no_start_of_the_double_four_bar_loses_its_branch() {
    check::<_, 5, 4>(FourBars, (45.0, 85.0));
}

#[test]
fn no_start_of_the_slider_crank_loses_its_branch() {
    check::<_, 3, 2>(SliderCrank::default(), (20.0, 70.0));
}
