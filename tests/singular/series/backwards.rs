//! Starts from which a motion reaches a given state.
//!
//! In:  a reduction and its parameters at the state to be reached.
//! Out: coordinates and velocities of the whole some time before.
//!
//! Conservative motions can be run backwards: reverse the velocities, wait, reverse them
//! again.

use crate::exact::exact;
use crate::trial::Set;

/// The state of the whole, `n` coordinates and `n` velocities, `span` seconds before the
/// one at which the parameters `set` start; `velocities` are those that start velocities.
pub fn before(
    (mechanism, reduced): (&str, &str),
    n: usize,
    set: &Set,
    velocities: &[&str],
    span: f64,
) -> Vec<f64> {
    let turned = |(name, value): &(&'static str, f64)| match velocities.contains(name) {
        true => (*name, -value),
        false => (*name, *value),
    };
    let set = set.iter().map(turned).collect();
    let mut state = exact(mechanism, reduced, &set, n, &[span]).numbers;
    for velocity in &mut state[n..] {
        *velocity = -*velocity;
    }
    state
}
