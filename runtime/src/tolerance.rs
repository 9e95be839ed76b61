//! Every tolerance of the constraints and of their singular configurations.
//!
//! In:  the precision of the scalar.
//! Out: numbers without units. Rows are measured in the metric of the kinetic energy and
//!      relative to the size they have away from singular configurations, lengths
//!      relative to that of the coordinates, so that a change of units or of the scale
//!      of a constraint changes no decision.
//!
//! Twelve values are chosen, each for what a test shows; the others follow from them.

use crate::Real;

/// Sine of the angle between a constraint row and the others below which a state is put
/// onto its sheet by interpolation between states that are farther away; also, what is
/// left of a row at a regular state.
pub(crate) fn window<T: Real>() -> T {
    T::from_f64(0.03)
}

/// How many times its change in the last step the sine must at least be above the window
/// for the next step to be safe from it.
pub(crate) fn safe_steps<T: Real>() -> T {
    T::from_f64(1.25)
}

/// Sine that a node must have, in spacings.
pub(crate) fn clearance<T: Real>() -> T {
    T::from_f64(0.03)
}

/// By how much each of Newton's corrections must at least be shorter than the one before.
pub(crate) fn contraction<T: Real>() -> T {
    T::from_f64(0.25)
}

/// Round-off of a position on the constraints.
pub(crate) fn round_off<T: Real>() -> T {
    T::EPSILON * T::from_f64(2.0)
}

/// Constraint error in a critical configuration, in units of round-off, up to which it is
/// a crossing.
pub(crate) fn critical<T: Real>() -> T {
    T::from_f64(50.0)
}

/// Relative error of an interpolation that is regarded as zero (3e-13 for `f64`).
pub(crate) fn resolved<T: Real>() -> T {
    T::EPSILON.powf(T::from_f64(0.8))
}

/// Smallest relative error of an interpolation that is ever demanded: it can always be
/// reached next to a singular configuration (1e-11 for `f64`).
pub(crate) fn resolvable<T: Real>() -> T {
    T::EPSILON.powf(T::from_f64(0.7))
}

/// Error of an interpolation, relative, that is accepted: a tenth of that of a step, which is
/// unknown where steps are fixed.
pub(crate) fn accepted<T: Real>(step: Option<T>) -> T {
    let step = step.unwrap_or(T::EPSILON.sqrt());
    (step * T::from_f64(0.1)).max(resolvable())
}

/// Upper bound on the error of an interpolation that round-off may excuse (1e-8 for `f64`):
/// half of the digits.
pub(crate) fn excusable<T: Real>() -> T {
    T::EPSILON.sqrt()
}

/// Distance, relative to the coordinates, of the differences that show how rows change
/// (2e-5 for `f64`).
pub(crate) fn difference<T: Real>() -> T {
    T::EPSILON.powf(T::from_f64(0.3))
}

/// Singular value above which a row counts as independent where a state is on the
/// constraints to round-off (5e-7 for `f64`): what is divided by it keeps half of its
/// digits.
pub(crate) fn regular<T: Real>() -> T {
    T::EPSILON.sqrt() * T::from_f64(32.0)
}

/// Singular value below which a row carries nothing but round-off (1e-9 for `f64`): the
/// quotient of two such numbers has no digit left. Also the constraint error, and the
/// length of a correction over which constraints are straight, in units of the size of
/// the coordinates.
pub(crate) fn negligible<T: Real>() -> T {
    T::EPSILON.sqrt() / T::from_f64(16.0)
}

/// Length of a coordinate's share in every row, relative to the largest share, below
/// which the masses alone make rows look near-dependent; and the square of such a share
/// in a metric that weighs rows by the heaviest masses.
pub(crate) fn disproportionate<T: Real>() -> T {
    T::from_f64(1e-2)
}

/// Spacing of the nodes of an interpolation across a singular configuration, as a change
/// of the sine: the innermost lie outside the window.
pub(crate) fn spacing<T: Real>() -> T {
    window::<T>() * T::from_f64(2.0)
}

/// What is left of a row, when the rows before it are eliminated, below which it comes
/// last and its gradient counts as nearly lost: a row that leaves the window is still
/// watched at the innermost nodes.
pub(crate) fn near_dependent<T: Real>() -> T {
    spacing()
}

/// How far from the singular configuration a state may be to be interpolated, in
/// spacings: as far as half of the nodes of each side.
pub(crate) fn hull<T: Real>(side: usize) -> T {
    T::from_f64(side as f64 / 2.0)
}

/// Pivot of the mass matrix, relative to its diagonal entry, at or below which the matrix
/// is not safely positive definite (2e-13 for `f64`): the square of a sine that is just
/// independent.
pub(crate) fn definite<T: Real>() -> T {
    regular::<T>() * regular()
}

/// Whether the smallest squared sine of the constraint rows is above a bound. NaN does not count as
/// above it.
pub(crate) fn passes<T: Real>(squared_sine: T, bound: T) -> bool {
    squared_sine > bound * bound
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What each tolerance needs of its neighbours, in every precision.
    fn check<T: Real>() {
        let one = T::one();
        // States in the window are well between the nodes, and these are regular.
        assert!(window::<T>() < spacing::<T>() * hull(5));
        assert!(clearance::<T>() * spacing() < near_dependent());
        assert!(negligible::<T>() < regular());
        assert!(regular::<T>() < window());
        assert!(window::<T>() < near_dependent());
        assert!(difference::<T>() < window());
        assert!(round_off::<T>() < resolved());
        assert!(resolved::<T>() < resolvable());
        assert!(resolvable::<T>() < excusable() && excusable::<T>() < regular());
        assert!(definite::<T>() < disproportionate());
        assert!(contraction::<T>() < one && safe_steps::<T>() > one);
    }

    #[test]
    fn tolerances_are_ordered_as_their_neighbours_need_it_in_every_precision() {
        check::<f64>();
        check::<f32>();
    }
}
