//! The mass matrix of long chains: its columns, from body to body, against what kinetic
//! energies say, and how long the code of such chains is.

use super::joint::{Case, OTHERS, of_joints, state};
use super::shared::{chain, difference, largest, of_length, of_rods};
use bricard_codegen::internals::expr::Symbol;
use bricard_codegen::internals::optimise::{Array, Besides, Program, interpret, programs};
use bricard_codegen::{CompileSettings, compile_source};

/// A chain whose last rod is held at its end, beside a state of the first order.
fn held() -> String {
    chain(
        "coord theta[N];
        state mean;
        let phi[i in 0..N] = if i == 0 then theta[0] else phi[i-1] + theta[i];
        der(mean) = end[N-1].x - mean;
        constraint end[N-1].y = -1;",
    )
}

/// Chains of many bodies, alone and in other company.
fn long_chains() -> Vec<String> {
    let others = OTHERS.map(String::from);
    [of_joints(), of_rods(), held()]
        .into_iter()
        .chain(others)
        .collect()
}

/// The kinetic energy with some velocities one, and all others zero.
fn kinetic(case: &Case, moving: &[usize]) -> f64 {
    let at = |symbol: Symbol| match symbol {
        Symbol::Velocity(i) if moving.contains(&(i as usize)) => 1.0,
        Symbol::Velocity(_) => 0.0,
        other => state(other),
    };
    let energies = case.equations.energies;
    case.mechanism.graph.evaluate(energies.kinetic, &at)
}

/// The second derivatives of the kinetic energy, a quadratic form; and one on the diagonal for
/// each state of the first order, of which no energy contains anything.
fn second_derivatives(case: &Case) -> Vec<Vec<f64>> {
    let (n, freedoms) = (case.equations.sizes().0, case.mechanism.freedoms());
    let alone: Vec<f64> = (0..n).map(|i| kinetic(case, &[i])).collect();
    let entry = |i: usize, j: usize| match i == j {
        true if i >= freedoms => 1.0,
        true => 2.0 * alone[i],
        false => kinetic(case, &[i, j]) - alone[i] - alone[j],
    };
    let row = |i| (0..n).map(|j| entry(i, j)).collect();
    (0..n).map(row).collect()
}

/// What resists a unit acceleration.
fn column(program: &Program, unit: usize, n: usize) -> Vec<f64> {
    let mut column = vec![0.0; n];
    let at = |symbol| match symbol {
        Symbol::Acceleration(i) if i as usize == unit => 1.0,
        Symbol::Acceleration(_) => 0.0,
        other => state(other),
    };
    for (slot, value) in interpret(program, &|symbol| Some(at(symbol))) {
        column[slot.row] = value;
    }
    column
}

#[test]
fn columns_from_body_to_body_are_second_derivatives_of_the_kinetic_energy() {
    for source in long_chains() {
        let mut case = Case::of(&source, &of_length(36));
        let exact = second_derivatives(&case);
        let inertia = case.programs().inertia.expect("a long chain");
        let scale = largest(&exact.concat());
        for (unit, exact) in exact.iter().enumerate() {
            let found = column(&inertia.program, unit, exact.len());
            let off = difference(&found, exact) / scale;
            assert!(off < 1e-13, "{source}: column {unit} is off by {off:e}");
        }
    }
}

#[test]
fn the_entries_of_a_mass_matrix_are_written_down_once_or_not_at_all() {
    let writes = |program: &Program| program.outputs.iter().any(|(slot, _)| slot.array == "mass");
    for (links, is_long) in [(6, false), (36, true)] {
        let programs = Case::of(&held(), &of_length(links)).programs();
        let position = programs.position.expect("it has a constraint");
        assert_eq!(programs.inertia.is_some(), is_long, "{links} links");
        for program in [&programs.terms.program, &position.program] {
            assert_eq!(writes(program), !is_long, "{links} links");
        }
    }
}

#[test]
fn the_entries_of_a_mass_matrix_are_derived_where_something_is_made_of_them() {
    let free = of_joints();
    let cases = [(&free, 6, true), (&free, 36, false), (&held(), 36, true)];
    for (source, links, wanted) in cases {
        let case = Case::of(source, &of_length(links));
        assert_eq!(
            case.equations.mass.is_some(),
            wanted,
            "{source}: {links} links"
        );
    }
}

#[test]
fn the_coriolis_matrix_of_a_long_chain_has_its_coriolis_forces() {
    let mut case = Case::of(&of_rods(), &of_length(36));
    let besides = Besides {
        coriolis_matrix: true,
        ..Besides::default()
    };
    let programs = programs(&mut case.mechanism, &case.equations, besides);
    let mut found = vec![0.0; 36];
    let mut scale = found.clone();
    let matrices = programs.arrays.iter();
    for (_, made) in matrices.filter(|(array, _)| *array == Array::CoriolisMatrix) {
        for (slot, value) in interpret(&made.program, &|symbol| Some(state(symbol))) {
            let term = value * state(Symbol::Velocity(slot.column as u32));
            found[slot.row] += term;
            scale[slot.row] += term.abs();
        }
    }
    let exact = case
        .mechanism
        .graph
        .evaluate_all(&case.equations.coriolis, &state);
    let off = difference(&found, &exact) / largest(&scale);
    assert!(largest(&exact) > 0.0 && off < 1e-13, "off by {off:e}");
}

#[test]
fn bodies_that_share_nothing_have_entries_and_no_columns() {
    let source = "mechanism Apart {
        const N = 40;
        coord x[N];
        for i in 0..N { kinetic der(x[i])^2*(1 + x[i]^2); }
    }";
    let programs = Case::of(source, &CompileSettings::default()).programs();
    assert!(programs.inertia.is_none());
}

#[test]
fn the_code_of_a_chain_grows_as_the_chain_does() {
    for source in [of_joints(), of_rods()] {
        let lines = |links| {
            let compiled = compile_source(&source, "chain", "chain.mech", &of_length(links));
            compiled.expect("it is compiled").code.lines().count()
        };
        let (short, long) = (lines(30), lines(90));
        assert!(10 * long <= 32 * short, "{short} and {long} lines");
    }
}

#[test]
fn equations_of_a_chain_grow_as_the_chain_does() {
    for source in [of_joints(), of_rods()] {
        let expressions = |links| Case::of(&source, &of_length(links)).mechanism.graph.len();
        let (short, long) = (expressions(40), expressions(320));
        assert!(10 * long <= 92 * short, "{short} and {long} expressions");
    }
}
