//! Checkpoints are read as they were written, or not at all.

use super::{Checkpoint, Rows};
use crate::mechanism::find;
use crate::run::Report;
use bricard_runtime::{Counters, Origin, Passage, Structure};
use std::time::Duration;

const RUN: &str = "a run";

fn structure() -> &'static Structure {
    find("slider_crank")
        .expect("it is in the library")
        .structure()
}

fn checkpoint() -> Checkpoint {
    Checkpoint {
        origin: Origin {
            t: 0.0,
            energy: -1.5e-3,
            supplied: 0.1,
        },
        state: vec![0.3, 1.0, 2.0, -0.0, 1e-300, 5.0, 0.1 + 0.2],
        rows: Rows {
            count: 31,
            bytes: Some(2400),
        },
        report: Report {
            steps: 1000,
            rejected: 3,
            wall: Duration::from_millis(125),
            constraint_error: 1e-16,
            energy_error: f64::NAN,
            energy_exchanged: 2.5,
            passages: vec![Passage {
                t: 0.2,
                sine: 1e-9,
                rank: 1,
                regular: 2,
            }],
            events: Vec::new(),
            counters: Counters::default(),
        },
    }
}

#[test]
fn a_checkpoint_is_read_as_it_was_written() {
    let text = checkpoint().text(RUN);
    let read = Checkpoint::read(&text, RUN, structure()).expect("it is whole");
    // NaN is no number that could be compared, but its bits are kept.
    assert_eq!(read.text(RUN), text);
    assert_eq!(read.state, checkpoint().state);
}

#[test]
fn no_changed_or_missing_byte_goes_unnoticed() {
    let text = checkpoint().text(RUN);
    for (place, old) in text.char_indices() {
        for new in ["", "0", "7", ",", "\"", "e"] {
            let changed = [&text[..place], new, &text[place + old.len_utf8()..]].concat();
            // Space between the entries may be left out, which changes nothing.
            if let Ok(read) = Checkpoint::read(&changed, RUN, structure()) {
                assert_eq!(read.text(RUN), text, "of {changed}");
            }
        }
    }
}

#[test]
fn states_that_no_run_comes_to_are_refused() {
    let refused = |change: fn(&mut Checkpoint)| {
        let mut checkpoint = checkpoint();
        change(&mut checkpoint);
        let read = Checkpoint::read(&checkpoint.text(RUN), RUN, structure());
        assert_eq!(
            read,
            Err("it is damaged; begin the run anew".to_string()),
            "{checkpoint:?}"
        );
    };
    refused(|c| c.state[2] = f64::NAN);
    refused(|c| c.state[0] = f64::INFINITY);
    refused(|c| c.state[0] = -1.0);
    refused(|c| c.state.truncate(6));
    refused(|c| c.origin.t = -1e300);
    refused(|c| c.report.steps = u64::MAX);
    refused(|c| c.report.wall = Duration::MAX);
    refused(|c| c.report.counters.projections = u64::MAX);
}
