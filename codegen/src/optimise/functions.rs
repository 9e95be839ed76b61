//! The programs of a module, as data.
//!
//! Out: [`Programs`], and what it is made of; `programs` makes them.

use super::{Cost, Program, Solved};

/// A program and what was saved.
#[derive(Clone, Debug, Default)]
pub struct Optimised {
    /// The program.
    pub program: Program,
    /// What it costs.
    pub cost: Cost,
    /// What it would cost as it was derived.
    pub derived: Cost,
}

/// Why a module has no linearised equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// Deriving them takes more expressions than a function should have.
    Expressions,
    /// Their program has this many operations, more than a function should have.
    Operations(usize),
    /// Some of their numbers are not finite.
    Infinite,
}

/// An array that has a function of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Array {
    /// `M`, `N × N`.
    Mass,
    /// `h`, `N`.
    PotentialForce,
    /// `Q`, `N`.
    AppliedForce,
    /// `C q̇` and the terms of moving frames, `N`.
    CoriolisForce,
    /// `C`, `N × N`.
    CoriolisMatrix,
    /// `g`, `R`.
    Residual,
    /// `A`, `R × N`.
    Jacobian,
    /// `p₂`, `R`.
    Bias,
}

impl Array {
    /// The name of its function.
    pub fn name(self) -> &'static str {
        match self {
            Array::Mass => "mass_matrix",
            Array::PotentialForce => "potential_force",
            Array::AppliedForce => "applied_force",
            Array::CoriolisForce => "coriolis_force",
            Array::CoriolisMatrix => "coriolis_matrix",
            Array::Residual => "constraint_residual",
            Array::Jacobian => "constraint_jacobian",
            Array::Bias => "constraint_bias",
        }
    }
}

/// Values that a function writes one after the other.
#[derive(Clone, Debug, Default)]
pub struct List {
    /// How many.
    pub count: usize,
    /// Their program; its one array has the name of the function.
    pub computed: Optimised,
}

/// Equations of the start at a place, and their derivatives.
#[derive(Clone, Debug, Default)]
pub struct StartPrograms {
    /// What the equations are off by.
    pub errors: List,
    /// Their derivatives, row by row.
    pub slopes: List,
}

/// What a module of a mechanism computes.
#[derive(Clone, Debug)]
pub struct Programs {
    /// `mass`: `M q̈`, where `M` is computed of it column by column.
    pub inertia: Option<Optimised>,
    /// `mass`, unless there is `inertia`, `force`, `jacobian`, `bias`.
    pub terms: Optimised,
    /// The acceleration where the constraints are regular, if its factors exist.
    pub acceleration: Option<Solved>,
    /// `mass`, unless there is `inertia`, `residual`, `jacobian`, `drift`; nothing without
    /// constraints.
    pub position: Option<Optimised>,
    /// The corrections of position and velocity where the constraints are regular, if there
    /// are any and their factors exist.
    pub correction: Option<Solved>,
    /// `energy`: kinetic, potential, balance, power.
    pub energy: Optimised,
    /// The linearised equations of motion, or why they are left out.
    pub linearised: Result<Optimised, LeftOut>,
    /// `force_by_input`, `outputs`, `events`: their derivatives, each row by row. Nothing
    /// where they are not wanted, would be too long, or the linearised equations are left
    /// out.
    pub partials: Option<Optimised>,
    /// `switches`: value and rate of each switching function.
    pub switches: Optimised,
    /// Arrays for those who want them one by one. Their slots have no array's name.
    pub arrays: Vec<(Array, Optimised)>,
    /// Equations of the start for positions.
    pub start_positions: StartPrograms,
    /// Equations of the start for velocities.
    pub start_velocities: StartPrograms,
    /// `start`: the entries of the `start` block.
    pub start: Optimised,
    /// `outputs`: those of positions and velocities.
    pub outputs: Optimised,
    /// `outputs` of accelerations, and all `inputs`.
    pub signals: Optimised,
    /// `events`.
    pub events: List,
    /// `draw`: the numbers of the picture, shape by shape.
    pub draw: Optimised,
    /// `described`: position, velocity, acceleration and reaction of each coordinate that
    /// was declared, where some were eliminated.
    pub described: Optimised,
    /// `default`: one program for each default of a parameter.
    pub defaults: Vec<Program>,
}

impl Programs {
    /// Those that compute something, each with the name of its function.
    pub fn named(&self) -> Vec<(&'static str, &Program)> {
        let starts = [&self.start_positions, &self.start_velocities];
        let [positions, velocities] = starts.map(|rows| [&rows.errors, &rows.slopes]);
        let arrays = self.arrays.iter();
        let all = [
            ("inertia", self.inertia.as_ref().map(|made| &made.program)),
            ("terms", Some(&self.terms.program)),
            (
                "acceleration",
                self.acceleration.as_ref().map(|solved| &solved.program),
            ),
            ("position", self.position.as_ref().map(|made| &made.program)),
            (
                "correction",
                self.correction.as_ref().map(|solved| &solved.program),
            ),
            ("energy", Some(&self.energy.program)),
            (
                "linearised",
                self.linearised.as_ref().ok().map(|made| &made.program),
            ),
            ("partials", self.partials.as_ref().map(|made| &made.program)),
            ("switches", Some(&self.switches.program)),
            ("position_errors", Some(&positions[0].computed.program)),
            ("position_slopes", Some(&positions[1].computed.program)),
            ("velocity_errors", Some(&velocities[0].computed.program)),
            ("velocity_slopes", Some(&velocities[1].computed.program)),
            ("start", Some(&self.start.program)),
            ("outputs", Some(&self.outputs.program)),
            ("signals", Some(&self.signals.program)),
            ("events", Some(&self.events.computed.program)),
            ("draw", Some(&self.draw.program)),
            ("described", Some(&self.described.program)),
        ];
        let arrays = arrays.map(|(array, made)| (array.name(), Some(&made.program)));
        let all = all.into_iter().chain(arrays);
        all.filter_map(|(name, program)| Some((name, program?)))
            .filter(|(_, program)| !program.outputs.is_empty())
            .collect()
    }
}
