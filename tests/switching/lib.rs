//! Mechanisms whose forces jump.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
