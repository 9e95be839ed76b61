//! Sheets that a gap keeps from crossing, so small that the motion turns within it as if
//! round a corner.

use crate::trial::{Compare, Trial};
use bricard_runtime::Method;
use bricard_testkit::Random;

/// Gaps, relative to the size of the mechanism.
const GAPS: (f64, f64) = (1e-12, 1e-6);
/// Tolerances.
const TOLERANCES: (f64, f64) = (1e-12, 1e-4);
/// Steps of equal length in a run, and what its rows may be off by, as a tolerance.
const STEPS: (f64, f64) = (100.0, 3000.0);
const OF_FIXED: f64 = 1e-4;

/// Masses (kg).
const UNLIKE: (f64, f64) = (1e-3, 1e3);

/// A run at any tolerance, by any method, compared where velocities do not turn.
fn any(random: &mut Random, trial: Trial, reduced: &'static str) -> Trial {
    use Method::{Dop853, Dp5, Radau9, Rk4};
    let method = random.of_these(&[Dop853, Dop853, Radau9, Dp5, Rk4]);
    let step = trial.until / random.decade(STEPS.0, STEPS.1);
    let tolerance = random.decade(TOLERANCES.0, TOLERANCES.1);
    let fixed = method == Rk4;
    Trial {
        compare: Compare::Turning(reduced),
        method,
        step: fixed.then_some(step),
        tolerance: if fixed { OF_FIXED } else { tolerance },
        ..trial
    }
}

/// A run with masses that are often very unlike a kilogram. What is light is whipped by what is
/// heavy, which neither steps of equal length nor loose tolerances follow.
fn unlike(random: &mut Random, trial: Trial, masses: &[&'static str]) -> Trial {
    let method = random.of_these(&[Method::Dop853, Method::Radau9]);
    let tolerance = random.decade(TOLERANCES.0, 1e-7);
    let mut set = trial.set.clone();
    for mass in masses {
        if random.of_these(&[true, false]) {
            set.push((mass, random.decade(UNLIKE.0, UNLIKE.1)));
        }
    }
    Trial {
        set,
        method,
        step: None,
        tolerance,
        // Later on the gap would be round-off of what has grown.
        until: trial.until.min(6.0),
        ..trial
    }
}

/// How far away a motion towards a corner of such a size begins, and how fast.
fn approach(random: &mut Random, corner: f64) -> (f64, f64) {
    let far = random.decade(corner.max(1e-4), 1.0);
    let fast = random.decade(0.01, 10.0);
    (far, fast)
}

/// A time in which it goes some times as far, with an acceleration or without.
fn span(random: &mut Random, (far, fast): (f64, f64), pull: f64) -> f64 {
    let last = (fast * fast + 2.0 * pull * far).sqrt();
    2.0 * far / (fast + last) * random.between(1.5, 3.0)
}

/// A motion towards the gap between two curves or surfaces.
struct Towards {
    /// The gap, the slopes and curvature on both sides of it, accelerations.
    set: Vec<(&'static str, f64)>,
    far: f64,
    fast: f64,
    way: f64,
    pull: f64,
}

impl Towards {
    /// `down` is what the acceleration across the way is called.
    fn new(random: &mut Random, down: &'static str) -> Self {
        let gap = random.signed_decade(GAPS.0, GAPS.1);
        let (f1, h1) = (random.between(0.1, 1.0), -random.between(0.1, 1.0));
        let (far, fast) = approach(random, 20.0 * gap.abs().sqrt() / (f1 - h1));
        let way = random.sign();
        let (gx, g) = (random.of_these(&[0.0, 3.0]), random.of_these(&[0.0, 9.81]));
        let c2 = random.of_these(&[0.0, 0.5, -0.7]);
        let set = [
            ("gap", gap),
            ("f1", f1),
            ("h1", h1),
            ("c2", c2),
            ("gx", gx),
            (down, g),
        ];
        Self {
            set: set.to_vec(),
            far,
            fast,
            way,
            pull: gx + g,
        }
    }

    fn trial(
        self,
        random: &mut Random,
        (name, reduced): (&'static str, &'static str),
        more: &[(&'static str, f64)],
    ) -> Trial {
        let until = span(random, (self.far, self.fast), self.pull);
        let set = [&self.set, more].concat();
        any(
            random,
            Trial::short(name, reduced, set).until(until),
            reduced,
        )
    }
}

/// Two curves.
pub fn hyperbola(random: &mut Random, _: usize) -> Trial {
    let towards = Towards::new(random, "gy");
    let more = [
        ("sc", random.of_these(&[1.0, 1e-6, 1e4])),
        ("x0", -towards.way * towards.far),
        ("v0", towards.way * towards.fast),
    ];
    towards.trial(random, ("hyperbola", "hyperbola_reduced"), &more)
}

/// Two curves, of a particle with an inertia along each coordinate.
pub fn unlike_hyperbola(random: &mut Random, index: usize) -> Trial {
    let trial = hyperbola(random, index);
    unlike(random, trial, &["mx", "my"])
}

/// Two surfaces.
pub fn hyperboloid(random: &mut Random, _: usize) -> Trial {
    let towards = Towards::new(random, "gz");
    let more = [
        ("cxy", random.within(0.4)),
        ("cyy", random.within(0.4)),
        ("x0", -towards.way * towards.far),
        ("vx0", towards.way * towards.fast),
        ("vy0", random.within(2.0)),
    ];
    towards.trial(random, ("hyperboloid", "hyperboloid_reduced"), &more)
}

/// Two surfaces, of a particle with an inertia along each coordinate.
pub fn unlike_hyperboloid(random: &mut Random, index: usize) -> Trial {
    let trial = hyperboloid(random, index);
    unlike(random, trial, &["mx", "my", "mz"])
}

/// A linkage with a pendulum on it.
pub fn almost_parallelogram(random: &mut Random, _: usize) -> Trial {
    let gap = random.signed_decade(GAPS.0, GAPS.1);
    let (far, fast) = approach(random, 20.0 * gap.abs().sqrt());
    let way = random.sign();
    let set = vec![
        ("gap", gap),
        ("g", random.of_these(&[0.0, 9.81])),
        ("a0", -way * far),
        ("w0", way * fast),
        ("b0", random.within(1.0)),
        ("wb0", random.within(3.0)),
    ];
    // Longer runs would leave what the reduction describes.
    let until = (far / fast * random.between(1.3, 1.8)).min(0.15);
    let reduced = "almost_parallelogram_reduced";
    let trial = Trial::short("almost_parallelogram", reduced, set).until(until);
    any(random, trial, reduced)
}

/// The linkage with links of unlike masses.
pub fn unlike_almost_parallelogram(random: &mut Random, index: usize) -> Trial {
    let trial = almost_parallelogram(random, index);
    let mut trial = unlike(random, trial, &["m", "mc"]);
    // A bob that is heavier would whip the linkage to where the reduction ends.
    let links = trial
        .set
        .iter()
        .filter(|(name, _)| ["m", "mc"].contains(name));
    let lightest = links.fold(1.0, |least: f64, (_, mass)| least.min(*mass));
    trial.set.push(("mp", lightest / 2.0));
    trial
}
