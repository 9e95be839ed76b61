//! Elimination from body to body, for random trees of bodies.

use super::description::{Manner, any, state};
use super::{Case, agree, config, dot, size};
use crate::symbolic::joint::from_body_to_body;
use bricard_codegen::internals::optimise::interpret;
use proptest::prelude::*;

proptest! {
    #![proptest_config(config())]

    #[test]
    fn elimination_from_body_to_body_solves_the_equations(random in any(), (q, v) in state()) {
        let mut tree = random;
        tree.loops.clear();
        let mut case = Case::new(&tree.text(Manner::PLAIN), q, v)?;
        let Some(program) = from_body_to_body(&mut case.mechanism, &case.equations) else {
            return Ok(());
        };
        let mut found = vec![0.0; tree.n()];
        for (slot, value) in interpret(&program, &|symbol| Some(case.symbol(symbol))) {
            if slot.array == "acceleration" {
                found[slot.row] = value;
            }
        }
        let force = case.vector(&case.equations.force);
        for (row, force) in case.matrix(case.mass()).iter().zip(force) {
            agree("M q̈", dot(row, &found), force, size(row, &found))?;
        }
    }
}
