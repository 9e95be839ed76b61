//! The paper's mechanisms reduced to one degree of freedom, exactly: as mechanisms of the
//! library.

use bricard_testkit::Motion;
use std::f64::consts::PI;

/// Length of the links of the slider–crank (m).
const L: f64 = 0.5;

/// A mechanism reduced to one coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    SliderCrank,
    SliderCrankDriven,
    DoubleFourBar,
}

impl Reduction {
    pub const ALL: [Reduction; 3] = [
        Reduction::SliderCrank,
        Reduction::SliderCrankDriven,
        Reduction::DoubleFourBar,
    ];

    /// The name of the mechanism in the library.
    pub fn name(self) -> &'static str {
        match self {
            Reduction::SliderCrank => "slider_crank",
            Reduction::SliderCrankDriven => "slider_crank_driven",
            Reduction::DoubleFourBar => "double_four_bar",
        }
    }

    /// The angle at which the paper's run starts, at rest.
    pub fn start(self) -> f64 {
        match self {
            Reduction::DoubleFourBar => 80.0 * PI / 180.0,
            _ => PI / 4.0,
        }
    }

    /// A singular position.
    pub fn singular(self) -> f64 {
        match self {
            Reduction::DoubleFourBar => 0.0,
            _ => PI / 2.0,
        }
    }

    /// All coordinates and velocities.
    pub fn full(self, (q, v): Motion) -> (Vec<f64>, Vec<f64>) {
        let (sin, cos) = q.sin_cos();
        match self {
            Reduction::DoubleFourBar => (vec![q, 0.0, q, 0.0, q], vec![v, 0.0, v, 0.0, v]),
            _ => (vec![q, q, 2.0 * L * cos], vec![v, v, -2.0 * L * sin * v]),
        }
    }

    /// One step of the classical Runge–Kutta method.
    pub fn step(self, motion: Motion, h: f64) -> Motion {
        self.exact().step(h, motion)
    }

    /// The motion after a time, forwards or backwards.
    pub fn after(self, span: f64, from: Motion) -> Motion {
        self.exact().after(span, from)
    }

    fn exact(self) -> bricard_testkit::Reduction {
        match self {
            Reduction::SliderCrank => bricard_testkit::Reduction::SLIDER_CRANK,
            Reduction::SliderCrankDriven => bricard_testkit::Reduction::SLIDER_CRANK_DRIVEN,
            Reduction::DoubleFourBar => bricard_testkit::Reduction::DOUBLE_FOUR_BAR,
        }
    }
}
