//! Mechanisms that are recorded.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));

bricard_runtime::include_mechanism!("whipple_bicycle");
