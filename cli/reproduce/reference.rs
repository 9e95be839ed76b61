//! What the experiments are compared with.
//!
//! End values: exact to all digits given. Both examples reduce to one degree of
//! freedom, `Meff(q) q̈ + ½ Meff'(q) q̇² + V'(q) = Q`:
//!
//! - slider–crank: q₂ = q₁ = q, q₃ = 2 L cos q, `Meff = (m₁e₁² + J₁ + m₂L²)
//!   − 2 m₂ L e₂ cos 2q + (m₂e₂² + J₂) + 4 m₃ L² sin² q`,
//!   `V = g (m₁e₁ + m₂L − m₂e₂) sin q`;
//! - double four-bar: q₁ = q₃ = q₅ = q, q₂ = q₄ = 0, `Meff = 3 (m e² + J) + 2 m r²`,
//!   `V = g (3 m e + 2 m r) sin q`.
//!
//! They were integrated by Gauss–Legendre collocation of order 20 with 34 digits
//! at two step sizes, which agree to 1e−14 or better. The passages through
//! singular positions are the zeros of sin q₁ of the same solution, rounded to
//! the millisecond.

/// A coordinate and its velocity at the end of a run, exact to 1e−14.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Crank angle q₁ (rad).
    pub q1: f64,
    /// Its velocity (rad/s).
    pub dq1: f64,
}

/// Slider–crank without moment at 8 s.
pub const SLIDER_CRANK_8: End = End {
    q1: -1.962_686_419_093_813,
    dq1: -3.684_010_995_488_191_5,
};
/// Slider–crank with the moment 10 − 2 q̇₁ at 8 s.
pub const DRIVEN_8: End = End {
    q1: 35.501_177_212_785_51,
    dq1: 4.890_780_775_913_958,
};
/// Slider–crank with the moment 10 − 2 q̇₁ at 20 s.
pub const DRIVEN_20: End = End {
    q1: 89.830_891_650_147_32,
    dq1: 3.397_563_053_091_582_7,
};
/// Double four-bar at 8 s.
pub const DOUBLE_FOUR_BAR_8: End = End {
    q1: -1.528_710_001_192_138_2,
    dq1: -8.581_436_319_158_87,
};

/// When the double four-bar passes a singular position within 8 s (s).
pub const PASSAGES: [f64; 9] = [
    0.684, 1.095, 2.463, 2.874, 4.242, 4.653, 6.020, 6.432, 7.799,
];
/// How many passages the paper counts in the same run.
pub const PASSAGES_IN_PAPER: usize = 6;
