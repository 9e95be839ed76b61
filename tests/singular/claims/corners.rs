//! Corners that were cut: a motion ran on straight across a gap as if two sheets crossed
//! there, or gained energy, and nobody was told.

use bricard_singular::{Score, find, run_all};

/// The seed of the search that found them.
const SEED: u64 = 2;

fn are_not_cut(name: &str, places: &[usize]) {
    let series = find(name).expect("it is a series");
    let trial = |place: &usize| series.trials(SEED, *place..place + 1, &[]);
    for ran in run_all(places.iter().flat_map(trial).collect()) {
        let wrong = ran.verdict.score == Score::Wrong;
        assert!(!wrong, "{}\n    {}", ran.trial, ran.verdict.why);
    }
}

#[test]
fn corners_within_the_first_step_are_not_cut() {
    are_not_cut("hyperbola", &[5988, 11674, 14930, 16936]);
    are_not_cut("hyperboloid", &[1453, 9059, 15431]);
}

#[test]
fn corners_are_not_cut_where_a_start_is_level_in_one_coordinate() {
    are_not_cut("hyperbola", &[14640]);
    are_not_cut("hyperboloid", &[8623, 17790]);
}

#[test]
fn corners_are_not_cut_by_steps_of_equal_length() {
    are_not_cut("hyperbola", &[5433, 12163]);
    are_not_cut("hyperboloid", &[5803, 7934, 8063]);
    are_not_cut("almost_parallelogram", &[669, 10201]);
}
