//! Any command line is understood or refused with a message, and the formulas in it
//! have finite values.

#![no_main]
#![allow(dead_code)]

#[path = "../../cli/arguments.rs"]
mod arguments;
#[path = "../../cli/formula.rs"]
mod formula;

use arguments::Arguments;
use clap::Parser;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let words = std::iter::once("bricard").chain(text.lines());
    if let Err(error) = Arguments::try_parse_from(words) {
        assert!(!error.to_string().is_empty(), "refused without a word");
    }
    for line in text.lines() {
        match formula::number(line) {
            Ok(value) => assert!(value.is_finite(), "`{line}` is {value}"),
            Err(message) => assert!(!message.is_empty(), "refused without a word"),
        }
    }
    // Texts that were read are kept for the places in them; here that would be for ever.
    proc_macro2::extra::invalidate_current_thread_spans();
});
