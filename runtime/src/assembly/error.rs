//! Why no consistent initial state could be found.
//!
//! Out: [`AssemblyError`].

use super::fault::{StartFault, advice};
use crate::number::Number;
use crate::{Real, Structure};
use core::fmt::{Display, Formatter, Result};
use nalgebra::SVector;

/// Why no consistent initial state could be found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AssemblyError<T, const N: usize, const R: usize> {
    /// A value of the start, or a constraint at the guess, is infinite or NaN.
    NotFinite {
        /// Time of the start (s).
        t: T,
    },
    /// No position near the guesses satisfies the constraints.
    Positions {
        /// The mechanism, for the names.
        structure: &'static Structure,
        /// The error of each constraint equation where it came closest, in the
        /// unit of the equation; zero where it is satisfied.
        residual: SVector<T, R>,
        /// Which held coordinates stand in the way.
        conflicting: [bool; N],
    },
    /// No velocity satisfies the constraints at the assembled position.
    Velocities {
        /// The mechanism, for the names.
        structure: &'static Structure,
        /// The error of each constraint equation at velocity level where it came
        /// closest, in the unit of the equation per second; zero where it is
        /// satisfied.
        residual: SVector<T, R>,
        /// Which held velocities stand in the way.
        conflicting: [bool; N],
    },
    /// The assembled position is singular, and no branch through it has the held
    /// velocities.
    NoBranch {
        /// The mechanism, for the names.
        structure: &'static Structure,
        /// Which velocities are held.
        held: [bool; N],
    },
    /// The assembled position is singular, several branches through it have the held
    /// velocities, and the guesses are equally near to them.
    ManyBranches {
        /// The mechanism, for the names.
        structure: &'static Structure,
        /// A coordinate whose velocity tells them apart.
        coordinate: usize,
        /// Its velocity on one of them (its unit per second).
        velocity: T,
    },
    /// A constraint has no gradient where it holds, and one sign around.
    Vanishing {
        /// The mechanism, for the names.
        structure: &'static Structure,
        /// The constraint equation.
        row: usize,
    },
    /// Equations of the `start` block don't hold.
    Start(StartFault<T, N>),
    /// The mechanism can move with a negative kinetic energy.
    NegativeInertia {
        /// Time of the start (s).
        t: T,
        /// The mechanism, for the names.
        structure: &'static Structure,
        /// The coordinate whose motion has it.
        coordinate: usize,
    },
}

impl<T: Real, const N: usize, const R: usize> Display for AssemblyError<T, N, R> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::NotFinite { t } => not_finite(f, *t),
            Self::Positions {
                structure,
                residual,
                conflicting,
            } => contradiction(f, structure, residual.as_slice(), (conflicting, false)),
            Self::Velocities {
                structure,
                residual,
                conflicting,
            } => contradiction(f, structure, residual.as_slice(), (conflicting, true)),
            Self::NoBranch { structure, held } => {
                f.write_str(match held.contains(&true) {
                    true => {
                        "the start is a singular position, and no branch of the motion through \
                         it has the held velocities"
                    }
                    false => {
                        "constraints depend on one another at the start, and no motion from there \
                         satisfies all of them"
                    }
                })?;
                advice(f, structure.coordinates, held, true)
            }
            Self::ManyBranches {
                structure,
                coordinate,
                velocity,
            } => many_branches(f, structure, (*coordinate, *velocity)),
            Self::Vanishing { structure, row } => vanishing(f, structure, *row),
            Self::Start(fault) => fault.fmt(f),
            Self::NegativeInertia {
                t,
                structure,
                coordinate,
            } => negative_inertia(f, *t, structure, *coordinate),
        }
    }
}

fn not_finite<T: Real>(f: &mut Formatter<'_>, t: T) -> Result {
    write!(
        f,
        "the start at t = {t} s, or a constraint or the mass matrix there, is infinite or NaN; \
         check the values in `start` and the parameters",
        t = Number(&t)
    )
}

/// Writes which held values contradict the constraints: positions, or velocities.
fn contradiction<T: Real>(
    f: &mut Formatter<'_>,
    structure: &Structure,
    residual: &[T],
    (conflicting, velocities): (&[bool], bool),
) -> Result {
    let (what, per) = match velocities {
        true => ("velocities near the start satisfy", " per second"),
        false => ("position near the start satisfies", ""),
    };
    write!(f, "no {what} the constraints:")?;
    rows(f, structure, residual, per)?;
    advice(f, structure.coordinates, conflicting, velocities)
}

fn many_branches<T: Real>(
    f: &mut Formatter<'_>,
    structure: &Structure,
    (coordinate, velocity): (usize, T),
) -> Result {
    let name = structure.coordinates.get(coordinate);
    let name = name.map_or("?", |coordinate| coordinate.name);
    // A guess needs few digits.
    let velocity = velocity.to_f64() as f32;
    write!(
        f,
        "the start is a singular position, and several branches of the motion through it have \
         the held velocities; choose one by a guess (`~`) of a velocity, for example \
         `der({name}) ~ {velocity}`",
        velocity = Number(&velocity)
    )
}

fn negative_inertia<T: Real>(
    f: &mut Formatter<'_>,
    t: T,
    structure: &Structure,
    coordinate: usize,
) -> Result {
    write!(
        f,
        "at t = {t} s the kinetic energy is negative where ",
        t = Number(&t)
    )?;
    structure.write_coordinate(f, coordinate)?;
    f.write_str(
        " moves; check the signs of masses and moments of inertia among the parameters, and of \
         the terms of `kinetic`",
    )
}

fn vanishing(f: &mut Formatter<'_>, structure: &Structure, row: usize) -> Result {
    f.write_str("at the start ")?;
    structure.write_constraint(f, row)?;
    f.write_str(
        " has a gradient that vanishes where it holds, and can't be followed from there; if it \
         says that a square is zero, write what is squared; else check the parameters",
    )
}

/// Residuals below this part of the largest are not worth telling.
const HARMLESS: f64 = 1e-6;

/// One clause per constraint equation that is not satisfied.
fn rows<T: Real>(
    f: &mut Formatter<'_>,
    structure: &Structure,
    residual: &[T],
    per: &str,
) -> Result {
    let worst = residual
        .iter()
        .fold(T::zero(), |worst, x| worst.max(x.abs()));
    let mut separator = " ";
    for (i, error) in residual.iter().enumerate() {
        if error.abs() <= worst * T::from_f64(HARMLESS) {
            continue;
        }
        f.write_str(separator)?;
        structure.write_constraint(f, i)?;
        write!(f, " is off by {error}{per}", error = Number(error))?;
        separator = ", ";
    }
    Ok(())
}

impl<T: Real, const N: usize, const R: usize> core::error::Error for AssemblyError<T, N, R> {}
