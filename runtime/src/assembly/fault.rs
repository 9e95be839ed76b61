//! Which equations of the `start` block do not hold.
//!
//! Out: [`StartFault`], and the advice that all errors of assembly end with.

use crate::number::Number;
use crate::{Quantity, Real, Structure};
use core::fmt::{self, Display, Formatter};

/// Which equations of the `start` block do not hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartFault<T, const N: usize> {
    /// Time of the start (s).
    pub t: T,
    /// The constraints and the equations, for their texts.
    pub structure: &'static Structure,
    /// The row that is farthest off, and by how much; `None` if something is infinite or
    /// NaN.
    pub farthest: Option<(usize, T)>,
    /// Whether velocities don't satisfy it, else positions.
    pub velocities: bool,
    /// Which held values stand in the way.
    pub conflicting: [bool; N],
}

impl<T: Real, const N: usize> Display for StartFault<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Some((row, error)) = self.farthest else {
            return write!(
                f,
                "an equation of `start`, or a constraint or the mass matrix, is infinite or NaN at \
                 t = {t} s; check the values in `start` and the parameters",
                t = Number(&self.t)
            );
        };
        let (what, hold, per, around) = match self.velocities {
            true => ("velocities", "satisfy", " per second", ("der(", ")")),
            false => ("position", "satisfies", "", ("", "")),
        };
        write!(
            f,
            "no {what} near the start {hold} the constraints and the equations of `start`: "
        )?;
        self.structure.write_constraint(f, row)?;
        let holonomic = self.structure.constraints.get(row);
        let per = match holonomic.is_some_and(|row| row.holonomic) {
            true => per,
            false => "",
        };
        write!(f, " is off by {error}{per}", error = Number(&error))?;
        advice(f, self.structure.coordinates, &self.conflicting, around)
    }
}

/// What to write instead.
pub(super) fn advice<const N: usize>(
    f: &mut Formatter<'_>,
    coordinates: &[Quantity],
    conflicting: &[bool; N],
    (before, after): (&str, &str),
) -> fmt::Result {
    if conflicting.iter().all(|x| !x) {
        return f.write_str("; check the parameters, or give guesses (`~`) that are nearer");
    }
    f.write_str("; these held values contradict each other or the parameters:")?;
    let mut separator = " ";
    for (i, _) in conflicting
        .iter()
        .enumerate()
        .filter(|(_, conflicts)| **conflicts)
    {
        let name = coordinates.get(i).map_or("?", |coordinate| coordinate.name);
        write!(f, "{separator}{before}{name}{after}")?;
        separator = ", ";
    }
    f.write_str("; turn one of them into a guess (`~`)")
}
