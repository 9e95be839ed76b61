//! What can go wrong at run time: when, what, and what to try.
//!
//! Out: one enum per stage, with data and a message for people.

use crate::number::Number;
use crate::{Condition, Form, Real, Structure};
use core::fmt::{Display, Formatter, Result};

/// Kinds of singular configurations in which a motion ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Singularity {
    /// The sheets of the constraint set cannot be told apart by the digits there are: they
    /// nearly touch, or a gap keeps them apart that is not much more than round-off.
    Unresolved,
    /// The sheet ends or turns faster than steps can follow, or the motion left it.
    Turning,
    /// Sheets touch without crossing, or more than two meet.
    Touching,
    /// The motion has drifted off the constraints, too far to tell the sheets that cross apart:
    /// nothing kept it there, or not closely enough.
    Drifted,
    /// At rest, or next to it, nothing tells which of the sheets that cross is meant.
    Undetermined,
    /// The gradient of a constraint vanishes wherever it holds.
    Vanishing,
    /// The gradient of a constraint jumps, and with it the velocities that it allows.
    Kink,
}

impl Singularity {
    /// What became of a constraint there, one of several or the only one.
    fn loss(self, is_only: bool) -> &'static str {
        match (self, is_only) {
            (Self::Unresolved | Self::Turning | Self::Drifted, true) => {
                "has a gradient that nearly vanishes, "
            }
            (Self::Unresolved | Self::Turning | Self::Drifted, false) => {
                "nearly depends on the others, "
            }
            (Self::Touching | Self::Undetermined, true) => "has a gradient that vanishes, ",
            (Self::Touching | Self::Undetermined, false) => "depends on the others, ",
            (Self::Vanishing, _) => "has a gradient that vanishes ",
            (Self::Kink, _) => "has a kink, ",
        }
    }

    /// What follows for the motion, and what to try.
    fn consequence(self) -> &'static str {
        match self {
            Self::Unresolved => {
                "and the branches of motion that meet there can't be told apart by the digits of \
                 the numbers; if a length was meant to be exactly that of another, write both by \
                 one parameter"
            }
            Self::Turning => {
                "and the branch of motion ends, or turns faster than steps can follow; check that \
                 what is prescribed can be reached, or take a smaller tolerance or step"
            }
            Self::Touching => {
                "and branches of motion touch there, so that the way on can't be told; describe \
                 the branch that is meant by constraints of its own"
            }
            Self::Drifted => {
                "and the motion has drifted too far off the constraints to tell on which branch it \
                 goes on; keep it there by projection, or take larger gains or a smaller tolerance"
            }
            Self::Vanishing => {
                "not only here but wherever it holds, so that it restricts no motion; if it says \
                 that a square is zero, write what is squared; else check the parameters"
            }
            Self::Kink => {
                "as a length has where it becomes zero: the velocities that it allows jump, and no \
                 smooth motion goes on; end the run before, or describe by an event what happens \
                 there"
            }
            Self::Undetermined => {
                "and nothing tells which of the branches of motion that cross there is meant; \
                 begin next to this configuration, or with a velocity"
            }
        }
    }
}

/// What is watched along a motion and not needed to compute it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Watched {
    /// The kinetic energy.
    KineticEnergy,
    /// The potential energy.
    PotentialEnergy,
    /// The power that is supplied.
    Power,
    /// The errors of the constraints.
    ConstraintError,
    /// The function of an event, by name.
    Event(&'static str),
    /// A side of a condition, as the description writes it.
    Condition(&'static str),
}

impl Display for Watched {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::KineticEnergy => f.write_str("the kinetic energy"),
            Self::PotentialEnergy => f.write_str("the potential energy"),
            Self::Power => f.write_str("the power that is supplied"),
            Self::ConstraintError => f.write_str("the error of a constraint"),
            Self::Event(name) => write!(f, "the function of the event `{name}`"),
            Self::Condition(text) => write!(f, "what is compared in `{text}`"),
        }
    }
}

