//! Laws of time that turn back beside a dead centre, and in it: states there need not lose
//! more digits than round-off takes.

use bricard_singular::{Score, find, run_all};

fn right(places: &[(u64, usize)]) {
    let series = find("driven_stops").expect("it is a series");
    let trial = |(seed, place): &(u64, usize)| series.trials(*seed, *place..place + 1, &[]);
    for ran in run_all(places.iter().flat_map(trial).collect()) {
        let why = &ran.verdict.why;
        assert_eq!(ran.verdict.score, Score::Right, "{}\n    {why}", ran.trial);
    }
}

/// Between nodes that are nearly singular themselves an interpolation has fewer digits than
/// the equations at the state, or a velocity that is not the sheet's.
#[test]
fn states_between_poor_nodes_are_as_good_as_without_any() {
    right(&[(77, 334), (77, 825), (77, 1094), (902, 51)]);
}

/// Where the sine hardly changes, nodes of a spacing that is kept as a change of the sine move
/// together, until round-off is all that lies between them.
#[test]
fn nodes_do_not_move_together_where_the_law_of_time_stops() {
    right(&[(7, 22), (101, 272), (104, 198), (104, 498)]);
}

/// A law that stops a little beyond a dead centre crosses it twice; what it does at an instant
/// between does not say where.
#[test]
fn a_law_of_time_that_turns_between_two_crossings_is_followed() {
    right(&[(1, 71), (1, 91), (1, 103)]);
}
