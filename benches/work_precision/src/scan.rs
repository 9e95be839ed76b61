//! Many start angles: none may leave its branch, none may be much worse than others.
//!
//! In:  a method at a setting.
//! Out: how many runs left the branch or stopped; median and worst error of the rest.

use crate::problem::Problem;
use crate::run::Solver;

/// Start angles lie within this of the nominal one (rad).
const AROUND: f64 = 0.05;
/// Further off the branch than this is another branch.
const OFF: f64 = 0.2;

/// Start angles and exact ends.
pub struct Starts(Vec<(f64, f64)>);

impl Starts {
    /// `count` angles spread evenly around the nominal one.
    pub fn new(problem: Problem, count: u32) -> Self {
        let angle = |i| {
            let part = (f64::from(i) + 0.5) / f64::from(count);
            problem.nominal() + AROUND * (2.0 * part - 1.0)
        };
        let pair = |i| (angle(i), problem.exact(angle(i)));
        Self((0..count).map(pair).collect())
    }
}

/// What came of all start angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Runs that left the branch or stopped.
    pub failed: usize,
    /// Errors of q₁ of the others, sorted (rad).
    errors: Vec<f64>,
}

impl Scan {
    /// Runs all start angles.
    pub fn new(problem: Problem, method: Solver, setting: f64, starts: &Starts) -> Self {
        let mut errors = Vec::new();
        for (start, exact) in &starts.0 {
            if let Ok(q) = method.run(problem, *start, setting)
                && problem.off_branch(&q) < OFF
            {
                errors.push((q[0] - exact).abs());
            }
        }
        errors.sort_by(f64::total_cmp);
        Self {
            failed: starts.0.len() - errors.len(),
            errors,
        }
    }

    /// The median error (rad).
    pub fn median(&self) -> Option<f64> {
        self.errors.get(self.errors.len() / 2).copied()
    }

    /// The worst error (rad).
    pub fn worst(&self) -> Option<f64> {
        self.errors.last().copied()
    }
}
