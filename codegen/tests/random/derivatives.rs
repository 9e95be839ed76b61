//! Symbolic derivatives against dual numbers, which share nothing with their rules.

use super::description::{Manner, any, state};
use super::{Case, agree, config};
use crate::dual::evaluate;
use bricard_codegen::internals::expr::{ExprId, Symbol};
use num_dual::Dual64;
use proptest::prelude::*;

fn by_duals(case: &Case, e: ExprId, by: Symbol) -> f64 {
    let value = |symbol: Symbol| match symbol == by {
        true => Dual64::from_re(case.symbol(symbol)).derivative(),
        false => Dual64::from_re(case.symbol(symbol)),
    };
    evaluate(&case.mechanism.graph, e, &value).eps
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn derivatives_are_those_of_dual_numbers(random in any(), (q, v) in state()) {
        let mut case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let equations = case.equations.clone();
        let energies = equations.energies;
        let mut expressions = vec![energies.kinetic, energies.potential];
        expressions.extend(equations.force.iter().chain(&equations.bias).chain(&equations.residual));
        for e in expressions {
            for i in 0..random.n() {
                for symbol in [Symbol::Coordinate(i as u32), Symbol::Velocity(i as u32)] {
                    let derivative = case.mechanism.graph.differentiate(e, symbol);
                    let duals = by_duals(&case, e, symbol);
                    agree("∂", case.value(derivative), duals, 100.0)?;
                }
            }
        }
    }

    #[test]
    fn the_constraint_matrix_is_the_derivative_by_dual_numbers(random in any(), (q, v) in state()) {
        let case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let equations = &case.equations;
        for (row, residual) in equations.jacobian.iter().zip(&equations.residual) {
            for (j, entry) in row.iter().enumerate() {
                let duals = by_duals(&case, *residual, Symbol::Coordinate(j as u32));
                agree("A", case.value(*entry), duals, 10.0)?;
            }
        }
    }
}
