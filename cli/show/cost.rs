//! What the generated programs cost.

use bricard_codegen::derive::{Equations, Matrix};
use bricard_codegen::expr::ExprId;
use bricard_codegen::model::Mechanism;
use bricard_codegen::optimise::{Slot, cost, optimise};

pub(super) type Wanted = Vec<(Slot, ExprId)>;

/// One line for each function that a simulation calls: the arrays that it
/// computes together, and its operations.
pub fn costs(mechanism: &mut Mechanism, equations: &Equations) -> String {
    let e = equations;
    let mut functions = vec![(
        if e.jacobian.is_empty() {
            "an acceleration (M, p1)"
        } else {
            "an acceleration (M, p1, G, p2)"
        },
        [
            matrix("M", &e.mass),
            vector("p1", &e.force),
            matrix("G", &e.jacobian),
            vector("p2", &e.bias),
        ]
        .concat(),
    )];
    if !e.jacobian.is_empty() {
        let arrays = [
            matrix("M", &e.mass),
            vector("g", &e.residual),
            matrix("G", &e.jacobian),
            vector("b", &e.drift),
        ];
        functions.push(("a projection (M, g, G, b)", arrays.concat()));
    }
    let energies = [
        e.energies.kinetic,
        e.energies.potential,
        e.energies.balance,
        e.energies.power,
    ];
    functions.push(("the energies", vector("energy", &energies)));
    let laws: Vec<ExprId> = mechanism.inputs.iter().map(|input| input.law).collect();
    let mut text = "operations\n".to_string();
    for (title, wanted) in functions {
        let program = optimise(&mut mechanism.graph, &laws, &wanted);
        text.push_str(&format!("{title}: {}\n", cost(&program)));
    }
    text
}

pub(super) fn vector(array: &'static str, entries: &[ExprId]) -> Wanted {
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

pub(super) fn matrix(array: &'static str, rows: &Matrix) -> Wanted {
    let entry = |(row, entries): (usize, &Vec<ExprId>)| {
        let slot = move |(column, &e): (usize, &ExprId)| (Slot { array, row, column }, e);
        entries.iter().enumerate().map(slot).collect::<Vec<_>>()
    };
    rows.iter().enumerate().flat_map(entry).collect()
}
