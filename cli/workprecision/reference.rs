//! What runs are compared with: the same motion in numbers of 106 bits.
//!
//! In:  a description, what is changed, the time of the end.
//! Out: the coordinates there.

use crate::compiled::open_precise;
use crate::description::Description;
use crate::error::CommandError;
use bricard_driver::{Changes, Exact, Precise};

/// Computes a motion with the parameters that runs in `f64` have, rounded as they are
/// there.
///
/// # Errors
///
/// [`CommandError::Run`] if the mechanism can't be assembled or a run failed.
pub fn exact(
    Description { file, source }: &Description,
    changes: &Changes,
    until: f64,
) -> Result<Exact, CommandError> {
    let refuse = |reason: String| {
        CommandError::run(format!(
            "the motion to compare with could not be computed: {reason}"
        ))
    };
    let mut precise = open_precise(file, source)?;
    precise.exact(changes, until).map_err(refuse)
}
