//! What runs are compared with: the same motion in numbers of 106 bits.
//!
//! In:  a name, what is changed, the time of the end.
//! Out: the coordinates there.

use crate::error::CommandError;
use crate::mechanism::precise;
use bricard_driver::{Changes, Exact};

/// Computes a motion with the parameters that runs in `f64` have, rounded as they are
/// there.
///
/// # Errors
///
/// [`CommandError::Run`] if the mechanism can't be assembled or a run failed.
pub fn exact(name: &str, changes: &Changes, until: f64) -> Result<Exact, CommandError> {
    let refuse = |reason: String| CommandError::Run {
        reason: format!("the motion to compare with could not be computed: {reason}"),
        kept: String::new(),
    };
    precise(name)?.exact(changes, until).map_err(refuse)
}
