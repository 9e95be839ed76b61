//! Exact motions of mechanisms with one degree of freedom.
//!
//! In:  what is known of the effective mass and of the moments, a state.
//! Out: [`Reduction`]: accelerations, and the motion to 1e-11 over 20 s.
//!
//! `M_eff(q) q̈ + ½ M_eff'(q) q̇² + V'(q) = drive − damping q̇` has no singular position, so it
//! is what runs through singular positions are compared with.

/// Angle (rad) and rate (rad/s).
pub type Motion = (f64, f64);

/// `M_eff = constant + ripple cos 2q`, `V = weight sin q`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// Constant part of the effective mass (kg·m²).
    pub constant: f64,
    /// Part of the effective mass that varies with `cos 2q` (kg·m²).
    pub ripple: f64,
    /// Amplitude of the potential energy (J).
    pub weight: f64,
    /// Constant moment (N·m).
    pub drive: f64,
    /// Moment lost per speed (N·m·s).
    pub damping: f64,
}

/// Length of a step of [`Reduction::after`], at most (s).
const STEP: f64 = 5e-4;
/// Gravity in the paper's examples (m/s²).
const GRAVITY: f64 = 9.81;
/// Moment of inertia of every link in them (kg·m²); every link weighs 1 kg.
const J: f64 = 0.1;

impl Reduction {
    /// Phong & Hoang (2012), Example 1, without moment: crank and rod of length `L`, centres
    /// half way, a slider; `q₁ = q₂ = q`, `q₃ = 2 L cos q`, and
    /// `M_eff = (m₁e² + J + m₂L²) − 2 m₂Le cos 2q + (m₂e² + J) + 4 m₃L² sin² q`,
    /// `V = g (m₁e + m₂L − m₂e) sin q`.
    pub const SLIDER_CRANK: Self = {
        let (l, e, slider) = (0.5, 0.25, 0.5);
        Self {
            constant: 2.0 * (e * e + J) + l * l + 2.0 * slider * l * l,
            ripple: -2.0 * l * e - 2.0 * slider * l * l,
            weight: GRAVITY * l,
            drive: 0.0,
            damping: 0.0,
        }
    };

    /// Phong & Hoang (2012), Example 1, with the moment `10 − 2 q̇₁`.
    pub const SLIDER_CRANK_DRIVEN: Self = Self {
        drive: 10.0,
        damping: 2.0,
        ..Self::SLIDER_CRANK
    };

    /// Phong & Hoang (2012), Example 2: `q₁ = q₃ = q₅ = q`, `q₂ = q₄ = 0`, and
    /// `M_eff = 3 (m e² + J) + 2 m r²`, `V = g (3 m e + 2 m r) sin q`.
    pub const DOUBLE_FOUR_BAR: Self = {
        let (r, e) = (0.4, 0.2);
        Self {
            constant: 3.0 * (e * e + J) + 2.0 * r * r,
            ripple: 0.0,
            weight: GRAVITY * (3.0 * e + 2.0 * r),
            drive: 0.0,
            damping: 0.0,
        }
    };

    /// `M_eff` (kg·m²) at an angle.
    pub fn mass(&self, angle: f64) -> f64 {
        self.constant + self.ripple * (2.0 * angle).cos()
    }

    /// `q̈` (rad/s²).
    pub fn acceleration(&self, angle: f64, rate: f64) -> f64 {
        let (s, c) = angle.sin_cos();
        let mass = self.constant + self.ripple * (c * c - s * s);
        let derivative = -4.0 * self.ripple * s * c;
        let moment = self.drive - self.damping * rate - self.weight * c;
        (moment - 0.5 * derivative * rate * rate) / mass
    }

    /// `|q̇|` at an angle after rest at another, from the energy; there is no moment.
    pub fn rate_after_rest(&self, rest: f64, angle: f64) -> f64 {
        (2.0 * self.weight * (rest.sin() - angle.sin()) / self.mass(angle)).sqrt()
    }

    /// The motion a time `span` (s) later, earlier if it is negative.
    pub fn after(&self, span: f64, from: Motion) -> Motion {
        let steps = (span.abs() / STEP).ceil().max(1.0);
        (0..steps as usize).fold(from, |motion, _| self.extrapolated(span / steps, motion))
    }

    /// A step of the classical Runge–Kutta method.
    pub fn step(&self, h: f64, (q, v): Motion) -> Motion {
        let a1 = self.acceleration(q, v);
        let v2 = v + 0.5 * h * a1;
        let a2 = self.acceleration(q + 0.5 * h * v, v2);
        let v3 = v + 0.5 * h * a2;
        let a3 = self.acceleration(q + 0.5 * h * v2, v3);
        let v4 = v + h * a3;
        let a4 = self.acceleration(q + h * v3, v4);
        (
            q + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4),
            v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
        )
    }

    /// Two steps of half the length against one remove the leading error (Richardson).
    fn extrapolated(&self, h: f64, from: Motion) -> Motion {
        let (q1, v1) = self.step(h, from);
        let (q2, v2) = self.step(0.5 * h, self.step(0.5 * h, from));
        (q2 + (q2 - q1) / 15.0, v2 + (v2 - v1) / 15.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Reduction;
    use std::f64::consts::FRAC_PI_4;

    /// The motions of the paper from rest: start, time, and the angle at the end by
    /// Gauss–Legendre collocation of order 20 with 34 digits, at two step sizes that agree to
    /// all digits given.
    #[test]
    fn the_motions_of_the_paper_end_where_34_digits_do() {
        let eighty = 80.0_f64.to_radians();
        for (reduction, start, end, angle) in [
            (
                Reduction::SLIDER_CRANK,
                FRAC_PI_4,
                8.0,
                -1.962_686_419_093_815_3,
            ),
            (
                Reduction::SLIDER_CRANK_DRIVEN,
                FRAC_PI_4,
                20.0,
                89.830_891_650_147_32,
            ),
            (
                Reduction::DOUBLE_FOUR_BAR,
                eighty,
                8.0,
                -1.528_710_001_192_138_2,
            ),
        ] {
            let (found, _) = reduction.after(end, (start, 0.0));
            assert!(
                (found - angle).abs() < 1e-11,
                "{reduction:?}: {found}, not {angle}"
            );
        }
    }
}
