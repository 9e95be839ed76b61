//! The methods by their names, and where their stages lie.
//!
//! Out: [`Method`].

use super::classical;
use super::collocation;
use super::tableau::{DOP853, DP5};
use core::fmt::{Display, Formatter};

/// Which method makes the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// [`Rk4`](crate::Rk4), of order 4.
    Rk4,
    /// [`Dp5`](crate::Dp5), of order 5.
    Dp5,
    /// [`Dop853`](crate::Dop853), of order 8.
    Dop853,
    /// [`Radau5`](crate::Radau5), implicit, of order 5: for stiff mechanisms.
    Radau5,
    /// [`Radau9`](crate::Radau9), implicit, of order 9: for stiff mechanisms, to many digits.
    Radau9,
}

impl Display for Method {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Rk4 => "rk4",
            Self::Dp5 => "dp5",
            Self::Dop853 => "dop853",
            Self::Radau5 => "radau5",
            Self::Radau9 => "radau9",
        })
    }
}

impl Method {
    /// All methods, in the order of their numbers in the interfaces of other languages.
    pub const ALL: [Self; 5] = [
        Self::Rk4,
        Self::Dp5,
        Self::Dop853,
        Self::Radau5,
        Self::Radau9,
    ];

    /// The abscissae `c_i` of the stages of a step: where each lies, as a part of the step,
    /// in the order in which explicit methods compute them.
    pub fn abscissae(self) -> impl Iterator<Item = f64> {
        let (pairs, plain): (&[(f64, f64)], &[f64]) = match self {
            Self::Rk4 => (&[], &classical::ABSCISSAE),
            Self::Dp5 => (DP5.nodes, &[]),
            Self::Dop853 => (DOP853.nodes, &[]),
            Self::Radau5 => (&[], collocation::THREE.nodes),
            Self::Radau9 => (&[], collocation::FIVE.nodes),
        };
        // The last stage of Radau's methods is the end of the step.
        let last = matches!(self, Self::Radau5 | Self::Radau9).then_some(1.0);
        let high = pairs.iter().map(|(high, _)| *high);
        high.chain(plain.iter().copied()).chain(last)
    }
}
