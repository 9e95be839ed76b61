//! Equations to straight-line programs.
//!
//! In:  a mechanism and its equations.
//! Out: [`Programs`], all that its module computes; each is made of expressions of the
//!      mechanism's graph and the slots they are wanted in by [`optimise`], and checked by
//!      [`verify`].
//!
//! The passes, in order; `RULES.md` has the identity and the domain of each rule:
//! 1. `ring`: each expression in the ring of the sines and cosines it has, where
//!    that is cheaper. Works on expressions.
//! 2. `schedule`: to a program, each shared expression once.
//! 3. `collect`, `share`: common factors of terms, and pairs of factors that products
//!    share.
//! 4. `distribute`: factors put into sums again where that is free.
//! 5. `signs`: changes of sign put into numbers.
//! 6. `dead`: what nobody reads.
//! 7. `order`: outputs of the same coordinates one after the other.
//!
//! `solve` appends the solve for the accelerations to a program; `constant` takes out what is
//! written once.

mod collect;
mod constant;
mod dead;
mod distribute;
mod functions;
mod order;
mod pass;
mod program;
mod programs;
mod ring;
mod schedule;
mod share;
mod signs;
mod solve;
mod wanted;

pub use constant::numbers_apart;
pub use functions::{Array, LeftOut, List, Optimised, Programs, StartPrograms};
pub use pass::{Pass, alone};
pub use program::{Cost, Operation, Program, Slot, Value, cost, interpret, verify};
pub use programs::{Besides, programs};
pub use ring::{Polynomials, in_trig_ring};
pub use solve::{Layout, Solved, Way};

use crate::expr::ExprId;
use crate::model::Graph;
use collect::Collected;

/// The most operations of a program that is still rewritten. Sharing factors looks at
/// all pairs again after each; of a longer program only factors are put into sums.
pub const REWRITTEN_MAX: usize = 30_000;

/// How many terms may be multiplied or added in the ring of sines and cosines: so many for
/// each operand of a program, and so many in addition. Every program of the library that
/// becomes shorter stays within this bound; in a long chain of angles the polynomials grow
/// with its length, save nothing, and would take most of the time.
const MULTIPLIED: (usize, usize) = (14, 20_000);

/// The weight from which on a program is multiplied out in the ring of sines and cosines only
/// where that made another one of the mechanism shorter. Of 378 descriptions one has a program
/// that would be shorter all the same, by two hundredths.
const LONG: usize = 2_000;

/// Pairs of factors are shared, which takes most of the time, where a rewritten program costs
/// up to so much more than the best one before that. Of 369 that cost more one was cheaper in
/// the end, by a hundredth.
const PROMISING: f64 = 1.1;

/// The program for the wanted expressions; `laws` are the default laws of the
/// inputs.
///
/// # Panics
///
/// If a pass leaves a program that breaks an invariant: a bug of this crate, with
/// the program in the message.
pub fn optimise(graph: &mut Graph, laws: &[ExprId], wanted: &[(Slot, ExprId)]) -> Program {
    optimise_among(graph, &mut Polynomials::default(), laws, wanted).program
}

/// As [`optimise`], with what is known of the graph from programs before; and what the program
/// would cost as it was derived, each shared expression computed once.
///
/// # Panics
///
/// As [`optimise`].
pub fn optimise_among(
    graph: &mut Graph,
    memory: &mut Polynomials,
    laws: &[ExprId],
    wanted: &[(Slot, ExprId)],
) -> Optimised {
    let scheduled = schedule::schedule(graph, laws, wanted);
    let finished = |best: &Program| {
        let rewritten = signs::into_numbers(&distribute::distribute(best));
        let program = checked(order::arranged(&rewritten));
        Optimised {
            cost: cost(&program),
            derived: cost(&scheduled),
            program,
        }
    };
    if scheduled.len() > REWRITTEN_MAX {
        return finished(&scheduled);
    }
    let collected = Collected::of(&scheduled);
    let best = collected.shared();
    let without = cost(&best).weight();
    if without > LONG && !memory.may_pay() {
        return finished(&best);
    }
    let operands: usize = scheduled.uses().iter().sum();
    let most = MULTIPLIED.0 * operands + MULTIPLIED.1;
    let mut ring = ring::Ring::new(graph, memory, most);
    let reduced: Option<Vec<(Slot, ExprId)>> = wanted
        .iter()
        .map(|(slot, e)| Some((*slot, ring.reduced(*e)?)))
        .collect();
    let Some(reduced) = reduced else {
        return finished(&best);
    };
    let best = with_reduced(graph, laws, [wanted, &reduced], (best, collected.weight));
    memory.observe(without, cost(&best).weight());
    finished(&best)
}

