//! Solves with velocities that bodies share as unknowns of their own.
//!
//! In:  a program for `mass` and `jacobian` of these and of the coordinates, in this order,
//!      and for `force`.
//! Out: a program for the accelerations of the coordinates.
//!
//! The rows say what each shared velocity is: they are independent whatever the position,
//! and `M` is definite where the mass matrix of all unknowns is, since it is that matrix for
//! the motions that the rows allow. Pivots of shared velocities are not handed out, so that
//! there is such a program only where elimination leaves their masses as they are.

use super::{Factorised, Given, OPERATIONS_MAX, Solved, System, Way};
use crate::optimise::dead::ordered;
use crate::optimise::program::{Program, Slot, Value};

/// The accelerations of `n` coordinates, beside which `count` velocities are shared.
pub(in crate::optimise) fn with_shared(
    program: &Program,
    (n, count): (usize, usize),
) -> Option<Solved> {
    let given = Given {
        program,
        n: count + n,
        r: count,
        weighed: &[],
    };
    let mut system = System::of(&given, Way::Saddle, OPERATIONS_MAX)?;
    let mut force = vec![None; count];
    force.extend(system.take("force", n));
    let acceleration = system.solve(force, &vec![None; count]);
    let System {
        mut algebra,
        factorised: Factorised::Saddle(factors),
        ..
    } = system
    else {
        return None;
    };
    let (shared, own) = factors.mass_pivots().split_at(count);
    if shared.iter().any(|(pivot, whole)| pivot != whole) {
        return None;
    }
    let mut outputs: Vec<(Slot, Value)> = Vec::new();
    let mut write = |array, row, entry| {
        let slot = Slot::of_vector(array, row);
        outputs.extend(algebra.unsigned(entry).map(|value| (slot, value)));
    };
    for (row, entry) in acceleration[count..].iter().enumerate() {
        write("acceleration", row, *entry);
    }
    for (row, &(pivot, whole)) in own.iter().enumerate() {
        if pivot != whole {
            write("mass_pivots", row, Some(pivot));
            write("mass_diagonal", row, Some(whole));
        }
    }
    Some(Solved {
        program: ordered(algebra.program.list(), &outputs, &|value| value),
        way: Way::Shared,
    })
}
