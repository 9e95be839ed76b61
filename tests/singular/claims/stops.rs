//! Laws of time that turn back beside a dead centre, and in it: states there need not lose
//! more digits than round-off takes.

use bricard_singular::{Score, find, run_all};

/// Between nodes that are nearly singular themselves an interpolation has fewer digits than
/// the equations at the state, or a velocity that is not the sheet's.
#[test]
fn states_between_poor_nodes_are_as_good_as_without_any() {
    let series = find("driven_stops").expect("it is a series");
    let places = [(77, 334), (77, 825), (77, 1094), (902, 51)];
    let trial = |(seed, place)| series.trials(seed, place..place + 1, &[]);
    for ran in run_all(places.into_iter().flat_map(trial).collect()) {
        let why = &ran.verdict.why;
        assert_eq!(ran.verdict.score, Score::Right, "{}\n    {why}", ran.trial);
    }
}
