//! Any text is refused as a checkpoint with a reason, or is one from which a run goes on:
//! to its end, or to an error that says why.

#![no_main]
#![allow(dead_code)]

#[path = "../../cli/hash.rs"]
mod hash;
#[path = "../../cli/number.rs"]
mod number;
#[path = "../../cli/run/report.rs"]
mod report;
#[path = "../../cli/checkpoint/text.rs"]
mod text;

// What was generated is at hand, so that the compiler of descriptions is not built for this.
include!("../../tests/golden/slider_crank/generated.rs");

mod run {
    pub use crate::report::Report;
}

use bricard_driver::{Segment, Watch, erase_type};
use bricard_runtime::{Mechanism, Options};
use libfuzzer_sys::fuzz_target;
use serde_json::Value;
use slider_crank::SliderCrank;
use std::ops::ControlFlow;
use text::{Checkpoint, checksum};

const RUN: &str = "fuzz";
/// How far it goes on (s).
const FURTHER: f64 = 0.05;
/// Steps after which it has gone far enough.
const MOST_STEPS: u64 = 20;

/// Watches nothing.
struct Nobody;

impl Watch for Nobody {
    fn row(&mut self, _values: &[f64]) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn at(&mut self, _t: f64, _steps: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Goes on where a text says, if it is a checkpoint of a loop with singular positions.
fn goes_on(text: &str) {
    let mechanism = SliderCrank::<f64>::default();
    let checkpoint = match Checkpoint::read(text, RUN, mechanism.structure()) {
        Ok(checkpoint) => checkpoint,
        Err(reason) => return assert!(!reason.is_empty(), "refused without a word"),
    };
    let again = checkpoint.text(RUN);
    let read = Checkpoint::read(&again, RUN, mechanism.structure());
    assert_eq!(read.map(|read| read.text(RUN)), Ok(again), "read otherwise");
    let Some(t) = checkpoint.state.first() else {
        panic!("a checkpoint without a state");
    };
    let mut options = Options::dop853(t + FURTHER, 1e-6);
    options.most_steps = Some(MOST_STEPS);
    options.origin = Some(checkpoint.origin);
    let segment = Segment {
        options,
        from: Some(checkpoint.state.clone()),
        every: None,
        columns: Vec::new(),
        rows: checkpoint.rows.count,
        short: false,
    };
    let structure = mechanism.structure();
    let mut report = checkpoint.report;
    match erase_type(Box::new(mechanism)).segment(&segment, &mut Nobody) {
        Ok(reached) => {
            let silent = reached.error.as_ref().is_some_and(String::is_empty);
            assert!(!silent, "failed without a word");
            report.add(&reached, structure);
        }
        Err(reason) => assert!(!reason.is_empty(), "refused without a word"),
    }
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
