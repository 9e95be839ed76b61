//! The programs of a module.
//!
//! In:  a mechanism and its equations.
//! Out: [`Programs`]: for each function of the module the program that it runs, with what
//!      it costs and what it would have cost as derived.
//!
//! The linearised equations and the Coriolis matrix are derived here, where they are known
//! to be wanted, after the programs that every module has: terms stand in the order in which
//! their expressions were made, so that what is asked for besides changes no other function.

use super::wanted::{Wanted, matrix, sparse, vector};
use super::{
    Cost, Polynomials, Program, Slot, Solved, cost, derived_cost, optimise_among, plain,
    regular_acceleration, regular_correction, shared_acceleration,
};
use crate::derive::{
    Equations, Linearised, Partials, Shared, StartRows, coriolis_matrix, differentiate, linearise,
    shared,
};
use crate::expr::{ExprId, Symbol};
use crate::model::{Mechanism, Shape};

/// The most operations of a linearisation: what rustc takes a few seconds for. Beyond
/// that implicit integrators take differences.
const LINEARISED_MAX: usize = 10_000;

/// The weight of a solve beyond which another with shared velocities as unknowns is tried.
/// A shorter one is of a few bodies, which have little in common.
const LONG_SOLVE: usize = 500;

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
    /// `mass`, `force`, `jacobian`, `bias`.
    pub terms: Optimised,
    /// The acceleration where the constraints are regular, if its factors exist.
    pub regular: Option<Solved>,
    /// `mass`, `residual`, `jacobian`, `drift`; nothing without constraints.
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
            ("terms", Some(&self.terms.program)),
            (
                "regular",
                self.regular.as_ref().map(|solved| &solved.program),
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

/// What is computed besides what every module has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Besides {
    /// The Coriolis matrix.
    pub coriolis_matrix: bool,
    /// How forces, outputs and events change.
    pub partials: bool,
}

/// The programs of a mechanism.
///
/// # Panics
///
/// As [`optimise`](super::optimise).
pub fn programs(mechanism: &mut Mechanism, equations: &Equations, besides: Besides) -> Programs {
    let laws = mechanism.inputs.iter().map(|input| input.law).collect();
    let mut optimiser = Optimiser {
        mechanism,
        equations,
        laws,
        polynomials: Polynomials::default(),
    };
    let (terms, regular) = optimiser.terms();
    let (position, correction) = optimiser.projection();
    let energy = optimiser.energy();
    let linearised = optimiser.linearised();
    let switches = optimiser.switches();
    let arrays = optimiser.arrays(besides.coriolis_matrix);
    let starts = [&equations.start_positions, &equations.start_velocities];
    let [start_positions, start_velocities] = [
        (starts[0], ["position_errors", "position_slopes"]),
        (starts[1], ["velocity_errors", "velocity_slopes"]),
    ]
    .map(|(rows, names)| optimiser.start_rows(rows, names));
    let wants_partials = besides.partials && linearised.is_ok();
    let regular = optimiser.shorter(regular);
    Programs {
        terms,
        regular,
        position,
        correction,
        energy,
        linearised,
        switches,
        arrays,
        start_positions,
        start_velocities,
        start: optimiser.start(),
        outputs: optimiser.outputs(),
        signals: optimiser.signals(),
        events: optimiser.events(),
        draw: optimiser.draw(),
        described: optimiser.described(),
        defaults: optimiser.defaults(),
        partials: wants_partials.then(|| optimiser.partials()).flatten(),
    }
}

/// A mechanism whose programs are being made, with what is known of its expressions.
struct Optimiser<'a> {
    mechanism: &'a mut Mechanism,
    equations: &'a Equations,
    laws: Vec<ExprId>,
    polynomials: Polynomials,
}