/// The best program with some arrays reduced: those with which it is cheaper. It is given
/// without any, and what that one cost before pairs were shared.
fn with_reduced(
    graph: &Graph,
    laws: &[ExprId],
    [wanted, reduced]: [&[(Slot, ExprId)]; 2],
    (mut best, mut weight): (Program, usize),
) -> Program {
    let mut arrays: Vec<&str> = wanted.iter().map(|(slot, _)| slot.array).collect();
    arrays.dedup();
    let mut chosen = wanted.to_vec();
    // Arrays share work, so each is judged by what the whole then costs.
    for array in arrays {
        let mut candidate = chosen.clone();
        for ((slot, e), (_, reduced)) in candidate.iter_mut().zip(reduced) {
            if slot.array == array {
                *e = *reduced;
            }
        }
        if candidate == chosen {
            continue;
        }
        let scheduled = schedule::schedule(graph, laws, &candidate);
        // Products of numbers that are finite may not be.
        if !scheduled.has_finite_numbers() {
            continue;
        }
        let collected = Collected::of(&scheduled);
        if collected.weight as f64 > PROMISING * weight as f64 {
            continue;
        }
        let program = collected.shared();
        if cost(&program).weight() < cost(&best).weight() {
            (chosen, best, weight) = (candidate, program, collected.weight);
        }
    }
    best
}

/// The program for the accelerations at regular states, from the program for `mass`, `force`,
/// `jacobian`, `bias`. `None` where it would divide by what is zero everywhere.
///
/// # Panics
///
/// As [`optimise`].
pub fn acceleration_solve(terms: &Program, layout: Layout) -> Option<Solved> {
    solve::with_acceleration(terms, layout).and_then(checked_solution)
}

/// The program for the least corrections of position and velocity, from the
/// program for `mass`, `jacobian`, `residual`, `speed`, `turn`; `None` where it would divide
/// by what is zero everywhere, or has numbers that are not finite.
///
/// # Panics
///
/// As [`optimise`].
pub fn correction_solve(terms: &Program, layout: Layout) -> Option<Solved> {
    solve::with_correction(terms, layout).and_then(checked_solution)
}

/// The program for the accelerations of so many coordinates, from the program for `mass` and
/// `force` with so many shared velocities in front of them, and `links`, what these are made
/// of; `None` where it would divide by what is zero everywhere, or has numbers that are not
/// finite.
///
/// # Panics
///
/// As [`optimise`].
pub fn shared_solve(terms: &Program, sizes: (usize, usize)) -> Option<Solved> {
    solve::with_shared(terms, sizes).and_then(checked_solution)
}

fn checked_solution(solved: Solved) -> Option<Solved> {
    if !solved.program.has_finite_numbers() {
        return None;
    }
    let program = checked(solved.program);
    Some(Solved { program, ..solved })
}

fn checked(program: Program) -> Program {
    if let Err(broken) = verify(&program) {
        panic!("internal error, please report: {broken} in\n{program}");
    }
    program
}

/// The program for expressions without rewriting: for defaults and the like, where
/// speed does not count.
pub fn plain(graph: &Graph, wanted: &[(Slot, ExprId)]) -> Program {
    schedule::schedule(graph, &[], wanted)
}
