//! Sheets that cross at a small angle: Newton's iteration leads from one to the other without
//! a sign of trouble, and what is interpolated there is smooth.

use bricard_singular::{Score, Verdict, find, run_all};

fn product(seed: u64, place: usize) -> Verdict {
    let series = find("products").expect("it is a series");
    let mut ran = run_all(series.trials(seed, place..place + 1, &[]));
    ran.remove(0).verdict
}

/// The signs of the constraints are opposite on the two sheets. Nodes on the other one are
/// given up for narrower ones.
#[test]
fn nodes_are_on_the_sheet_of_the_state() {
    for (seed, place) in [(102, 34), (101, 97)] {
        let Verdict { score, why, .. } = product(seed, place);
        assert_eq!(score, Score::Right, "{seed}, {place}: {why}");
    }
}

/// Where the sheet has turned away from its tangent space at the start of the step by more than
/// the angle to the other one, a row that would be put onto that is refused.
#[test]
fn no_row_is_put_onto_another_sheet() {
    let Verdict { score, why, .. } = product(104, 480);
    assert_ne!(score, Score::Wrong, "{why}");
}
