//! The choices a user has, and the counts of what was done.
//!
//! Out: [`Form`], [`Stabilisation`], [`Settings`], [`Counters`].

use core::fmt::{Display, Formatter};

/// The form in which the equations of motion are solved. All give the same
/// accelerations at regular positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// The null-space form that passes singular positions and takes a cheap path
    /// away from them: what to use. Source: Phong & Hoang (2012), section 3.
    #[default]
    Reduced,
    /// Least squares on `[M E; A 0; 0 Dᵀ]`, for accelerations and reactions at
    /// once. Passes singular positions. Source: Phong & Hoang (2012), eqs.
    /// 3.9–3.11.
    Full,
    /// Lagrange multipliers. Ends at a singular position. Source: Phong & Hoang
    /// (2012), eq. 2.10.
    Multipliers,
    /// Independent and dependent coordinates. Ends at a singular position.
    /// Source: Phong & Hoang (2012), eqs. 2.16–2.25.
    Partitioning,
}

impl Form {
    /// All forms, in the order of their numbers in the interfaces of other languages.
    pub const ALL: [Self; 4] = [
        Self::Reduced,
        Self::Full,
        Self::Multipliers,
        Self::Partitioning,
    ];

    /// Whether it passes singular configurations.
    pub(crate) fn passes(self) -> bool {
        match self {
            Self::Reduced | Self::Full => true,
            Self::Multipliers | Self::Partitioning => false,
        }
    }
}

impl Display for Form {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Reduced => "reduced",
            Self::Full => "full",
            Self::Multipliers => "multipliers",
            Self::Partitioning => "partitioning",
        })
    }
}

/// How accepted states are kept on the constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stabilisation<T> {
    /// Positions and velocities are projected after each step.
    #[default]
    Projection,
    /// Nothing is projected; the constraints obey `g̈ + 2α ġ + β² g = 0` instead.
    /// Source: Baumgarte (1972).
    Baumgarte {
        /// Gain of the velocity level (1/s).
        alpha: T,
        /// Gain of the position level (1/s).
        beta: T,
    },
    /// Nothing keeps the state on the constraints: it drifts off.
    None,
}

/// How the equations of motion are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<T> {
    /// The form of the equations.
    pub form: Form,
    /// How the state is kept on the constraints.
    pub stabilisation: Stabilisation<T>,
    /// Whether singular positions are passed as published, by a decision on the rank
    /// alone: less accurate, for comparison.
    pub published: bool,
    /// Whether steps go across jumps and kinks of the forces, and points of splines, instead
    /// of ending there: less accurate, for forces that change sides more often than is worth
    /// a step.
    pub across_switches: bool,
}

impl<T> Default for Settings<T> {
    fn default() -> Self {
        Self {
            form: Form::Reduced,
            stabilisation: Stabilisation::Projection,
            published: false,
            across_switches: false,
        }
    }
}

/// How often each kind of work was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Accelerations that no rank decision was needed for.
    pub cheap_accelerations: u64,
    /// Accelerations on the sheet of the constraint set on which the motion lives, at
    /// regular states of a step near a singular configuration.
    pub beside_accelerations: u64,
    /// Accelerations where constraint rows are too weak for that: interpolated across a
    /// singular configuration or, in the form as published, with a rank decision.
    pub robust_accelerations: u64,
    /// Singular value decompositions of the constraint Jacobian.
    pub rank_decisions: u64,
    /// Starts at rest exactly in a singular configuration, where neither the constraints
    /// nor the velocity say which sheet is meant: all directions that they leave open
    /// are then free, and the least acceleration is taken.
    pub undetermined: u64,
    /// Factorisations of the mass matrix.
    pub mass_factorisations: u64,
    /// Factorisations of the constraints in the metric of the mass matrix.
    pub constraint_factorisations: u64,
    /// Choices of an independent subset of the constraint equations.
    pub row_choices: u64,
    /// Projected states.
    pub projections: u64,
    /// Corrections of positions in all projections.
    pub projection_iterations: u64,
    /// Projections where constraint rows are weak.
    pub robust_projections: u64,
}

impl core::ops::AddAssign for Counters {
    fn add_assign(&mut self, more: Self) {
        self.cheap_accelerations += more.cheap_accelerations;
        self.beside_accelerations += more.beside_accelerations;
        self.robust_accelerations += more.robust_accelerations;
        self.rank_decisions += more.rank_decisions;
        self.undetermined += more.undetermined;
        self.mass_factorisations += more.mass_factorisations;
        self.constraint_factorisations += more.constraint_factorisations;
        self.row_choices += more.row_choices;
        self.projections += more.projections;
        self.projection_iterations += more.projection_iterations;
        self.robust_projections += more.robust_projections;
    }
}
