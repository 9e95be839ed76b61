//! Descriptions with what no mechanism of the library has: moving frames, velocity
//! constraints, every function, names that Rust reserves.

include!(concat!(env!("OUT_DIR"), "/mechanisms.rs"));

/// Mechanisms without the coordinates that constraints give explicitly.
pub mod eliminated {
    macro_rules! each {
        ($($name:literal)*) => {
            $(include!(concat!(env!("OUT_DIR"), "/eliminated/", $name, ".rs"));)*
        };
    }

    each! {
        "slider_crank"
        "slider_crank_driven"
        "scotch_yoke"
        "quick_return"
        "driven_pivot"
        "moving_rail"
        "hanging"
        "towed"
    }
}
