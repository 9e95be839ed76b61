//! Mechanisms whose forces jump.

include!(concat!(env!("OUT_DIR"), "/contact.rs"));
include!(concat!(env!("OUT_DIR"), "/cranked.rs"));
include!(concat!(env!("OUT_DIR"), "/drawn.rs"));
include!(concat!(env!("OUT_DIR"), "/friction.rs"));
include!(concat!(env!("OUT_DIR"), "/frozen.rs"));
include!(concat!(env!("OUT_DIR"), "/gripped.rs"));
include!(concat!(env!("OUT_DIR"), "/jointed.rs"));
include!(concat!(env!("OUT_DIR"), "/jointed_reduced.rs"));
include!(concat!(env!("OUT_DIR"), "/kicked.rs"));
include!(concat!(env!("OUT_DIR"), "/knotted.rs"));
include!(concat!(env!("OUT_DIR"), "/looped.rs"));
include!(concat!(env!("OUT_DIR"), "/measured.rs"));
include!(concat!(env!("OUT_DIR"), "/parallelogram.rs"));
include!(concat!(env!("OUT_DIR"), "/paused.rs"));
include!(concat!(env!("OUT_DIR"), "/placed.rs"));
include!(concat!(env!("OUT_DIR"), "/pulsed.rs"));
include!(concat!(env!("OUT_DIR"), "/released.rs"));
include!(concat!(env!("OUT_DIR"), "/saturated.rs"));
include!(concat!(env!("OUT_DIR"), "/shifted.rs"));
include!(concat!(env!("OUT_DIR"), "/slowing.rs"));
include!(concat!(env!("OUT_DIR"), "/stopping.rs"));
include!(concat!(env!("OUT_DIR"), "/tabled.rs"));
include!(concat!(env!("OUT_DIR"), "/timed.rs"));
include!(concat!(env!("OUT_DIR"), "/warmed.rs"));
