//! The passes one by one, so that each can be checked by itself.

use super::program::{Program, Slot};
use super::{collect, distribute, in_trig_ring, schedule, share, signs};
use crate::expr::ExprId;
use crate::model::Graph;

/// A rewriting that keeps the value of every output. `RULES.md` has a section for
/// each, with its identities and their domains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Expressions as polynomials in the sines and cosines they have.
    Ring,
    /// Expressions to a program.
    Schedule,
    /// Common factors taken out of sums.
    Collect,
    /// Pairs of factors shared between products.
    Share,
    /// Factors put into sums.
    Distribute,
    /// Changes of sign put into numbers.
    Signs,
}

impl Pass {
    /// All passes, in the order they run in.
    pub const ALL: [Pass; 6] = [
        Pass::Ring,
        Pass::Schedule,
        Pass::Collect,
        Pass::Share,
        Pass::Distribute,
        Pass::Signs,
    ];

    /// Its name in `RULES.md`.
    pub fn name(self) -> &'static str {
        match self {
            Pass::Ring => "ring",
            Pass::Schedule => "schedule",
            Pass::Collect => "collect",
            Pass::Share => "share",
            Pass::Distribute => "distribute",
            Pass::Signs => "signs",
        }
    }
}

/// The program that one pass alone makes of the wanted expressions, whether it is
/// cheaper or not; `laws` are the default laws of the inputs.
pub fn alone(pass: Pass, graph: &mut Graph, laws: &[ExprId], wanted: &[(Slot, ExprId)]) -> Program {
    let mut wanted = wanted.to_vec();
    if pass == Pass::Ring {
        for (_, e) in &mut wanted {
            *e = in_trig_ring(graph, *e);
        }
    }
    let program = schedule::schedule(graph, laws, &wanted);
    match pass {
        Pass::Ring | Pass::Schedule => program,
        Pass::Collect => collect::collect_factors(&program).unwrap_or(program),
        Pass::Share => share::share_pairs(&program),
        Pass::Distribute => distribute::distribute(&program),
        Pass::Signs => signs::into_numbers(&program),
    }
}
