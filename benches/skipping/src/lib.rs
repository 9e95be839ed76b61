//! Pairs of descriptions that differ in one thing, and the mechanisms generated from them.

pub mod pairs;

macro_rules! generated {
    ($($name:literal)*) => {
        $(
            include!(concat!(env!("OUT_DIR"), "/", $name, "_with.rs"));
            include!(concat!(env!("OUT_DIR"), "/", $name, "_without.rs"));
        )*
    };
}

generated! {
    "mass" "ignorable" "constraints" "rank" "clock" "zeros" "ties" "parameters" "conditions" "passage" "sheets"
}
