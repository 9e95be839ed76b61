//! Any text is refused as a checkpoint with a reason, or is one from which a run goes on:
//! to its end, or to an error that says why.

#![no_main]
#![allow(dead_code)]

#[path = "../../cli/run/report.rs"]
mod report;
#[path = "../../cli/checkpoint/text.rs"]
mod text;

mod run {
    pub use crate::report::Report;
}

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Interface, Mechanism, Options, State, Visitor, simulate};
use libfuzzer_sys::fuzz_target;
use serde_json::Value;
use text::{Checkpoint, checksum};

/// What checkpoints are of: a loop with singular positions.
const MECHANISM: &str = "slider_crank";
const RUN: &str = "fuzz";
/// How far it goes on (s).
const FURTHER: f64 = 0.05;
/// Steps after which it has gone far enough.
const MOST_STEPS: u64 = 20;

/// Goes on where a text says, if it is a checkpoint.
struct GoesOn<'a>(&'a str);

impl Visitor<f64> for GoesOn<'_> {
    type Output = ();

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M)
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let checkpoint = match Checkpoint::read(self.0, RUN, mechanism.structure()) {
            Ok(checkpoint) => checkpoint,
            Err(reason) => return assert!(!reason.is_empty(), "refused without a word"),
        };
        let again = checkpoint.text(RUN);
        let read = Checkpoint::read(&again, RUN, mechanism.structure());
        assert_eq!(read.map(|read| read.text(RUN)), Ok(again), "read otherwise");
        let [t, values @ ..] = checkpoint.state.as_slice() else {
            panic!("a checkpoint without a state");
        };
        let [q, v] = [&values[..N], &values[N..]].map(SVector::from_column_slice);
        let state = State::new(*t, q, v);
        let mut options = Options::dop853(t + FURTHER, 1e-6);
        options.most_steps = Some(MOST_STEPS);
        options.origin = Some(checkpoint.origin);
        let mut report = checkpoint.report;
        match simulate(&mechanism, &state, &options, &mut []) {
            Ok(summary) => report.add(&summary),
            Err(failure) => {
                assert!(
                    !failure.error.to_string().is_empty(),
                    "failed without a word"
                );
                report.add(&failure.summary);
            }
        }
    }
}

fn goes_on(text: &str) {
    bricard_stress::visit(MECHANISM, GoesOn(text)).expect("it is in the catalogue");
}

fuzz_target!(|text: &str| {
    goes_on(text);
    // With the right checksum, what else is wrong must be found.
    if let Ok(mut value) = serde_json::from_str::<Value>(text)
        && value.is_object()
    {
        value["checksum"] = checksum(&value).into();
        goes_on(&value.to_string());
    }
});
