//! Trials of planted mechanisms: from sizes that are known at run time to those that are
//! known when they are compiled.
//!
//! In:  a [`Trial`] with a planting.
//! Out: its track, its exact motion.

use crate::agree::put;
use crate::exact::{Exact, follow};
use crate::planted::{Planted, Reduced, Scene, trial_structure};
use crate::track::{Track, play};
use bricard_runtime::Options;
use bricard_testkit::Random;
use std::sync::Arc;

/// A planted mechanism and where it begins.
#[derive(Clone, Debug)]
pub struct Planting {
    scene: Arc<Scene>,
    start: ([f64; 8], [f64; 8]),
}

macro_rules! for_sizes {
    ($sizes:expr, $run:ident, $arguments:tt, [$(($n:literal, $r:literal)),*]) => {
        match $sizes {
            $(($n, $r) => $run::<$n, $r> $arguments,)*
            sizes => panic!("no scene has the sizes {sizes:?}"),
        }
    };
    ($sizes:expr, $run:ident, $arguments:tt, whole) => {
        for_sizes!(
            $sizes,
            $run,
            $arguments,
            [
                (2, 1),
                (3, 1),
                (4, 1),
                (5, 1),
                (3, 2),
                (4, 2),
                (5, 2),
                (6, 2),
                (6, 4),
                (7, 4)
            ]
        )
    };
}

impl Planting {
    /// A product or a tree with a random start.
    pub fn new(random: &mut Random, tree: bool) -> Self {
        let scene = match tree {
            true => Scene::tree(random),
            false => Scene::product(random),
        };
        let start = scene.start(random);
        let scene = Arc::new(scene);
        Self { scene, start }
    }

    /// Runs it with its constraints.
    pub fn run(&self, options: &Options<f64>) -> Track {
        let (n, _, rows) = self.scene.sizes();
        for_sizes!((n, rows), constrained, (self, options), whole)
    }

    /// What a motion is off by, put into its equations.
    pub fn off(&self, times: &[f64], numbers: &[f64]) -> f64 {
        let (n, _, rows) = self.scene.sizes();
        let arguments = (self, times, numbers);
        for_sizes!((n, rows), contradicts, (arguments), whole)
    }

    /// Runs it in independent coordinates.
    pub fn exact(&self, times: &[f64]) -> Exact {
        let (n, freedoms, _) = self.scene.sizes();
        let arguments = (self, 2 * n, times);
        for_sizes!(
            (freedoms, 0),
            reduced,
            (arguments),
            [(1, 0), (2, 0), (3, 0), (4, 0)]
        )
    }
}

fn whole<const N: usize, const R: usize>(planting: &Planting) -> Planted<N, R> {
    Planted {
        scene: planting.scene.clone(),
        start: planting.start,
        structure: trial_structure(N, R, planting.scene.conservative()),
    }
}

fn contradicts<const N: usize, const R: usize>(
    (planting, times, numbers): (&Planting, &[f64], &[f64]),
) -> f64 {
    put::<N, R>(&whole::<N, R>(planting), times, numbers)
}

fn constrained<const N: usize, const R: usize>(
    planting: &Planting,
    options: &Options<f64>,
) -> Track {
    let mechanism = whole::<N, R>(planting);
    play::<N, R>(&mechanism, options, true)
}

fn reduced<const N: usize, const R: usize>(
    (planting, width, times): (&Planting, usize, &[f64]),
) -> Exact {
    let mechanism = Reduced::<N> {
        scene: planting.scene.clone(),
        start: planting.start,
        structure: trial_structure(N, 0, false),
    };
    follow::<N, 0>(&mechanism, width, times)
}
