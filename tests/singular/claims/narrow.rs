//! Sheets that cross at a small angle: Newton's iteration leads from one to the other without
//! a sign of trouble, and what is interpolated there is smooth.

use bricard_singular::{Score, Trial, Verdict, find, run_all};

fn verdict(series: &str, seed: u64, place: usize) -> Verdict {
    let series = find(series).expect("it is a series");
    let mut ran = run_all(series.trials(seed, place..place + 1, &[]));
    ran.remove(0).verdict
}

/// The signs of the constraints are opposite on the two sheets. Nodes on the other one are
/// given up for narrower ones.
#[test]
fn nodes_are_on_the_sheet_of_the_state() {
    for (seed, place) in [(102, 34), (101, 97)] {
        let Verdict { score, why, .. } = verdict("products", seed, place);
        assert_eq!(score, Score::Right, "{seed}, {place}: {why}");
    }
}

/// Where the sheet has turned away from its tangent space at the start of the step by more than
/// the angle to the other one, a row that would be put onto that is refused.
#[test]
fn no_row_is_put_onto_another_sheet() {
    let Verdict { score, why, .. } = verdict("products", 104, 480);
    assert_ne!(score, Score::Wrong, "{why}");
}

/// Two crossings so near to each other that nodes lie on both sides of both: where the critical
/// configuration is not found for certain, neither a gap nor a crossing is concluded.
#[test]
fn what_is_not_certain_in_the_critical_configuration_decides_nothing() {
    for (series, seed, place) in [("curves", 403, 555), ("surfaces", 403, 317)] {
        let Verdict { score, why, .. } = verdict(series, seed, place);
        assert_ne!(score, Score::Wrong, "{series}, {seed}, {place}: {why}");
    }
}

/// On one sheet, but moving along the other, which is nearer than what a step may be off by:
/// neither of them is taken.
#[test]
fn a_start_on_one_sheet_does_not_move_along_another() {
    let Verdict { score, why, .. } = verdict("grazing", 404, 590);
    assert_ne!(score, Score::Wrong, "{why}");
}

/// A loop beside the crossing, which passes it with a gap, turns so fast there that what is
/// interpolated violates its constraints. That is no gap in the crossing.
#[test]
fn a_gap_beside_a_crossing_is_not_taken_for_one_in_it() {
    let trial = |(place, r): (usize, f64)| {
        let (mechanism, reduced) = ("gap_beside_crossing", "gap_beside_crossing_reduced");
        let set = vec![("r", r), ("w0", 4.0 + (place % 7) as f64)];
        let trial = Trial::short(mechanism, reduced, set).until(2.0);
        let tolerance = [1e-8, 1e-9, 1e-11][place % 3];
        Trial { tolerance, ..trial }
    };
    let gaps = (0..48).map(|place| 0.302 + 0.0003 * place as f64);
    for ran in run_all(gaps.enumerate().map(trial).collect()) {
        let (trial, verdict) = (&ran.trial, &ran.verdict);
        assert_eq!(verdict.score, Score::Right, "{trial}\n    {}", verdict.why);
        assert!(!verdict.miscounted(), "{trial}: {:?}", verdict.passages);
    }
}
