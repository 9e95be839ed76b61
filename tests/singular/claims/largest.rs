//! The largest of a quantity over the steps of a run.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{DynamicsError, Observer, Probe, Step};
use core::ops::ControlFlow;

/// Keeps the largest of a function of the four coordinates at the ends of steps.
pub struct Largest {
    of: fn(&SVector<f64, 4>) -> f64,
    /// What it was at most.
    pub value: f64,
}

impl Largest {
    /// Nothing seen yet.
    pub fn of(of: fn(&SVector<f64, 4>) -> f64) -> Self {
        Self { of, value: 0.0 }
    }
}

impl Observer<f64, 4> for Largest {
    fn step(
        &mut self,
        step: &Step<f64, 4>,
        _probe: &mut dyn Probe<f64, 4>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let off = (self.of)(&step.end().q);
        // What is not a number stays.
        self.value = if off <= self.value { self.value } else { off };
        Ok(ControlFlow::Continue(()))
    }

    fn looks_inside(&self) -> bool {
        false
    }
}
