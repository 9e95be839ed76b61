//! Stage placement: what the passage through a singular configuration costs in accuracy.
//!
//! In:  the error of a run for each placement.
//! Out: [`Placements`]: the median, the worst, and whether that is as good as the others.
//!
//! A run begins on the exact motion so that a stage of its first step lies at a distance
//! from the singular position, and is followed for [`SPAN`].
//!
//! Not here: exact motions, and runs.

/// How long a motion is followed (s).
pub const SPAN: f64 = 0.4;

/// Steps in that time.
pub const STEPS: [u32; 4] = [20, 40, 80, 160];

/// How much worse than the median the worst placement may be.
pub const SPREAD: f64 = 2.0;

/// A median that is round-off, and what no placement may exceed then.
const FLOOR: f64 = 1e-12;
const PLACED: f64 = 1e-11;

/// Where stages are placed, `±{1, 3.3}·10⁻ᵏ` from the singular position, `k = 1…16`.
pub fn distances() -> Vec<f64> {
    multiples(1..=16, &[1.0, -1.0, 3.3, -3.3])
}

/// Some of the same, for every day: before the singular position and behind it in turn.
pub fn some_distances() -> Vec<f64> {
    let before = multiples([1, 3, 6, 16], &[1.0]);
    before
        .into_iter()
        .chain(multiples([2, 4, 9], &[-3.3]))
        .collect()
}

fn multiples(exponents: impl IntoIterator<Item = i32>, sizes: &[f64]) -> Vec<f64> {
    let scaled = |k: i32| sizes.iter().map(move |size| size * 10.0_f64.powi(-k));
    exponents.into_iter().flat_map(scaled).collect()
}

/// The abscissae of the stages of a method, each once, and that of the start of the step.
pub fn stages(abscissae: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut stages: Vec<f64> = std::iter::once(0.0).chain(abscissae).collect();
    stages.dedup();
    stages
}

/// The errors of all placements of a method and a step, and what tells them apart.
#[derive(Clone, Debug)]
pub struct Placements<L> {
    /// The smallest first.
    errors: Vec<(f64, L)>,
}

impl<L: Copy> Placements<L> {
    /// The placements of some errors; `None` if there are none.
    pub fn of(mut errors: Vec<(f64, L)>) -> Option<Self> {
        errors.sort_by(|a, b| a.0.total_cmp(&b.0));
        (!errors.is_empty()).then_some(Self { errors })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.errors.len()
    }

    /// The error in the middle.
    pub fn median(&self) -> f64 {
        self.errors[self.errors.len() / 2].0
    }

    /// The largest error, and where it was made.
    pub fn worst(&self) -> (f64, L) {
        self.errors[self.errors.len() - 1]
    }

    /// The largest error of some placements, zero if there is none.
    pub fn worst_of(&self, these: impl Fn(L) -> bool) -> f64 {
        let found = self.errors.iter().rev().find(|(_, label)| these(*label));
        found.map_or(0.0, |(error, _)| *error)
    }

    /// What no placement may exceed if `usual` is what a run errs by; where the median is
    /// round-off, a little more of it.
    pub fn bound(&self, usual: f64) -> f64 {
        let floor = if self.median() <= FLOOR { PLACED } else { 0.0 };
        floor.max(SPREAD * usual)
    }

    /// Whether no placement is much worse than the median.
    pub fn is_even(&self) -> bool {
        self.worst().0 <= self.bound(self.median())
    }
}

/// What contradicts that a method has an order with every placement: uneven placements at one
/// of [`STEPS`], or medians that fall too slowly from one to the next.
pub fn complaints<L: Copy + std::fmt::Debug>(
    order: f64,
    placements: impl Fn(u32) -> Placements<L>,
) -> Vec<String> {
    let mut complaints = Vec::new();
    let mut before: Option<f64> = None;
    for steps in STEPS {
        let found = placements(steps);
        let (median, (worst, place)) = (found.median(), found.worst());
        if !found.is_even() {
            complaints.push(format!(
                "{steps} steps: median {median:.1e}, worst {worst:.1e} at {place:?}"
            ));
        }
        let shown = before.map_or(f64::INFINITY, |before| (before / median).log2());
        if shown < order {
            complaints.push(format!("{steps} steps: order {shown:.2}, not {order}"));
        }
        before = Some(median);
    }
    complaints
}

#[cfg(test)]
mod tests {
    use super::{Placements, complaints, distances, some_distances, stages};

    fn errors(errors: &[f64]) -> Placements<usize> {
        let labelled = errors.iter().enumerate().map(|(i, error)| (*error, i));
        Placements::of(labelled.collect()).expect("some errors")
    }

    #[test]
    fn one_placement_worse_than_twice_the_median_is_uneven_but_for_round_off() {
        assert!(errors(&[1e-6, 2e-6, 1e-6]).is_even());
        assert!(!errors(&[1e-6, 1e-6, 2.1e-6]).is_even());
        assert!(errors(&[1e-13, 1e-13, 9e-12]).is_even());
        assert!(!errors(&[1e-13, 1e-13, 1.1e-11]).is_even());
        assert_eq!(errors(&[1e-6, 3e-6, 2e-6]).worst(), (3e-6, 1));
        assert_eq!(errors(&[1e-6, 3e-6, 2e-6]).worst_of(|i| i != 1), 2e-6);
        assert!(Placements::<usize>::of(Vec::new()).is_none());
    }

    #[test]
    fn a_method_of_order_three_is_not_taken_for_one_of_order_four() {
        let of = |order: i32| complaints(3.7, |steps| errors(&[f64::from(steps).powi(-order)]));
        assert!(of(4).is_empty());
        assert_eq!(of(3).len(), 3, "{:?}", of(3));
    }

    #[test]
    fn stages_are_placed_on_both_sides_from_a_tenth_to_round_off() {
        let all = distances();
        assert_eq!((all.len(), all[0], all[63]), (64, 0.1, -3.3e-16));
        assert!(some_distances().iter().all(|d| all.contains(d)));
        assert_eq!(stages([0.5, 0.5, 1.0].into_iter()), [0.0, 0.5, 1.0]);
        assert_eq!(stages([0.0, 0.5].into_iter()), [0.0, 0.5]);
    }
}
