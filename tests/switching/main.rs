//! Forces that jump and kink, and events, against closed forms.

mod events;
mod jumps;
mod measured;
mod points;
mod tables;
