//! What runs are compared with: the same motion in numbers of 106 bits.
//!
//! In:  a name, what is changed, the time of the end.
//! Out: the coordinates there.

use crate::changes::Changes;
use crate::error::CommandError;
use bricard_driver::Given;
use bricard_reference::{DoubleDouble, reference_from};
use bricard_runtime::{Initial, Interface, Mechanism, Real, Visitor, Whole};

/// Coordinates at the end of a motion, rounded, and how far they may be off.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    /// The coordinates.
    pub end: Vec<f64>,
    /// What two computations of them differ by.
    pub error: f64,
}

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
    let found = bricard::visit(name, Compute { changes, until });
    found
        .unwrap_or_else(|| Err("there is no such mechanism".to_string()))
        .map_err(refuse)
}

struct Compute<'a> {
    changes: &'a Changes,
    until: f64,
}

impl Visitor<DoubleDouble> for Compute<'_> {
    type Output = Result<Exact, String>;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> Self::Output
    where
        M: Mechanism<DoubleDouble, N, R> + Interface<DoubleDouble, N> + Clone + 'static,
    {
        let wide = DoubleDouble::from_f64;
        for index in 0..mechanism.structure().parameters.len() {
            if let Some(value) = mechanism.parameter(index) {
                mechanism.set_parameter(index, wide(value.to_f64()));
            }
        }
        for (index, value) in &self.changes.parameters {
            mechanism.set_parameter(*index, wide(*value));
        }
        for (index, value) in &self.changes.inputs {
            mechanism.set_input(*index, Some(wide(*value)));
        }
        let mechanism: Box<dyn Whole<DoubleDouble, N, R>> = Box::new(mechanism);
        compute(&*mechanism, &self.changes.given, self.until)
    }
}

fn compute<const N: usize, const R: usize>(
    mechanism: &dyn Whole<DoubleDouble, N, R>,
    given: &[Given],
    until: f64,
) -> Result<Exact, String> {
    let mut start = mechanism.start();
    for given in given {
        let entries = if given.velocity {
            &mut start.v
        } else {
            &mut start.q
        };
        if let Some(entry) = entries.get_mut(given.coordinate) {
            let (value, held) = (DoubleDouble::from_f64(given.value), given.held);
            *entry = Initial { value, held };
        }
    }
    let until = DoubleDouble::from_f64(until);
    let reference = reference_from(mechanism, &start, until).map_err(|error| error.to_string())?;
    Ok(Exact {
        end: reference.end.q.iter().map(|x| x.to_f64()).collect(),
        error: reference.error,
    })
}
