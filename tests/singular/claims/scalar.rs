//! Single and extended precision pass singular positions too.

use crate::{SEED, is_long};
use bricard_reference::DoubleDouble;
use bricard_runtime::{Interface, Mechanism, Options, Summary, Whole, assemble, simulate};
use bricard_singular::descriptions::{
    curves, equal_slider_crank, equal_slider_crank_reduced, four_bar, parallelogram_pendulum,
};
use bricard_singular::{Set, exact};
use bricard_testkit::Random;

/// Relative and absolute tolerance.
const TOLERANCE: f32 = 1e-4;
/// What the end may be off by, relative to the coordinate: a few hundred tolerances.
const BOUND: f64 = 3e-2;
const UNTIL: f64 = 1.0;

/// The end of a run in single precision, or its error.
fn end<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f32, N, R>,
) -> Result<Vec<f64>, String> {
    let start = assemble(mechanism, &mechanism.start(), 0.0).map_err(|error| error.to_string())?;
    let options = Options::dop853(UNTIL as f32, TOLERANCE);
    let ran = simulate(mechanism, &start, &options, &mut []);
    let end = ran.map_err(|failure| failure.error.to_string())?.end;
    Ok(end
        .q
        .iter()
        .chain(end.v.iter())
        .map(|x| f64::from(*x))
        .collect())
}

fn set<M, const N: usize, const R: usize>(mechanism: &mut M, set: &Set)
where
    M: Mechanism<f32, N, R> + Interface<f32, N>,
{
    let parameters = mechanism.structure().parameters;
    for (name, value) in set {
        let place = parameters.iter().position(|p| p.name == *name);
        mechanism.set_parameter(place.expect("it is a parameter"), *value as f32);
    }
}

/// Runs random starts in single precision: none is wrong, few end in an error.
fn passes(
    (name, reduced, n): (&str, &str, usize),
    start: fn(&mut Random) -> Set,
    run: fn(&Set) -> Result<Vec<f64>, String>,
) {
    let runs = if is_long() { 1000 } else { 60 };
    let mut ended = Vec::new();
    for index in 0..runs {
        // Rounded first, so that both begin at the same place.
        let set: Set = start(&mut Random::of(SEED, name, index));
        let set: Set = set
            .into_iter()
            .map(|(name, x)| (name, f64::from(x as f32)))
            .collect();
        match run(&set) {
            Ok(found) => {
                let wanted = exact(name, reduced, &set, n, &[UNTIL]).numbers;
                for (a, b) in found.iter().zip(&wanted) {
                    let off = (a - b).abs() / (1.0 + b.abs());
                    assert!(off <= BOUND, "{name} {set:?}: {found:?}, not {wanted:?}");
                }
            }
            Err(error) => ended.push(format!("{set:?}: {error}")),
        }
    }
    // Near the set seven digits often do not tell the curves apart, which is said.
    assert!(
        ended.len() * 6 <= runs,
        "{name}: {} of {runs}\n{}",
        ended.len(),
        ended.join("\n")
    );
}

#[test]
fn a_parallelogram_with_a_pendulum_passes_in_single_precision() {
    let start = |random: &mut Random| {
        vec![
            ("a0", random.within(1.4)),
            ("b0", random.within(1.0)),
            ("wb0", random.within(3.0)),
        ]
    };
    let run = |values: &Set| {
        let mut mechanism = parallelogram_pendulum::ParallelogramPendulum::<f32>::default();
        set(&mut mechanism, values);
        end::<4, 2>(&mechanism)
    };
    let names = (
        "parallelogram_pendulum",
        "parallelogram_pendulum_reduced",
        4,
    );
    passes(names, start, run);
}

#[test]
fn two_curves_are_passed_in_single_precision() {
    let start = |random: &mut Random| {
        vec![
            ("f1", random.between(0.2, 1.0)),
            ("h1", random.between(-1.0, -0.2)),
            ("f2", random.within(0.5)),
            ("h2", random.within(0.5)),
            ("v0", random.between(1.0, 6.0)),
        ]
    };
    let run = |values: &Set| {
        let mut mechanism = curves::Curves::<f32>::default();
        set(&mut mechanism, values);
        end::<2, 1>(&mechanism)
    };
    passes(("curves", "curve_reduced", 2), start, run);
}

