//! What is tried: series of trials, made at random from a seed.
//!
//! In:  a seed, how many, tolerances.
//! Out: [`Trial`]s.

mod avoided;
mod backwards;
mod linkages;
mod parallelograms;
mod particles;
mod random_loops;

use crate::trial::{Trial, Wanted};
use bricard_testkit::Random;
use std::ops::Range;

/// A series of like trials.
#[derive(Clone, Copy, Debug)]
pub struct Series {
    /// Its name.
    pub name: &'static str,
    /// What its trials may come to.
    pub wanted: Wanted,
    /// How many are run every day.
    pub runs: usize,
    /// How many are run in the long form.
    pub long: usize,
    /// Their tolerances, one of which each trial takes at random.
    pub tolerances: &'static [f64],
    /// Makes the trial at a place of the series.
    pub make: fn(&mut Random, usize) -> Trial,
}

/// All tolerances that are usual.
const USUAL: &[f64] = &[1e-6, 1e-9, 1e-12];
/// For long runs.
const MIDDLE: &[f64] = &[1e-6, 1e-9];

/// All series.
pub const SERIES: &[Series] = &[
    series("pendulum_minute", 30, 1000, MIDDLE, parallelograms::minute),
    series("pendulum_named", 6, 6, &[], parallelograms::named),
    series("cart_minute", 30, 1000, MIDDLE, parallelograms::cart_minute),
    series("cart_short", 60, 1000, USUAL, parallelograms::cart_short),
    series("mast", 60, 1000, USUAL, parallelograms::mast),
    series("mast_minute", 10, 300, MIDDLE, parallelograms::mast_minute),
    series("rhombus", 60, 1000, USUAL, parallelograms::rhombus),
    series("turning", 60, 1000, USUAL, parallelograms::turning),
    series("slow", 60, 1000, USUAL, parallelograms::slow),
    series("rest_beside", 48, 480, USUAL, parallelograms::rest_beside),
    series("slider_rest", 48, 480, USUAL, linkages::slider_rest),
    ended("rest_on", 6, 6, USUAL, linkages::rest_on),
    series("curves_named", 15, 15, &[], particles::curves_named),
    series("curves", 100, 2000, USUAL, particles::curves),
    series("surfaces_named", 15, 15, &[], particles::surfaces_named),
    series("surfaces", 100, 2000, USUAL, particles::surfaces),
    series("grazing", 60, 1000, USUAL, particles::grazing),
    ended("near", 54, 54, &[], particles::near),
    ended("three_curves", 30, 300, USUAL, particles::three_curves),
    ended("three_surfaces", 30, 300, USUAL, particles::three_surfaces),
    ended("tacnode", 30, 300, USUAL, particles::tacnode),
    ended("cusp", 12, 120, USUAL, particles::cusp),
    series("cone", 30, 300, USUAL, particles::cone),
    series("instant", 12, 120, USUAL, particles::instant),
    series("four_bar", 30, 300, USUAL, linkages::four_bar),
    series("end_mass", 60, 1000, USUAL, linkages::end_mass),
    series("massless", 60, 1000, USUAL, linkages::massless),
    series("bennett", 60, 1000, USUAL, linkages::bennett),
    series("gaps", 72, 72, &[], linkages::gaps),
    series("hyperbola", 100, 3000, &[], avoided::hyperbola),
    series("hyperboloid", 100, 3000, &[], avoided::hyperboloid),
    series(
        "almost_parallelogram",
        100,
        3000,
        &[],
        avoided::almost_parallelogram,
    ),
    series(
        "unlike_hyperbola",
        100,
        3000,
        &[],
        avoided::unlike_hyperbola,
    ),
    series(
        "unlike_hyperboloid",
        100,
        3000,
        &[],
        avoided::unlike_hyperboloid,
    ),
    series(
        "unlike_almost_parallelogram",
        100,
        3000,
        &[],
        avoided::unlike_almost_parallelogram,
    ),
    series("gaps_wide", 42, 42, &[], linkages::gaps_wide),
    series("slider", 30, 300, USUAL, linkages::slider),
    series("driven", 60, 1000, USUAL, linkages::driven),
    series("driven_stops", 60, 600, USUAL, linkages::driven_stops),
    series("driven_to_stop", 60, 600, USUAL, linkages::driven_to_stop),
    series("turntable", 30, 300, USUAL, linkages::turntable),
    series("skated", 30, 300, USUAL, linkages::skated),
    series("splined", 20, 600, USUAL, linkages::splined),
    series("knife_edges", 30, 300, USUAL, linkages::knife_edges),
    series("products", 100, 5000, USUAL, random_loops::products),
    series("trees", 100, 5000, USUAL, random_loops::trees),
    series("duplicated", 30, 300, USUAL, linkages::duplicated),
];

/// A series whose trials have right answers.
const fn series(
    name: &'static str,
    runs: usize,
    long: usize,
    tolerances: &'static [f64],
    make: fn(&mut Random, usize) -> Trial,
) -> Series {
    Series {
        name,
        wanted: Wanted::Right,
        runs,
        long,
        tolerances,
        make,
    }
}

/// A series whose trials may as well end in an error.
const fn ended(
    name: &'static str,
    runs: usize,
    long: usize,
    tolerances: &'static [f64],
    make: fn(&mut Random, usize) -> Trial,
) -> Series {
    Series {
        wanted: Wanted::Ended,
        ..series(name, runs, long, tolerances, make)
    }
}

/// The series of a name.
pub fn find(name: &str) -> Option<&'static Series> {
    SERIES.iter().find(|series| series.name == name)
}

impl Series {
    /// Trials of a seed. Other tolerances than the usual ones may be given.
    pub fn trials(&self, seed: u64, runs: Range<usize>, tolerances: &[f64]) -> Vec<Trial> {
        let tolerances = if tolerances.is_empty() {
            self.tolerances
        } else {
            tolerances
        };
        let trial = |index| {
            let mut random = Random::of(seed, self.name, index);
            let mut trial = (self.make)(&mut random, index);
            if !tolerances.is_empty() {
                trial.tolerance = random.of_these(tolerances);
            }
            trial.made = (self.name, seed, index);
            trial
        };
        runs.map(trial).collect()
    }
}
