//! The paper's mechanisms reduced to one degree of freedom, exactly.
//!
//! `Meff(q) q̈ + ½ Meff'(q) q̇² + V'(q) = Q(q̇)`, where all coordinates follow from q:
//!
//! - slider–crank, equal links `L`, centres half way: `q₁ = q₂ = q`, `q₃ = 2 L cos q`,
//!   `Meff = (m₁e² + J₁ + m₂L²) − 2 m₂Le cos 2q + (m₂e² + J₂) + 4 m₃L² sin² q`,
//!   `V = g (m₁e + m₂L − m₂e) sin q`; `Q = 0`, or `10 − 2 q̇` where it is driven;
//! - double four-bar: `q₁ = q₃ = q₅ = q`, `q₂ = q₄ = 0`,
//!   `Meff = 3 (m e² + J) + 2 m r²`, `V = g (3 m e + 2 m r) sin q`.

use std::f64::consts::PI;

const G: f64 = 9.81;
/// Slider–crank: length of the links, distance of their centres (m).
const L: f64 = 0.5;
const E: f64 = 0.25;
/// Inertia of every link of both mechanisms (kg m²); every link weighs 1 kg.
const J: f64 = 0.1;
const SLIDER: f64 = 0.5;
/// Double four-bar: length of the cranks, distance of their centres (m).
const CRANK: f64 = 0.4;
const HALF: f64 = 0.2;

/// Angle and its velocity.
pub type Motion = (f64, f64);

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

    pub fn acceleration(self, (q, v): Motion) -> f64 {
        let (sin, cos) = q.sin_cos();
        match self {
            Reduction::DoubleFourBar => {
                let inertia = 3.0 * (HALF * HALF + J) + 2.0 * CRANK * CRANK;
                -G * (3.0 * HALF + 2.0 * CRANK) * cos / inertia
            }
            _ => {
                let links = 2.0 * (E * E + J) + L * L - 2.0 * L * E * (2.0 * q).cos();
                let inertia = links + 4.0 * SLIDER * L * L * sin * sin;
                let slope = 4.0 * L * E * (2.0 * q).sin() + 8.0 * SLIDER * L * L * sin * cos;
                let moment = if self == Reduction::SliderCrank {
                    0.0
                } else {
                    10.0 - 2.0 * v
                };
                (moment - G * L * cos - 0.5 * slope * v * v) / inertia
            }
        }
    }

    /// One step of the classical Runge–Kutta method.
    pub fn step(self, (q, v): Motion, h: f64) -> Motion {
        let a1 = self.acceleration((q, v));
        let v2 = v + h / 2.0 * a1;
        let a2 = self.acceleration((q + h / 2.0 * v, v2));
        let v3 = v + h / 2.0 * a2;
        let a3 = self.acceleration((q + h / 2.0 * v2, v3));
        let v4 = v + h * a3;
        let a4 = self.acceleration((q + h * v3, v4));
        (
            q + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4),
            v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
        )
    }

    /// The motion after a time, forwards or backwards, to about 1e-14.
    pub fn after(self, span: f64, from: Motion) -> Motion {
        let steps = (span.abs() / 2e-4).ceil().max(1.0);
        (0..steps as usize).fold(from, |motion, _| self.step(motion, span / steps))
    }
}