/// Why an acceleration or a projection could not be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum DynamicsError<T> {
    /// A state, a term of the equations or the result is infinite or NaN.
    NotFinite {
        /// Time of the state (s).
        t: T,
    },
    /// The motion is finite so far, but a quantity that is watched is infinite or NaN.
    WatchedNotFinite {
        /// Time of the state (s).
        t: T,
        /// The quantity.
        quantity: Watched,
    },
    /// The form of the equations has no solution here: the rows of the
    /// constraint Jacobian are dependent, or nearly so.
    SingularPosition {
        /// Time of the state (s).
        t: T,
        /// The form that was asked for.
        form: Form,
        /// How many rows of the Jacobian are independent here.
        rank: usize,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
    /// A singular configuration that the motion cannot be followed through.
    SingularConfiguration {
        /// Time of the state (s).
        t: T,
        /// Of which kind it is.
        kind: Singularity,
        /// A row (constraint equation) that nearly depends on the others there.
        row: usize,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
    /// Constraints that were declared to be regular are not.
    NotRegular {
        /// Time of the state (s).
        t: T,
        /// How many rows of the Jacobian are independent here.
        rank: usize,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
    /// The mass matrix is singular in a direction that no constraint restricts,
    /// or negative.
    MassSingular {
        /// Time of the state (s).
        t: T,
        /// The coordinate at which the factorisation failed.
        coordinate: usize,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
    /// Constraints depend on one another, so that nothing tells how they share their
    /// reactions.
    SharedReaction {
        /// Time of the state (s).
        t: T,
        /// A row (constraint equation) whose multiplier is not determined.
        row: usize,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
    /// A condition of the forces changes again and again without time going on.
    Sticks {
        /// Time of the state (s).
        t: T,
        /// The condition.
        condition: &'static Condition,
    },
    /// An angle has made so many turns that its round-off leaves less than half of the digits.
    AngleTooLarge {
        /// Time of the state (s).
        t: T,
        /// The angle, a coordinate.
        coordinate: usize,
        /// Its value (rad).
        value: T,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
    /// The state could not be brought back onto the constraints.
    ProjectionFailed {
        /// Time of the state (s).
        t: T,
        /// The largest remaining constraint error, in the unit of its row.
        residual: T,
        /// The row (constraint equation) that has it.
        row: usize,
        /// The mechanism, for the names.
        structure: &'static Structure,
    },
}

impl<T: Real> DynamicsError<T> {
    /// The time at which it happened (s).
    pub fn time(&self) -> T {
        match *self {
            Self::NotFinite { t }
            | Self::WatchedNotFinite { t, .. }
            | Self::SingularPosition { t, .. }
            | Self::SingularConfiguration { t, .. }
            | Self::NotRegular { t, .. }
            | Self::MassSingular { t, .. }
            | Self::SharedReaction { t, .. }
            | Self::Sticks { t, .. }
            | Self::AngleTooLarge { t, .. }
            | Self::ProjectionFailed { t, .. } => t,
        }
    }
}

impl<T: Real> Display for DynamicsError<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::NotFinite { t } => write!(
                f,
                "at t = {t} s the equations of motion gave a number that is infinite or NaN; \
                 look for a force or an input that grows without bound, or take a smaller step",
                t = Number(t)
            ),
            Self::WatchedNotFinite { t, quantity } => write!(
                f,
                "at t = {t} s {quantity} is infinite or NaN; look for the root or the logarithm \
                 of a negative number, or a division by zero, in what it is made of",
                t = Number(t)
            ),
            Self::SingularPosition {
                t,
                form,
                rank,
                structure,
            } => write_unpassed(f, t, *form, (*rank, structure)),
            Self::SingularConfiguration {
                t,
                kind,
                row,
                structure,
            } => write_singular(f, t, *kind, (*row, structure)),
            Self::NotRegular { t, rank, structure } => {
                write!(f, "at t = {t} s ", t = Number(t))?;
                structure.write_rank(f, *rank)?;
                f.write_str(
                    ", though the mechanism was declared to be regular; generate it without that \
                     declaration",
                )
            }
            Self::MassSingular {
                t,
                coordinate,
                structure,
            } => write_massless(f, t, (*coordinate, structure)),
            Self::SharedReaction { t, row, structure } => write_shared(f, t, (*row, structure)),
            Self::Sticks { t, condition } => write_sticking(f, t, condition),
            Self::AngleTooLarge {
                t,
                coordinate,
                value,
                structure,
            } => write_turns(f, t, value, (*coordinate, structure)),
            Self::ProjectionFailed {
                t,
                residual,
                row,
                structure,
            } => write_off(f, t, residual, (*row, structure)),
        }
    }
}

/// Which form of the equations cannot go on.
fn write_unpassed<T: Real>(
    f: &mut Formatter<'_>,
    t: &T,
    form: Form,
    (rank, structure): (usize, &Structure),
) -> Result {
    write!(f, "at t = {t} s ", t = Number(t))?;
    structure.write_rank(f, rank)?;
    write!(
        f,
        ", and the form `{form}` cannot pass a singular position; use the form `reduced` or `full`"
    )
}

/// Which condition gets nowhere.
fn write_sticking<T: Real>(f: &mut Formatter<'_>, t: &T, condition: &Condition) -> Result {
    write!(
        f,
        "at t = {t} s the condition `{text}` (line {line}) changes again and again without time \
         going on; write a force that rises steeply instead of jumping, such as `tanh(x/d)` for \
         `sign(x)`",
        t = Number(t),
        text = condition.text,
        line = condition.line
    )
}

/// Which constraint can't be satisfied.
fn write_off<T: Real>(
    f: &mut Formatter<'_>,
    t: &T,
    residual: &T,
    (row, structure): (usize, &Structure),
) -> Result {
    write!(f, "at t = {t} s the constraint ", t = Number(t))?;
    structure.write_constraint(f, row)?;
    write!(
        f,
        " is violated by {residual} and the state could not be brought back onto it; take a \
         smaller step, or check that the constraints can be satisfied together",
        residual = Number(residual)
    )
}

/// Which coordinate can move without kinetic energy.
fn write_massless<T: Real>(
    f: &mut Formatter<'_>,
    t: &T,
    (coordinate, structure): (usize, &Structure),
) -> Result {
    write!(f, "at t = {t} s the coordinate ", t = Number(t))?;
    structure.write_coordinate(f, coordinate)?;
    f.write_str(
        " can move without kinetic energy and no constraint restricts it; give it inertia or a \
         constraint",
    )
}

/// Which angle has made too many turns.
fn write_turns<T: Real>(
    f: &mut Formatter<'_>,
    t: &T,
    value: &T,
    (coordinate, structure): (usize, &Structure),
) -> Result {
    write!(f, "at t = {t} s the angle ", t = Number(t))?;
    structure.write_coordinate(f, coordinate)?;
    write!(
        f,
        " is {value} rad, and round-off leaves less than half of the digits of a turn; begin \
         without the whole turns, multiples of 2*pi",
        value = Number(value)
    )
}

/// Which constraint shares its reaction.
fn write_shared<T: Real>(
    f: &mut Formatter<'_>,
    t: &T,
    (row, structure): (usize, &Structure),
) -> Result {
    write!(f, "at t = {t} s the constraint ", t = Number(t))?;
    structure.write_constraint(f, row)?;
    f.write_str(match structure.constraints.len() {
        1 => {
            " has a gradient that vanishes, and its multiplier is not determined; ask for the \
             reactions at coordinates, `reactions`, which are"
        }
        _ => {
            " depends on the others, and how they share their reactions is not determined; ask \
             for the reactions at coordinates, `reactions`, which are, or leave out the \
             constraints that follow from others"
        }
    })
}

/// Which constraint is concerned, and what is the matter with it.
fn write_singular<T: Real>(
    f: &mut Formatter<'_>,
    t: &T,
    kind: Singularity,
    (row, structure): (usize, &Structure),
) -> Result {
    write!(f, "at t = {t} s the constraint ", t = Number(t))?;
    structure.write_constraint(f, row)?;
    f.write_str(" ")?;
    f.write_str(kind.loss(structure.constraints.len() == 1))?;
    f.write_str(kind.consequence())
}

impl<T: Real> core::error::Error for DynamicsError<T> {}
