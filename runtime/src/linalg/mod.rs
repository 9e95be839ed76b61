//! Fixed-size factorisations that know about rank, and every tolerance.
//!
//! In:  nalgebra matrices of const sizes, over any [`Real`].
//! Out: Cholesky and pivot ratios, orthogonal bases by one-sided Jacobi
//!      rotations, least squares row by row, elimination with complete pivoting.
//!      Nothing allocates, panics or runs without a bound; what is not finite is
//!      reported.
//!
//! Not here: mechanics. No routine knows what its matrix stands for. The
//! tolerances do: this is the one place where they are defined, all of them free
//! of units, so that a change of units or of the scale of a constraint changes no
//! decision.

mod cholesky;
mod column;
mod elimination;
mod gram;
mod jacobi;
mod subset;
#[cfg(test)]
mod tests;
mod triangle;

pub(crate) use cholesky::{Cholesky, NotDefinite, is_definite};
pub(crate) use column::{add_scaled, dot, norm, scaled};
pub(crate) use elimination::Elimination;
pub(crate) use gram::Gram;
pub(crate) use jacobi::{Breakdown, orthogonalise};
pub(crate) use subset::independent_rows;
pub(crate) use triangle::Triangle;

use crate::Real;

/// Sine of the angle between a constraint row and the others below which the row
/// is called weak: the cheap path ends here and branch rows take over.
///
/// Rows are measured in the metric of the kinetic energy and relative to the size
/// they have away from singular positions.
pub(crate) fn weak<T: Real>() -> T {
    T::from_f64(1e-2)
}

/// Sine of the same angle above which a row is plainly independent of those before it,
/// so that no singular value is needed to say so.
pub(crate) fn solid<T: Real>() -> T {
    T::from_f64(0.1)
}

/// Sine of the same angle below which an acceleration is taken at the nearest state
/// on the constraints, and not at the state itself: the stages of a step are off
/// the constraints by `δ`, which changes the acceleration there by `δ` over sine.
pub(crate) fn guard<T: Real>() -> T {
    T::from_f64(2e-2)
}

/// Singular value below which the branch rows decide even on the constraints (9e-3
/// for `f64`): a row of size `σ` turns round-off `ε` of the position into an error
/// `ε/σ³` of the acceleration, the branch rows leave out something of order `σ⁴`.
pub(crate) fn useless<T: Real>() -> T {
    T::EPSILON.powf(T::from_f64(1.0 / 7.0)) * T::from_f64(1.5)
}

/// Singular value above which a row on the constraints shows the tangent of its
/// branch better than branch rows do (1e-6 for `f64`): round-off `ε` of the position
/// turns its direction by `ε/σ`, theirs is off by about `σ²`.
pub(crate) fn tangible<T: Real>() -> T {
    T::EPSILON.sqrt() * T::from_f64(64.0)
}

/// Distance across a branch, in units of the distance to the singular position
/// along it, up to which a state belongs to this branch and not to another.
pub(crate) fn same_branch<T: Real>() -> T {
    T::from_f64(0.25)
}

/// How far along the motion the jerk is taken from, in units of the time in which
/// a weak row grows to its regular size: the fourth root of the round-off (1e-4 for
/// `f64`), which second differences ask for.
pub(crate) fn jerk_span<T: Real>() -> T {
    T::EPSILON.sqrt().sqrt()
}

/// The same for jerk, snap and crackle together: the sixth root (2e-3 for `f64`),
/// which third differences ask for.
pub(crate) fn crackle_span<T: Real>() -> T {
    T::EPSILON.powf(T::from_f64(1.0 / 6.0))
}

/// The angle (rad) between the states that a branch is interpolated from, in which a
/// constraint row turns; also, about, the sine of the constraints at the first of them.
pub(crate) fn pier_distance<T: Real>() -> T {
    T::from_f64(0.075)
}

/// By how much, relative to what is interpolated, two interpolations may differ that
/// use more and fewer states (1e-9 for `f64`).
pub(crate) fn on_bridge<T: Real>() -> T {
    truncation()
}

/// The same sine for the first step of a motion.
pub(crate) fn first_guard<T: Real>() -> T {
    T::from_f64(0.25)
}

/// How many times its change in the last step the sine must at least be above the
/// guard for the next step to be safe from it.
pub(crate) fn safe_steps<T: Real>() -> T {
    T::from_f64(1.25)
}

/// Smallest singular value, relative to the branch rows' norm, at which a branch
/// row decides a direction. Rows that are redundant everywhere stay below.
pub(crate) fn branch_rank<T: Real>() -> T {
    T::from_f64(1e-3)
}

/// Singular value above which a row counts as independent where a state is on the
/// constraints to round-off (1e-6 for `f64`): well above the error of assembly,
/// well below the window of weak rows.
pub(crate) fn independent<T: Real>() -> T {
    T::EPSILON.sqrt() * T::from_f64(64.0)
}

/// Singular value below which a row does not count in the rank that is reported
/// for a position.
pub(crate) fn reported_rank<T: Real>() -> T {
    T::from_f64(1e-3)
}

/// Singular value below which a row carries nothing but round-off (1e-9 for
/// `f64`): the quotient of two such numbers has no digit left.
pub(crate) fn truncation<T: Real>() -> T {
    T::EPSILON.sqrt() / T::from_f64(16.0)
}

/// Pivot of the mass matrix, relative to its diagonal entry, at or below which
/// the matrix is not safely positive definite (1e-12 for `f64`).
pub(crate) fn definite<T: Real>() -> T {
    T::EPSILON * T::from_f64(4096.0)
}

/// Length of a coordinate's share in every row, relative to the largest share, below
/// which the masses alone make rows look weak.
pub(crate) fn disproportionate<T: Real>() -> T {
    weak()
}

/// The square of such a share in a metric that weighs rows by the heaviest masses: well
/// above the guard, and no larger, for the digits that the light parts lose by it.
pub(crate) fn even<T: Real>() -> T {
    T::from_f64(1e-2)
}

/// Constraint error, in units of the round-off of the coordinates, at which a
/// position is on the constraints.
pub(crate) fn on_constraint<T: Real>() -> T {
    T::from_f64(2.0)
}

/// Constraint error, in units of the size of the coordinates, that is accepted
/// where iteration no longer makes it smaller.
pub(crate) fn acceptable<T: Real>() -> T {
    truncation()
}

/// Length of a correction, in units of that of the coordinates, over which constraints
/// are straight (1e-9 for `f64`): what a linear correction leaves is of the order of
/// its square.
pub(crate) fn straight<T: Real>() -> T {
    truncation()
}

/// How many times its own uncertainty a residual must be before a weak direction
/// is corrected for it. Less, and the correction would be noise.
pub(crate) fn significant<T: Real>() -> T {
    T::from_f64(4.0)
}

/// Whether the smallest squared sine of the constraint rows is above a bound. NaN
/// is not.
pub(crate) fn passes<T: Real>(squared_sine: T, bound: T) -> bool {
    squared_sine > bound * bound
}
