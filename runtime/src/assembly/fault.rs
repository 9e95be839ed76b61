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
            return not_finite(f, self.t);
        };
        let left = (row, error, self.velocities);
        contradiction(f, self.structure, left, &self.conflicting)
    }
}

fn not_finite<T: Real>(f: &mut Formatter<'_>, t: T) -> fmt::Result {
    write!(
        f,
        "an equation of `start`, or a constraint or the mass matrix, is infinite or NaN at \
         t = {t} s; check the values in `start` and the parameters",
        t = Number(&t)
    )
}

/// Writes which held values contradict the constraints: positions, or velocities.
fn contradiction<T: Real>(
    f: &mut Formatter<'_>,
    structure: &Structure,
    (row, error, velocities): (usize, T, bool),
    conflicting: &[bool],
) -> fmt::Result {
    let (what, hold) = match velocities {
        true => ("velocities", "satisfy"),
        false => ("position", "satisfies"),
    };
    write!(
        f,
        "no {what} near the start {hold} the constraints and the equations of `start`: "
    )?;
    structure.write_constraint(f, row)?;
    let row = structure.constraints.get(row);
    let per = match velocities && row.is_some_and(|row| row.holonomic) {
        true => " per second",
        false => "",
    };
    write!(f, " is off by {error}{per}", error = Number(&error))?;
    advice(f, structure.coordinates, conflicting, velocities)
}

/// What to write instead.
pub(super) fn advice(
    f: &mut Formatter<'_>,
    coordinates: &[Quantity],
    conflicting: &[bool],
    velocities: bool,
) -> fmt::Result {
    if conflicting.iter().all(|x| !x) {
        return f.write_str("; check the parameters, or give guesses (`~`) that are nearer");
    }
    f.write_str("; these held values contradict each other or the parameters:")?;
    let (before, after) = if velocities { ("der(", ")") } else { ("", "") };
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
