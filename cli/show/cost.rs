//! The programs of the functions that a simulation calls, and what they cost.

use bricard_codegen::internals::derive::{Equations, Matrix};
use bricard_codegen::internals::expr::ExprId;
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::optimise::{Program, Slot, cost, optimise};

type Wanted = Vec<(Slot, ExprId)>;

/// The programs, each of the arrays that one function computes together.
pub struct Programs {
    /// M and p₁, and where there are constraints G and p₂.
    pub acceleration: Program,
    /// M, g, G and b, if there are constraints.
    projection: Option<Program>,
    /// The energies and the power.
    pub energies: Program,
    /// The outputs.
    pub outputs: Program,
}

impl Programs {
    /// Those of a mechanism.
    pub fn of(mechanism: &mut Mechanism, equations: &Equations) -> Self {
        let e = equations;
        let laws: Vec<ExprId> = mechanism.inputs.iter().map(|input| input.law).collect();
        let outputs: Vec<ExprId> = mechanism.outputs.iter().map(|o| o.value).collect();
        let mut program = |wanted: &[Wanted]| {
            let wanted = wanted.concat();
            optimise(&mut mechanism.graph, &laws, &wanted)
        };
        let acceleration = program(&[
            matrix("mass", &e.mass),
            vector("force", &e.force),
            matrix("jacobian", &e.jacobian),
            vector("bias", &e.bias),
        ]);
        let projection = (!e.jacobian.is_empty()).then(|| {
            program(&[
                matrix("mass", &e.mass),
                vector("residual", &e.residual),
                matrix("jacobian", &e.jacobian),
                vector("drift", &e.drift),
            ])
        });
        let energies = [
            e.energies.kinetic,
            e.energies.potential,
            e.energies.balance,
            e.energies.power,
        ];
        Self {
            acceleration,
            projection,
            energies: program(&[vector("energy", &energies)]),
            outputs: program(&[vector("output", &outputs)]),
        }
    }

    /// One line for each function that a simulation calls: the arrays that it
    /// computes together, and its operations.
    pub fn costs(&self) -> String {
        let constrained = self.projection.is_some();
        let acceleration = match constrained {
            true => "an acceleration (M, p1, G, p2)",
            false => "an acceleration (M, p1)",
        };
        let mut text = "operations\n".to_string();
        for (title, program) in [
            (acceleration, Some(&self.acceleration)),
            ("a projection (M, g, G, b)", self.projection.as_ref()),
            ("the energies", Some(&self.energies)),
        ] {
            if let Some(program) = program {
                text.push_str(&format!("{title}: {}\n", cost(program)));
            }
        }
        text
    }
}

fn vector(array: &'static str, entries: &[ExprId]) -> Wanted {
    let slot = |(row, &e)| {
        (
            Slot {
                array,
                row,
                column: 0,
            },
            e,
        )
    };
    entries.iter().enumerate().map(slot).collect()
}

fn matrix(array: &'static str, rows: &Matrix) -> Wanted {
    let entry = |(row, entries): (usize, &Vec<ExprId>)| {
        let slot = move |(column, &e): (usize, &ExprId)| (Slot { array, row, column }, e);
        entries.iter().enumerate().map(slot).collect::<Vec<_>>()
    };
    rows.iter().enumerate().flat_map(entry).collect()
}
