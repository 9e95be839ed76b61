//! One run whose right answer is known.
//!
//! Out: [`Trial`].

use crate::planting::Planting;
use bricard_runtime::Method;
use std::fmt::{Display, Formatter};
use std::sync::Arc;

/// Parameters with other values.
pub type Set = Vec<(&'static str, f64)>;

/// What the rows of a run are held against, besides its invariants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compare {
    /// A reduction without constraints, by its name: for runs so short that errors have
    /// not grown.
    Reduction(&'static str),
    /// Nothing: for chaotic motions, and where no reduction exists.
    Invariants,
    /// A reduction without constraints, by its name, where velocities turn within the time in which
    /// errors are made: positions are compared, and velocities at the end.
    Turning(&'static str),
    /// The curve of the almost parallelogram, followed by its tangent.
    Along,
    /// The start, from which nothing may move.
    Rest,
}

/// What a run may come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// A right answer exists.
    Right,
    /// None exists, or none can be told from another: an error is as good.
    Ended,
}

/// One run whose right answer is known.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The mechanism, by its name.
    pub mechanism: &'static str,
    /// Its parameters.
    pub set: Set,
    /// The end of the run (s).
    pub until: f64,
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// The method.
    pub method: Method,
    /// The length of its steps (s), if they are not as long as the tolerance allows.
    pub step: Option<f64>,
    /// What its rows are held against.
    pub compare: Compare,
    /// The reduction whose sign changes are the passages, if they are counted.
    pub passages: Option<&'static str>,
    /// Coordinates whose start values must stay to the last bit, with the parameters that
    /// hold them.
    pub held: &'static [(usize, &'static str)],
    /// The mechanism itself, if it was made at run time.
    pub planted: Option<Arc<Planting>>,
    /// Series, seed and place, from which it can be made again.
    pub made: (&'static str, u64, usize),
}

impl Trial {
    /// A short run beside a reduction, passages counted.
    pub fn short(mechanism: &'static str, reduced: &'static str, set: Set) -> Self {
        Self {
            mechanism,
            set,
            until: 1.0,
            tolerance: 1e-9,
            method: Method::Dop853,
            step: None,
            compare: Compare::Reduction(reduced),
            passages: Some(reduced),
            held: &[],
            planted: None,
            made: ("", 0, 0),
        }
    }

    /// This run up to another time.
    pub fn until(self, until: f64) -> Self {
        Self { until, ..self }
    }

    /// This run without counting passages.
    pub fn uncounted(self) -> Self {
        let passages = None;
        Self { passages, ..self }
    }
}

impl Display for Trial {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.mechanism)?;
        for (name, value) in &self.set {
            write!(f, " --set {name}={value:?}")?;
        }
        let (series, seed, index) = self.made;
        let method = self.method;
        match self.step {
            Some(step) => write!(f, " --step {step:?}")?,
            None => write!(f, " --rtol {:e}", self.tolerance)?,
        }
        write!(f, " --until {:?}", self.until)?;
        write!(
            f,
            "   [--only {series} --seed {seed} --index {index} --method {method}]"
        )
    }
}
