//! The programs of a module.
//!
//! In:  a mechanism and its equations.
//! Out: [`Programs`]: for each function of the module the program that it runs, with what
//!      it costs and what it would have cost as derived.
//!
//! The linearised equations and the Coriolis matrix are derived here, where they are known
//! to be wanted, after the programs that every module has: terms stand in the order in which
//! their expressions were made, so that what is asked for besides changes no other function.

use super::functions::{Array, LeftOut, List, Optimised, Programs, StartPrograms};
use super::wanted::{Wanted, matrix, sparse, vector};
use super::{
    Layout, Polynomials, Program, Slot, Solved, Way, acceleration_solve, correction_solve, cost,
    optimise_among, plain, shared_solve,
};
use crate::derive::{
    Equations, Linearisation, Partials, Shared, StartRows, coriolis_matrix, differentiate,
    linearise, mass_matrix, shared,
};
use crate::expr::ExprId;
use crate::model::{Mechanism, Shape, Symbol};

/// The most operations of a linearisation: what rustc takes a few seconds for. Beyond
/// that implicit integrators take differences.
const LINEARISED_MAX: usize = 10_000;

/// The weight of a solve beyond which another with shared velocities as unknowns is tried.
/// A shorter one is of a few bodies, which have little in common.
const LONG_SOLVE: usize = 500;

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
    let inertia = optimiser.inertia();
    let (terms, acceleration) = optimiser.terms();
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
    let acceleration = optimiser.shorter(acceleration);
    Programs {
        inertia,
        terms,
        acceleration,
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
    fn optimised(&mut self, wanted: &Wanted) -> Optimised {
        let graph = &mut self.mechanism.graph;
        optimise_among(graph, &mut self.polynomials, &self.laws, wanted)
    }

    fn program(&mut self, wanted: &Wanted) -> Program {
        self.optimised(wanted).program
    }

    fn has_finite_numbers(&self, wanted: &Wanted) -> bool {
        let roots: Vec<ExprId> = wanted.iter().map(|(_, e)| *e).collect();
        self.mechanism.graph.has_finite_numbers(&roots)
    }

    fn list(&mut self, array: &'static str, entries: &[ExprId]) -> List {
        List {
            count: entries.len(),
            computed: self.optimised(&vector(array, entries)),
        }
    }

    /// `M q̈`, where `M` is not written down.
    fn inertia(&mut self) -> Option<Optimised> {
        let inertia = self.equations.inertia.as_ref()?;
        Some(self.optimised(&vector("mass", inertia)))
    }

    /// The entries of `M`, where they are derived.
    fn mass(&self) -> Wanted {
        let entries = self.equations.mass.as_ref();
        entries.map_or_else(Wanted::new, |mass| matrix("mass", mass))
    }

    /// The entries of `M`, where they are written down: not where `M q̈` is.
    fn written_mass(&self) -> Wanted {
        match self.equations.inertia {
            Some(_) => Wanted::new(),
            None => self.mass(),
        }
    }

    fn terms(&mut self) -> (Optimised, Option<Solved>) {
        let equations = self.equations;
        let vectors = || {
            merged([
                vector("force", &equations.force),
                matrix("jacobian", &equations.jacobian),
                vector("bias", &equations.bias),
            ])
        };
        let terms = self.optimised(&merged([self.written_mass(), vectors()]));
        let layout = layout(equations);
        if equations.inertia.is_none() {
            let acceleration = acceleration_solve(&terms.program, layout);
            return (terms, acceleration);
        }
        let of_entries = |optimiser: &mut Self| {
            equations.mass.as_ref()?;
            let whole = merged([optimiser.mass(), vectors()]);
            acceleration_solve(&optimiser.program(&whole), layout)
        };
        let acceleration = self.with_shared().or_else(|| of_entries(self));
        (terms, acceleration)
    }

    /// The solve, or the one with shared velocities as unknowns if that is shorter.
    fn shorter(&mut self, acceleration: Option<Solved>) -> Option<Solved> {
        let weight = |solved: &Solved| cost(&solved.program).weight();
        let longest = acceleration.as_ref().map_or(usize::MAX, weight);
        let is_shared = acceleration
            .as_ref()
            .is_some_and(|solved| solved.way == Way::Shared);
        if is_shared || longest <= LONG_SOLVE {
            return acceleration;
        }
        match self.with_shared() {
            Some(other) if weight(&other) < longest => Some(other),
            _ => acceleration,
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
        shared_solve(&terms, (force.len() - count, count))
    }

    fn projection(&mut self) -> (Option<Optimised>, Option<Solved>) {
        let equations = self.equations;
        if equations.jacobian.is_empty() {
            return (None, None);
        }
        let position = self.optimised(&merged([
            self.written_mass(),
            vector("residual", &equations.residual),
            matrix("jacobian", &equations.jacobian),
            vector("drift", &equations.drift),
        ]));
        let terms = self.program(&merged([
            self.mass(),
            matrix("jacobian", &equations.jacobian),
            vector("residual", &equations.residual),
            vector("speed", &equations.speed),
            matrix("turn", &equations.turn),
        ]));
        let correction = correction_solve(&terms, layout(equations));
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
        let Linearisation {
            force_by_position,
            force_by_velocity,
            row_by_position,
            row_by_velocity,
        } = linearise(self.mechanism, self.equations).ok_or(LeftOut::Expressions)?;
        let wanted = merged([
            matrix("force_by_position", &force_by_position),
            matrix("force_by_velocity", &force_by_velocity),
            matrix("row_by_position", &row_by_position),
            matrix("row_by_velocity", &row_by_velocity),
        ]);
        if !self.has_finite_numbers(&wanted) {
            return Err(LeftOut::Infinite);
        }
        let linearised = self.optimised(&wanted);
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
        let wanted = merged([
            vector("force_by_input", &force_by_input.concat()),
            vector("outputs", &outputs.concat()),
            vector("events", &events.concat()),
        ]);
        if !self.has_finite_numbers(&wanted) {
            return None;
        }
        let partials = self.optimised(&wanted);
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
            (Array::PotentialForce, vector("", &equations.gravity)),
            (Array::AppliedForce, vector("", &equations.applied)),
        ];
        if let (None, Some(mass)) = (&equations.inertia, &equations.mass) {
            wanted.insert(0, (Array::Mass, matrix("", mass)));
        }
        let graph = &mut self.mechanism.graph;
        if equations.coriolis.iter().any(|e| !graph.is_zero(*e)) {
            wanted.push((Array::CoriolisForce, vector("", &equations.coriolis)));
        }
        if coriolis {
            let mass = mass_matrix(self.mechanism, equations);
            let graph = &mut self.mechanism.graph;
            let rows = coriolis_matrix(graph, &mass);
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

/// How many equations are solved, and which of them are not like the others.
fn layout(equations: &Equations) -> Layout<'_> {
    let (n, r) = equations.sizes();
    Layout {
        n,
        r,
        weighed: &equations.weighed,
        redundant: &equations.redundant,
    }
}
