//! No series has a wrong run, and those that have right answers find them.

use crate::{SEED, is_long};
use bricard_singular::{SERIES, Score, Wanted, find, run_all};

/// The part of the runs that may end in an error where a right answer exists.
const LOST: f64 = 0.02;

fn holds(name: &str) {
    let series = find(name).expect("it is a series");
    let runs = if is_long() { series.long } else { series.runs };
    let ran = run_all(series.trials(SEED, 0..runs, &[]));
    let mut complaints = Vec::new();
    let mut ended = Vec::new();
    for ran in &ran {
        let complaint = format!(
            "{:?}: {}\n    {}",
            ran.verdict.score, ran.trial, ran.verdict.why
        );
        match ran.verdict.score {
            Score::Wrong => complaints.push(complaint),
            Score::Ended => ended.push(complaint),
            Score::Right => {}
        }
        if let Some((found, exact)) = ran.verdict.passages.filter(|_| ran.verdict.miscounted()) {
            complaints.push(format!("{}\n    {found} passages, not {exact}", ran.trial));
        }
    }
    if series.wanted == Wanted::Right && ended.len() as f64 > LOST * runs as f64 {
        complaints.extend(ended);
    }
    let count = complaints.len();
    assert!(
        complaints.is_empty(),
        "{name}: {count} of {runs}\n{}",
        complaints.join("\n")
    );
}

macro_rules! never_wrong {
    ($($name:ident)*) => {
        const NAMES: &[&str] = &[$(stringify!($name)),*];

        mod never_wrong {
            $(
                #[test]
                fn $name() {
                    super::holds(stringify!($name));
                }
            )*
        }
    };
}

never_wrong! {
    pendulum_minute pendulum_named cart_minute cart_short rhombus turning slow rest_beside
    slider_rest rest_on curves_named curves surfaces_named surfaces grazing near three_curves
    three_surfaces tacnode cusp cone instant four_bar gaps gaps_wide slider driven driven_stops
    knife_edges products trees duplicated
}

#[test]
fn every_series_is_claimed() {
    let names: Vec<&str> = SERIES.iter().map(|series| series.name).collect();
    assert_eq!(names, NAMES);
}
