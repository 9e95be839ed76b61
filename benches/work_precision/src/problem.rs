//! What is run: the paper's mechanisms, exactly.
//!
//! In:  a start angle.
//! Out: the state on the constraints, and where the motion ends.
//!
//! All three reduce to one degree of freedom, which has no singular position.

use bricard_testkit::Reduction;
use std::error::Error;

/// All coordinates at the end.
pub type End = Vec<f64>;
/// Why a run failed.
pub type Failed = Box<dyn Error>;

/// A run of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// Slider–crank, free, 8 s.
    Free,
    /// Slider–crank with the moment 10 − 2 q̇₁, 20 s.
    Driven,
    /// Double four-bar, 8 s.
    FourBar,
}

impl Problem {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Free, Self::Driven, Self::FourBar];

    /// What it is called in tables.
    pub fn title(self) -> &'static str {
        match self {
            Self::Free => "slider–crank, free, 8 s",
            Self::Driven => "slider–crank, driven, 20 s",
            Self::FourBar => "double four-bar, 8 s",
        }
    }

    /// A name for files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Free => "slider_crank",
            Self::Driven => "slider_crank_driven",
            Self::FourBar => "double_four_bar",
        }
    }

    /// When it ends (s).
    pub fn end(self) -> f64 {
        if self == Self::Driven { 20.0 } else { 8.0 }
    }

    /// The paper's start angle (rad).
    pub fn nominal(self) -> f64 {
        match self {
            Self::Free | Self::Driven => 45.0_f64.to_radians(),
            Self::FourBar => 80.0_f64.to_radians(),
        }
    }

    /// All coordinates at an angle of the crank.
    pub fn coordinates(self, angle: f64) -> Vec<f64> {
        match self {
            Self::Free | Self::Driven => vec![angle, angle, angle.cos()],
            Self::FourBar => vec![angle, 0.0, angle, 0.0, angle],
        }
    }

    /// How far coordinates are from the branch on which the motion began: 0 on it,
    /// about 1 on others.
    pub fn off_branch(self, q: &[f64]) -> f64 {
        let apart = |a: f64, b: f64| (0.5 * (a - b)).sin().abs();
        match self {
            Self::Free | Self::Driven => apart(q[0], q[1]),
            Self::FourBar => apart(q[0], q[2]).max(apart(q[2], q[4])),
        }
    }

    /// The motion of the crank without constraints.
    pub fn reduction(self) -> Reduction {
        match self {
            Self::Free => Reduction::SLIDER_CRANK,
            Self::Driven => Reduction::SLIDER_CRANK_DRIVEN,
            Self::FourBar => Reduction::DOUBLE_FOUR_BAR,
        }
    }

    /// Where the crank is at the end, to about 1e-11 rad.
    pub fn exact(self, start: f64) -> f64 {
        self.reduction().after(self.end(), (start, 0.0)).0
    }
}
