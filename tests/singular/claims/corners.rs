//! Corners that were cut: a motion ran on straight across a gap as if two sheets crossed
//! there, or gained energy, and nobody was told.

use bricard_runtime::Method;
use bricard_singular::{Compare, Score, Set, Trial, find, judge, run_all};

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

#[test]
fn corners_in_which_a_step_loses_energy_are_not_cut() {
    are_not_cut("hyperbola", &[2813]);
    are_not_cut("hyperboloid", &[1644, 5027]);
    are_not_cut("almost_parallelogram", &[8311]);
}

#[test]
fn corners_are_not_cut_where_masses_are_unlike() {
    are_not_cut("unlike_hyperboloid", &[946, 4946]);
}

/// A run between two surfaces, of a particle with these inertias along x, y and z.
fn between_surfaces(masses: [f64; 3], set: Set, (tolerance, until): (f64, f64), method: Method) {
    let masses = ["mx", "my", "mz"].into_iter().zip(masses);
    let reduced = "hyperboloid_reduced";
    let trial = Trial {
        compare: Compare::Turning(reduced),
        tolerance,
        method,
        ..Trial::short("hyperboloid", reduced, masses.chain(set).collect()).until(until)
    };
    let verdict = judge(&trial);
    assert_ne!(verdict.score, Score::Wrong, "{trial}\n    {}", verdict.why);
    assert!(!verdict.miscounted(), "{trial}: {:?}", verdict.passages);
}

#[test]
fn a_gap_is_none_of_the_round_off_of_coordinates_that_are_heavier() {
    let set = vec![
        ("gap", 1.5681475192688344e-12),
        ("f1", 0.7669302829043371),
        ("h1", -0.5751217073409656),
        ("gx", 3.0),
        ("gz", 9.81),
        ("cxy", 0.3139671401633075),
        ("cyy", 0.11039830368022796),
        ("x0", -0.9686141339952963),
        ("vx0", 7.699474630155335),
        ("vy0", -0.35538275280355114),
    ];
    let run = (4.1815337811544073e-10, 0.17617445385209565);
    between_surfaces([1.0, 1.0, 9.527602755124035e-6], set, run, Method::Dop853);
}

#[test]
fn velocities_that_are_held_stay_where_what_is_free_is_far_heavier() {
    let set = vec![
        ("gap", 1.3631118434642374e-9),
        ("f1", 0.8664170432823813),
        ("h1", -0.4280451930980842),
        ("gz", 0.0),
        ("cxy", -0.3033374433329208),
        ("cyy", 0.07544792363766134),
        ("x0", 0.0006786711424655136),
        ("vx0", -0.010067310868475779),
        ("vy0", -0.8384551596346843),
    ];
    let masses = [1.0064689796430177e-6, 460232.9346589039, 2566.926376737031];
    let run = (3.7320276996254775e-12, 0.10728911328134706);
    between_surfaces(masses, set, run, Method::Dp5);
}
