//! Mechanisms that are driven to where simulations fail: extreme masses, lengths and
//! speeds, singular starts, forces without bound.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));
