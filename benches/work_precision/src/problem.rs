//! What is run: the paper's mechanisms, exactly.
//!
//! In:  a start angle.
//! Out: the state on the constraints, and where the motion ends.
//!
//! All three reduce to one degree of freedom,
//! `Meff(q) q̈ + ½ Meff'(q) q̇² + V'(q) = Q`, which has no singular position.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Energy, Mechanism, Method, Settings, SimulateError, State, StepControl, Stepper, Structure,
    Terms,
};
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

    /// Where the crank is at the end, to about 1e-12 rad.
    ///
    /// # Errors
    ///
    /// A run that fails.
    pub fn exact(self, start: f64) -> Result<f64, SimulateError<f64>> {
        let step_control = StepControl::Fixed {
            step: REFERENCE_STEP,
        };
        let mut stepper =
            Stepper::<f64, 1, 0>::new(Method::Dop853, step_control, Settings::default())?;
        let mut state = State::new(0.0, [start].into(), [0.0].into());
        stepper.step(&Reduced(self), &mut state, self.end())?;
        Ok(state.q[0])
    }
}

/// Steps of order 8 so short that round-off is all that is left (s).
const REFERENCE_STEP: f64 = 0.002;
const G: f64 = 9.81;

static PLAIN: Structure = Structure {
    name: "Reduced",
    ..Structure::PLAIN
};

/// The equation of one degree of freedom.
struct Reduced(Problem);

impl Reduced {
    /// `Meff`, `½ Meff'`, `V'`.
    fn at(&self, q: f64) -> [f64; 3] {
        match self.0 {
            Problem::Free | Problem::Driven => {
                let (l, e, j, m3) = (0.5, 0.25, 0.1, 0.5);
                let constant = e * e + j + l * l + e * e + j;
                let mass =
                    constant - 2.0 * l * e * (2.0 * q).cos() + 4.0 * m3 * l * l * q.sin().powi(2);
                let slope = 2.0 * l * e * (2.0 * q).sin() + 2.0 * m3 * l * l * (2.0 * q).sin();
                [mass, slope, G * (e + l - e) * q.cos()]
            }
            Problem::FourBar => {
                let (r, e, j) = (0.4, 0.2, 0.1);
                [
                    3.0 * (e * e + j) + 2.0 * r * r,
                    0.0,
                    G * (3.0 * e + 2.0 * r) * q.cos(),
                ]
            }
        }
    }
}

impl Mechanism<f64, 1, 0> for Reduced {
    fn structure(&self) -> &'static Structure {
        &PLAIN
    }

    fn terms(&self, state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        let (q, v) = (state.q[0], state.v[0]);
        let [mass, slope, weight] = self.at(q);
        let moment = if self.0 == Problem::Driven {
            10.0 - 2.0 * v
        } else {
            0.0
        };
        out.mass[(0, 0)] = mass;
        out.force = SVector::from([moment - slope * v * v - weight]);
    }

    fn energy(&self, _state: &State<f64, 1>) -> Energy<f64> {
        Energy::default()
    }
}

#[cfg(test)]
mod tests {
    use super::Problem;

    /// Ends of the nominal motions by Gauss–Legendre collocation of order 20 with 34
    /// digits.
    const ENDS: [(Problem, f64); 3] = [
        (Problem::Free, -1.962_686_419_093_815_3),
        (Problem::Driven, 89.830_891_650_147_32),
        (Problem::FourBar, -1.528_710_001_192_138_2),
    ];

    #[test]
    fn the_reference_ends_where_34_digits_do_to_1e_11() {
        for (problem, end) in ENDS {
            let found = problem.exact(problem.nominal()).unwrap();
            assert!((found - end).abs() < 1e-11, "{problem:?}: {found}");
        }
    }
}