fn a_slider_crank_passes(start: fn(&mut Random) -> Set) {
    let run = |values: &Set| {
        let mut mechanism = equal_slider_crank::EqualSliderCrank::<f32>::default();
        set(&mut mechanism, values);
        end::<2, 1>(&mechanism)
    };
    passes(
        ("equal_slider_crank", "equal_slider_crank_reduced", 2),
        start,
        run,
    );
}

#[test]
fn a_slider_crank_passes_in_single_precision() {
    a_slider_crank_passes(|random| vec![("p0", random.within(1.4)), ("w0", random.within(8.0))]);
}

#[test]
fn a_slider_crank_passes_in_single_precision_after_many_turns() {
    a_slider_crank_passes(|random| vec![("p0", random.within(300.0)), ("w0", random.within(8.0))]);
}

/// What the end may be off by that of the same run in double precision, in units of the
/// round-off of single precision, relative to the coordinate.
const ROUND_OFFS: f64 = 1000.0;

/// Runs through several singular positions in both precisions.
fn agree<const N: usize, const R: usize>(
    single: &dyn Whole<f32, N, R>,
    double: &dyn Whole<f64, N, R>,
    until: f32,
) {
    let start = assemble(single, &single.start(), 0.0).expect("it can be assembled");
    let options = Options::dop853(until, 2e-6);
    let found = simulate(single, &start, &options, &mut []).unwrap_or_else(|why| panic!("{why}"));
    let start = assemble(double, &double.start(), 0.0).expect("it can be assembled");
    let options = Options::dop853(f64::from(until), 1e-11);
    let wanted = simulate(double, &start, &options, &mut []).unwrap_or_else(|why| panic!("{why}"));
    let several = wanted.passages.is_some_and(|passages| passages >= 4);
    assert!(several, "{:?} passages", wanted.passages);
    assert_eq!(found.passages, wanted.passages);
    let numbers = found.end.q.iter().chain(found.end.v.iter());
    for (a, b) in numbers.zip(wanted.end.q.iter().chain(wanted.end.v.iter())) {
        let off = (f64::from(*a) - b).abs() / (1.0 + b.abs());
        let off = off / f64::from(f32::EPSILON);
        assert!(off <= ROUND_OFFS, "{a} is off {b} by {off} round-offs");
    }
}

#[test]
fn several_passages_of_a_slider_crank_keep_the_digits_of_single_precision() {
    let (mut single, mut double) = (
        equal_slider_crank::EqualSliderCrank::<f32>::default(),
        equal_slider_crank::EqualSliderCrank::<f64>::default(),
    );
    (single.parameters.w0, double.parameters.w0) = (9.0, 9.0);
    agree::<2, 1>(&single, &double, 3.0);
}

#[test]
fn several_passages_of_a_four_bar_linkage_keep_the_digits_of_single_precision() {
    let single = four_bar::FourBar::<f32>::default();
    agree::<3, 2>(&single, &four_bar::FourBar::<f64>::default(), 2.0);
}

/// Tolerance in 106 bits: far beyond what 53 bits resolve.
const EXTENDED: f64 = 1e-22;

/// A run in 106 bits.
fn extended<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
) -> Summary<DoubleDouble, N> {
    let zero = DoubleDouble::from(0.0);
    let start = assemble(mechanism, &mechanism.start(), zero).expect("it can be assembled");
    let options = Options::dop853(DoubleDouble::from(1.5), DoubleDouble::from(EXTENDED));
    simulate(mechanism, &start, &options, &mut []).unwrap_or_else(|why| panic!("{why}"))
}

#[test]
fn passages_keep_digits_beyond_those_of_double_precision() {
    let mut whole = equal_slider_crank::EqualSliderCrank::<DoubleDouble>::default();
    let mut reduced = equal_slider_crank_reduced::EqualSliderCrankReduced::default();
    let speed = DoubleDouble::from(9.0);
    (whole.parameters.w0, reduced.parameters.w0) = (speed, speed);
    let (found, wanted) = (extended::<2, 1>(&whole), extended::<1, 0>(&reduced));
    let several = found.passages.is_some_and(|passages| passages >= 4);
    assert!(several, "{:?} passages", found.passages);
    for (a, b) in [
        (found.end.q[0], wanted.end.q[0]),
        (found.end.v[0], wanted.end.v[0]),
    ] {
        let off = (a - b).high().abs();
        assert!(off <= 100.0 * EXTENDED, "{a} is off {b} by {off:e}");
    }
}
