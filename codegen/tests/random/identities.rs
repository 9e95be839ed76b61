//! Identities of the equations of motion.

use super::description::{Manner, any, state};
use super::{Case, agree, config, dot, size};
use bricard_codegen::internals::derive::coriolis_matrix;
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::optimise::{Slot, interpret, optimise};
use proptest::prelude::*;

/// The half width of central differences.
const HALF: f64 = 1e-5;
/// What they may be off, relative to the size of what is differentiated.
const DIFFERENCES: f64 = 1e-7;

fn times(matrix: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

/// The rate of expressions along `q̇` with `q̇` held, by central differences.
fn rates(case: &mut Case, expressions: &[ExprId]) -> Vec<f64> {
    let (q, v) = (case.q.clone(), case.v.clone());
    let mut at = |h: f64| {
        case.q = q.iter().zip(&v).map(|(q, v)| q + h * v).collect();
        case.vector(expressions)
    };
    let (after, before) = (at(HALF), at(-HALF));
    case.q = q;
    let rate = |(a, b): (&f64, &f64)| (a - b) / (2.0 * HALF);
    after.iter().zip(&before).map(rate).collect()
}

fn near(what: &str, found: f64, differences: f64, size: f64) -> Result<(), TestCaseError> {
    let bound = DIFFERENCES * (1.0 + size + differences.abs());
    prop_assert!(
        (found - differences).abs() <= bound,
        "{what}: {found:e}, differences {differences:e}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn kinetic_energy_is_half_of_mass_times_velocities(random in any(), (q, v) in state()) {
        let case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let v = &case.v[..random.n()];
        let momenta = times(&case.matrix(case.mass()), v);
        let kinetic = case.value(case.equations.energies.kinetic);
        agree("T", dot(v, &momenta) / 2.0, kinetic, size(v, &momenta))?;
        prop_assert!(kinetic >= 0.0);
    }

    #[test]
    fn the_rate_of_mass_less_twice_coriolis_is_skew(random in any(), (q, v) in state()) {
        let mut case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let n = random.n();
        let mass = case.mass().to_vec();
        let coriolis = coriolis_matrix(&mut case.mechanism.graph, &mass);
        let c = case.matrix(&coriolis);
        let largest = c.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let product = times(&c, &case.v[..n]);
        for (i, exact) in case.vector(&case.equations.coriolis).into_iter().enumerate() {
            agree("C q̇", product[i], exact, size(&c[i], &case.v))?;
        }
        for i in 0..n {
            let slopes = rates(&mut case, &mass[i]);
            for j in 0..n {
                near("Ṁ − C − Cᵀ", c[i][j] + c[j][i], slopes[j], largest)?;
            }
        }
    }

    #[test]
    fn the_power_of_inertia_and_forces_is_the_rate_of_energy(
        random in any(), (q, v) in state(), a in proptest::collection::vec(-2.0..2.0_f64, 4),
    ) {
        let mut case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let n = random.n();
        let energies = case.equations.energies;
        let total = case.mechanism.graph.sum([energies.kinetic, energies.potential]);
        let mut rate = 0.0;
        for (i, a) in a.iter().enumerate().take(n) {
            let by_q = case.mechanism.graph.differentiate(total, Symbol::Coordinate(i as u32));
            let by_v = case.mechanism.graph.differentiate(total, Symbol::Velocity(i as u32));
            rate += case.value(by_q) * case.v[i] + case.value(by_v) * a;
        }
        let inertia = times(&case.matrix(case.mass()), &a[..n]);
        let force = case.vector(&case.equations.force);
        let v = &case.v[..n];
        let scale = size(v, &inertia) + size(v, &force);
        agree("q̇·(M q̈ − p₁)", dot(v, &inertia) - dot(v, &force), rate, scale)?;
    }

    #[test]
    fn constraint_rows_are_rates_of_constraints(random in any(), (q, v) in state()) {
        let mut case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let n = random.n();
        let equations = case.equations.clone();
        let speed = case.vector(&equations.speed);
        let change = rates(&mut case, &equations.residual);
        let bend = rates(&mut case, &equations.speed);
        for (i, row) in case.matrix(&equations.jacobian).iter().enumerate() {
            let scale = size(row, &case.v);
            agree("A q̇", dot(row, &case.v[..n]), speed[i], scale)?;
            near("ġ", speed[i], change[i], scale)?;
        }
        for (i, bias) in case.vector(&equations.bias).into_iter().enumerate() {
            near("−p₂", -bias, bend[i], speed[i].abs())?;
        }
    }

    #[test]
    fn programs_have_the_values_of_their_expressions(random in any(), (q, v) in state()) {
        let mut case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let equations = case.equations.clone();
        let arrays = [
            ("force", vec![equations.force]),
            ("bias", vec![equations.bias]),
            ("residual", vec![equations.residual]),
            ("mass", case.mass().to_vec()),
            ("jacobian", equations.jacobian),
        ];
        let mut wanted = Vec::new();
        for (array, rows) in &arrays {
            for (row, entries) in rows.iter().enumerate() {
                for (column, e) in entries.iter().enumerate() {
                    wanted.push((Slot { array, row, column }, *e));
                }
            }
        }
        let program = optimise(&mut case.mechanism.graph, &[], &wanted);
        let found = interpret(&program, &|symbol| Some(case.symbol(symbol)));
        for (slot, e) in wanted {
            let value = found.iter().find(|(place, _)| *place == slot).map_or(0.0, |(_, x)| *x);
            let same = arrays.iter().filter(|(array, _)| *array == slot.array);
            let all: Vec<ExprId> = same.flat_map(|(_, rows)| rows.concat()).collect();
            let largest = case.vector(&all).into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            agree(slot.array, value, case.value(e), largest)?;
        }
    }
}