impl Optimiser<'_> {
    fn program(&mut self, wanted: &Wanted) -> Program {
        let graph = &mut self.mechanism.graph;
        optimise_among(graph, &mut self.polynomials, &self.laws, wanted)
    }

    fn optimised(&mut self, wanted: &Wanted) -> Optimised {
        let program = self.program(wanted);
        Optimised {
            cost: cost(&program),
            derived: derived_cost(&self.mechanism.graph, &self.laws, wanted),
            program,
        }
    }

    fn list(&mut self, array: &'static str, entries: &[ExprId]) -> List {
        List {
            count: entries.len(),
            computed: self.optimised(&vector(array, entries)),
        }
    }

    /// How many coordinates there are, and how many constraint rows.
    fn sizes(&self) -> (usize, usize) {
        (self.equations.mass.len(), self.equations.jacobian.len())
    }

    fn terms(&mut self) -> (Optimised, Option<Solved>) {
        let equations = self.equations;
        let terms = self.optimised(&merged([
            matrix("mass", &equations.mass),
            vector("force", &equations.force),
            matrix("jacobian", &equations.jacobian),
            vector("bias", &equations.bias),
        ]));
        let regular = regular_acceleration(&terms.program, self.sizes(), &equations.weighed);
        (terms, regular)
    }

    /// The solve, or the one with shared velocities as unknowns if that is shorter.
    fn shorter(&mut self, regular: Option<Solved>) -> Option<Solved> {
        let weight = |solved: &Solved| cost(&solved.program).weight();
        let longest = regular.as_ref().map_or(usize::MAX, weight);
        if longest <= LONG_SOLVE {
            return regular;
        }
        match self.with_shared() {
            Some(other) if weight(&other) < longest => Some(other),
            _ => regular,
        }
    }

    fn with_shared(&mut self) -> Option<Solved> {
        let Shared {
            count,
            mass,
            links,
            force,
        } = shared(self.mechanism, self.equations)?;
        let terms = self.program(&merged([
            sparse("mass", &mass),
            vector("force", &force),
            sparse("links", &links),
        ]));
        shared_acceleration(&terms, (force.len() - count, count))
    }

    fn projection(&mut self) -> (Option<Optimised>, Option<Solved>) {
        let equations = self.equations;
        if equations.jacobian.is_empty() {
            return (None, None);
        }
        let position = self.optimised(&merged([
            matrix("mass", &equations.mass),
            vector("residual", &equations.residual),
            matrix("jacobian", &equations.jacobian),
            vector("drift", &equations.drift),
        ]));
        let terms = self.program(&merged([
            matrix("mass", &equations.mass),
            matrix("jacobian", &equations.jacobian),
            vector("residual", &equations.residual),
            vector("speed", &equations.speed),
            matrix("turn", &equations.turn),
        ]));
        let correction = regular_correction(&terms, self.sizes(), &equations.weighed);
        (Some(position), correction)
    }

    fn energy(&mut self) -> Optimised {
        let energies = self.equations.energies;
        self.optimised(&vector(
            "energy",
            &[
                energies.kinetic,
                energies.potential,
                energies.balance,
                energies.power,
            ],
        ))
    }

    fn linearised(&mut self) -> Result<Optimised, LeftOut> {
        let Linearised {
            force_by_position,
            force_by_velocity,
            row_by_position,
            row_by_velocity,
        } = linearise(self.mechanism, self.equations).ok_or(LeftOut::Expressions)?;
        let linearised = self.optimised(&merged([
            matrix("force_by_position", &force_by_position),
            matrix("force_by_velocity", &force_by_velocity),
            matrix("row_by_position", &row_by_position),
            matrix("row_by_velocity", &row_by_velocity),
        ]));
        match linearised.program.len() {
            length if length > LINEARISED_MAX => Err(LeftOut::Operations(length)),
            _ => Ok(linearised),
        }
    }

    fn partials(&mut self) -> Option<Optimised> {
        let Partials {
            force_by_input,
            outputs,
            events,
        } = differentiate(self.mechanism, self.equations)?;
        let partials = self.optimised(&merged([
            vector("force_by_input", &force_by_input.concat()),
            vector("outputs", &outputs.concat()),
            vector("events", &events.concat()),
        ]));
        (partials.program.len() <= LINEARISED_MAX).then_some(partials)
    }

    fn switches(&mut self) -> Optimised {
        let switches = self.mechanism.switches.iter();
        let parts: Vec<ExprId> = switches.flat_map(|s| [s.value, s.rate]).collect();
        self.optimised(&vector("switches", &parts))
    }

    /// `C q̇` and `C` only where they are not zero, `C` if it is wanted.
    fn arrays(&mut self, coriolis: bool) -> Vec<(Array, Optimised)> {
        let equations = self.equations;
        let mut wanted = vec![
            (Array::Mass, matrix("", &equations.mass)),
            (Array::PotentialForce, vector("", &equations.gravity)),
            (Array::AppliedForce, vector("", &equations.applied)),
        ];
        let graph = &mut self.mechanism.graph;
        if equations.coriolis.iter().any(|e| !graph.is_zero(*e)) {
            wanted.push((Array::CoriolisForce, vector("", &equations.coriolis)));
        }
        if coriolis {
            let rows = coriolis_matrix(graph, &equations.mass);
            if rows.iter().flatten().any(|e| !graph.is_zero(*e)) {
                wanted.push((Array::CoriolisMatrix, matrix("", &rows)));
            }
        }
        if !equations.jacobian.is_empty() {
            wanted.extend([
                (Array::Residual, vector("", &equations.residual)),
                (Array::Jacobian, matrix("", &equations.jacobian)),
                (Array::Bias, vector("", &equations.bias)),
            ]);
        }
        let wanted = wanted.into_iter();
        wanted
            .map(|(array, wanted)| (array, self.optimised(&wanted)))
            .collect()
    }

    fn start_rows(&mut self, rows: &StartRows, names: [&'static str; 2]) -> StartPrograms {
        StartPrograms {
            errors: self.list(names[0], &rows.errors),
            slopes: self.list(names[1], &rows.slopes.concat()),
        }
    }

    fn start(&mut self) -> Optimised {
        let starts = self.mechanism.starts.iter();
        let values: Vec<ExprId> = starts.map(|start| start.value).collect();
        self.optimised(&vector("start", &values))
    }

    fn outputs(&mut self) -> Optimised {
        let wanted = self.chosen_outputs(false);
        self.optimised(&wanted)
    }

    fn signals(&mut self) -> Optimised {
        let inputs = (0..).map(Symbol::Input).take(self.mechanism.inputs.len());
        let inputs: Vec<ExprId> = inputs.map(|i| self.mechanism.graph.symbol(i)).collect();
        let outputs = self.chosen_outputs(true);
        self.optimised(&merged([outputs, vector("inputs", &inputs)]))
    }

    /// The outputs that are of accelerations, or those that are not.
    fn chosen_outputs(&self, accelerated: bool) -> Wanted {
        let outputs = self.mechanism.outputs.iter().enumerate();
        outputs
            .filter(|(_, output)| output.accelerated == accelerated)
            .map(|(row, output)| (Slot::of_vector("outputs", row), output.value))
            .collect()
    }

    fn events(&mut self) -> List {
        let events = self.mechanism.events.iter();
        let values: Vec<ExprId> = events.map(|event| event.value).collect();
        self.list("events", &values)
    }

    fn draw(&mut self) -> Optimised {
        let shapes = self.mechanism.shapes.iter();
        let numbers: Vec<ExprId> = shapes.flat_map(Shape::numbers).collect();
        self.optimised(&vector("draw", &numbers))
    }

    fn described(&mut self) -> Optimised {
        let declared = self.mechanism.described.iter();
        let parts: Vec<ExprId> = declared
            .flat_map(|c| [c.position, c.velocity, c.acceleration, c.reaction])
            .collect();
        self.optimised(&vector("described", &parts))
    }

    /// Of numbers alone, and evaluated once: nothing to rewrite.
    fn defaults(&self) -> Vec<Program> {
        let graph = &self.mechanism.graph;
        let parameters = self.mechanism.parameters.iter();
        parameters
            .map(|p| plain(graph, &vector("default", &[p.default])))
            .collect()
    }
}

fn merged<const N: usize>(arrays: [Wanted; N]) -> Wanted {
    arrays.concat()
}
