//! Why a state could not be put onto its sheet.
//!
//! Out: [`Obstacle`]s: most are met by shorter steps, some are what a run ends with.

/// What stood in the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Obstacle {
    /// A number is infinite or NaN.
    NotFinite,
    /// The constraint rows are dependent.
    NotRegular,
    /// Newton's iteration does not contract: the sheet turns away, or there is another
    /// one next to it.
    NotContracting,
    /// The motion left its sheet, or nodes lie on another: energy was lost, or signs changed.
    LeftSheet,
    /// The sheet cannot be told from another one, whatever the spacing of the nodes.
    Unresolved,
    /// Sheets touch without crossing.
    Touching,
    /// Nothing kept the motion on the constraints, and it is too far off to tell sheets apart.
    Drifted,
    /// The state is in or next to a singular configuration, and nothing tells which of
    /// the sheets that cross there is meant.
    Undetermined,
}
