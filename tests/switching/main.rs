//! Forces that jump and kink, and events, against closed forms.

// Its simulation of each pair of sizes is shared, where the compiler shares generic code.
use bricard as _;

mod changes;
mod events;
mod jumps;
mod loops;
mod measured;
mod pieces;
mod points;
mod tables;
