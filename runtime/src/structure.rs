//! What was known about a mechanism when its code was generated.
//!
//! In:  names, units, documentation, equations as the description writes them.
//! Out: [`Structure`], which messages and columns are made from.

/// A named quantity of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// The name as the description writes it: `q1`, `theta[0]`.
    pub name: &'static str,
    /// The unit as written, empty if none was given.
    pub unit: &'static str,
    /// The doc comment, empty if there is none.
    pub docs: &'static str,
}

impl Quantity {
    /// Whether its unit is that of an angle, or not given.
    pub(crate) fn may_be_angle(&self) -> bool {
        matches!(self.unit, "rad" | "deg" | "")
    }
}

/// One constraint equation (one row of `A`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConstraintRow {
    /// The equation as the description writes it, with its component if it is a
    /// row of a vector equation.
    pub text: &'static str,
    /// The line of the description.
    pub line: u32,
    /// Holonomic rows restrict positions; velocity constraints do not.
    pub holonomic: bool,
}

/// The multiplier `λ` of a row of a constraint that has a name, `r = Aᵀλ`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Multiplier {
    /// The name of its column, `reaction(pin)` or, for a row of a vector equation,
    /// `reaction(pin).x`; its unit, empty if it is not known.
    pub quantity: Quantity,
    /// The row of `A`.
    pub row: usize,
}

/// A coordinate as the description declares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Declared {
    /// Name, unit, docs.
    pub quantity: Quantity,
    /// The constraint that gives it explicitly, if it was eliminated; else it is one of
    /// the coordinates of the state.
    pub given_by: Option<ConstraintRow>,
}

/// An event and the direction that counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// Its name.
    pub name: &'static str,
    /// Which sign changes count.
    pub direction: Direction,
}

/// Which sign changes of an event function count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
    /// Both.
    Crossing,
}

/// What was known about a mechanism when its code was generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Structure {
    /// The name after `mechanism`.
    pub name: &'static str,
    /// Its doc comment.
    pub docs: &'static str,
    /// The description's file, as it was given to the generator.
    pub file: &'static str,
    /// Generalized coordinates, in the order of `q`.
    pub coordinates: &'static [Quantity],
    /// How many of the coordinates, the last ones, are integrals of states of the first
    /// order: the velocity of such a coordinate is the state of its name, its acceleration
    /// the rate of the state. It takes part in no energy.
    pub states: usize,
    /// All coordinates that the description declares, where constraints gave some of them
    /// and they were eliminated; empty where all are in `coordinates`.
    pub described: &'static [Declared],
    /// Run-time parameters.
    pub parameters: &'static [Quantity],
    /// External signals.
    pub inputs: &'static [Quantity],
    /// Observables.
    pub outputs: &'static [Quantity],
    /// Some output is one of accelerations.
    pub accelerated: bool,
    /// Events.
    pub events: &'static [Event],
    /// Constraint equations, in the order of the rows of `A`.
    pub constraints: &'static [ConstraintRow],
    /// The multipliers of constraints that have a name, in the order of the rows of `A`.
    pub multipliers: &'static [Multiplier],
    /// `M` depends on neither `t` nor `q`.
    pub constant_mass: bool,
    /// `balance` is conserved: no dissipation, applied force, input, or explicit
    /// time anywhere.
    pub conservative: bool,
    /// The description draws something.
    pub drawn: bool,
    /// The constraints were declared to be regular: a run ends with an error at a
    /// singular configuration.
    pub regular: bool,
    /// The rows of `A` that take part in the metric, `M + AᵀWA`, because `M` alone is
    /// singular at all positions.
    pub weighed: &'static [usize],
}

impl Structure {
    /// A structure that says nothing: what a mechanism written by hand begins with.
    pub const PLAIN: Self = Self {
        name: "",
        docs: "",
        file: "",
        coordinates: &[],
        states: 0,
        described: &[],
        parameters: &[],
        inputs: &[],
        outputs: &[],
        accelerated: false,
        events: &[],
        constraints: &[],
        multipliers: &[],
        constant_mass: false,
        conservative: false,
        drawn: false,
        regular: false,
        weighed: &[],
    };
}

impl Structure {
    /// The coordinates that the description declares as such.
    pub fn freedoms(&self) -> &'static [Quantity] {
        let count = self.coordinates.len().saturating_sub(self.states);
        &self.coordinates[..count]
    }

    /// Writes a coordinate as the description names it.
    pub(crate) fn write_coordinate(
        &self,
        f: &mut core::fmt::Formatter<'_>,
        index: usize,
    ) -> core::fmt::Result {
        match self.coordinates.get(index) {
            Some(coordinate) => write!(f, "`{}`", coordinate.name),
            None => write!(f, "{index}"),
        }
    }

    /// Writes a constraint equation as it stands in the description, with its line.
    pub(crate) fn write_constraint(
        &self,
        f: &mut core::fmt::Formatter<'_>,
        row: usize,
    ) -> core::fmt::Result {
        match self.constraints.get(row) {
            Some(equation) => write!(f, "`{}` (line {})", equation.text, equation.line),
            None => write!(f, "{row}"),
        }
    }

    /// Writes how many of the constraint equations are independent, and which they are
    /// if they are few.
    pub(crate) fn write_rank(
        &self,
        f: &mut core::fmt::Formatter<'_>,
        rank: usize,
    ) -> core::fmt::Result {
        const FEW: usize = 4;
        let rows = self.constraints.len();
        let verb = if rank == 1 { "is" } else { "are" };
        write!(
            f,
            "only {rank} of the {rows} constraint equations {verb} independent"
        )?;
        if rows <= FEW {
            for row in 0..rows {
                f.write_str(if row == 0 { ": " } else { ", " })?;
                self.write_constraint(f, row)?;
            }
        }
        Ok(())
    }
}
