//! Mechanisms that are recorded.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
