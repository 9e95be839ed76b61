//! Adaptive runs from many starts: none leaves its branch, none is much worse
//! than the others, and singular positions cost no rejected steps.
//!
//! `BRICARD_LONG=1` takes 200 starts instead of 12.

use crate::fixtures::{Framed, PLAIN, simulate};
use crate::mechanisms::{FourBars, Passing, Reduced, SliderCrank};
use bricard_runtime::{Audit, Mechanism, Options, State, Structure};
use core::fmt::{Display, Formatter, Result};

static CONSERVATIVE: Structure = Structure {
    conservative: true,
    ..PLAIN
};

/// The end of the runs (s).
const END: f64 = 8.0;

/// Errors below this are round-off: their quotients say nothing.
const FLOOR: f64 = 1e-10;

/// How much worse than the median the worst start may be. At the smallest tolerances the
/// worst of a thousand passages through a singular position is off by six times the
/// median, which is round-off; how far that shows at the end is a matter of chance.
const SPREAD: f64 = 4.0;

/// How many times as large the share of rejected steps may be as without
/// constraints, whose errors are measured in fewer coordinates.
const MORE_REJECTED: f64 = 1.25;

/// The share of rejected steps that may come on top: a few runs are not enough for
/// better statistics.
const SOME_REJECTED: f64 = 0.01;

/// What is found from all starts.
struct Scan {
    /// Errors at the end, sorted.
    errors: Vec<f64>,
    /// Rejected steps of all runs.
    rejected: u64,
    /// Accepted steps of all runs.
    accepted: u64,
}

/// Error, rejected and accepted steps of a run.
type Run = (f64, u64, u64);

impl Scan {
    fn new(mut runs: Vec<Run>) -> Self {
        runs.sort_by(|a, b| f64::total_cmp(&a.0, &b.0));
        Self {
            errors: runs.iter().map(|run| run.0).collect(),
            rejected: runs.iter().map(|run| run.1).sum(),
            accepted: runs.iter().map(|run| run.2).sum(),
        }
    }

    fn median(&self) -> f64 {
        self.errors[self.errors.len() / 2]
    }

    fn worst(&self) -> f64 {
        self.errors[self.errors.len() - 1]
    }

    /// Whether the worst start is not much worse than the median, or than what
    /// the method makes at worst of the same motions without constraints.
    fn is_even(&self, alone: &Self) -> bool {
        let worst = self.worst();
        worst <= FLOOR || worst <= SPREAD * self.median().max(alone.worst())
    }

    /// Whether constraints and their singular positions cost no rejected steps.
    fn rejects_no_more(&self, alone: &Self) -> bool {
        let share = |scan: &Self| scan.rejected as f64 / scan.accepted as f64;
        share(self) <= MORE_REJECTED * share(alone) + SOME_REJECTED
    }
}

/// `count` angles spread evenly between two (rad).
fn angles((low, high): (f64, f64)) -> Vec<f64> {
    let starts = match std::env::var_os("BRICARD_LONG") {
        Some(_) => 200,
        None => 12,
    };
    let part = |i| (f64::from(i) + 0.37) / f64::from(starts);
    (0..starts).map(|i| low + (high - low) * part(i)).collect()
}

/// The end of a run from a state, and its rejected steps.
fn end<M, const N: usize, const R: usize>(
    mechanism: M,
    start: &State<f64, N>,
    options: &Options<f64>,
) -> (State<f64, N>, u64, u64)
where
    M: Mechanism<f64, N, R>,
{
    let framed = Framed::<M, N>::new(mechanism, &CONSERVATIVE);
    let summary = simulate::<N, R>(&framed, start, options, &mut [])
        .unwrap_or_else(|failure| panic!("from {}: {failure}", start.q));
    (summary.end, summary.rejected, summary.steps)
}

/// Runs from rest at all angles of a range: the mechanism, and its exact reduction
/// by the same method.
fn scan<P, const N: usize, const R: usize>(
    mechanism: P,
    range: (f64, f64),
    options: &Options<f64>,
) -> [Scan; 2]
where
    P: Passing<N, R> + Copy,
{
    let reduction = mechanism.reduction();
    let mut runs = [Vec::new(), Vec::new()];
    for start in angles(range) {
        let (angle, rate) = reduction.after(END, (start, 0.0));
        let state = mechanism.state(0.0, start, 0.0);
        let (found, rejected, steps) = end::<_, N, R>(mechanism, &state, options);
        let exact = mechanism.state(END, angle, rate);
        runs[0].push(((found.q - exact.q).amax(), rejected, steps));
        let state = State::new(0.0, [start].into(), [0.0].into());
        let (found, rejected, steps) = end::<_, 1, 0>(Reduced(reduction), &state, options);
        runs[1].push(((found.q[0] - angle).abs(), rejected, steps));
    }
    runs.map(Scan::new)
}

/// All tolerances and both adaptive methods.
fn check<P, const N: usize, const R: usize>(mechanism: P, range: (f64, f64))
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
            let [found, alone] = scan(mechanism, range, &options);
            let what = format!(
                "{} at {tolerance:e}: {}; without constraints {}",
                options.method, found, alone
            );
            println!("{what}");
            assert!(found.is_even(&alone), "{what}");
            assert!(found.rejects_no_more(&alone), "{what}");
        }
    }
}

impl Display for Scan {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(
            f,
            "median {:.1e}, worst {:.1e}, {} steps, {} rejected",
            self.median(),
            self.worst(),
            self.accepted,
            self.rejected
        )
    }
}

/// The range of starts around a nominal angle that others were measured in.
fn around(nominal: f64) -> (f64, f64) {
    (nominal - 0.05, nominal + 0.05)
}

#[test]
fn starts_of_the_slider_crank_are_alike() {
    check::<_, 3, 2>(SliderCrank::default(), around(45_f64.to_radians()));
}

#[test]
fn starts_of_the_driven_slider_crank_are_alike() {
    check::<_, 3, 2>(SliderCrank::DRIVEN, around(45_f64.to_radians()));
}

#[test]
fn starts_of_the_double_four_bar_are_alike() {
    check::<_, 5, 4>(FourBars, around(80_f64.to_radians()));
}
