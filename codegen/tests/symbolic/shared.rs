//! Long chains: equations derived in one sweep, and solves from body to body, against those
//! derived symbol by symbol and dense elimination.

use super::solve::dense;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{derive, mass_matrix};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::optimise::{Besides, Programs, Way, cost, interpret, programs};
use bricard_codegen::{CompileSettings, compile_source};

/// Rods that hang from one another, with all positions in the world, for coordinates and how
/// the angles `phi[i]` of the rods follow from them.
pub(super) fn chain(coordinates: &str) -> String {
    format!(
        "mechanism Chain {{
            const N = 4;
            const L = 0.5;
            param m = 2;
            {coordinates}
            let rod[i in 0..N] = L*[sin(phi[i]), -cos(phi[i])];
            let end[i in 0..N] = if i == 0 then rod[0] else end[i-1] + rod[i];
            for i in 0..N {{
                let c = end[i] - rod[i]/2;
                kinetic m/2*norm2(der(c)) + m*L^2/24*der(phi[i])^2;
                potential 9.81*m*c.y;
                dissipation 0.1*der(phi[i])^2;
            }}
            force [1, 0.3] on end[N-1];
        }}"
    )
}

/// The chain in the angles of the rods.
pub(super) fn of_rods() -> String {
    chain("coord phi[N];")
}

pub(super) fn state(symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Coordinate(i) => 0.4 + (f64::from(i) * 0.37).sin(),
        Symbol::Velocity(i) => (f64::from(i) * 1.13).cos(),
        Symbol::Parameter(_) => 1.7,
        _ => unreachable!("it has no {symbol:?}"),
    }
}

pub(super) fn of_length(links: u32) -> CompileSettings {
    let mut settings = CompileSettings::default();
    settings.constants = vec![("N".to_string(), f64::from(links))];
    settings
}

/// The programs of a chain; its accelerations by the emitted solve, by dense elimination, and
/// by equations in closed form.
fn accelerations(links: u32) -> (Programs, [Vec<f64>; 3]) {
    let (mut mechanism, _) = analyse(&of_rods(), &of_length(links)).expect("it is right");
    let equations = derive(&mut mechanism).expect("equations of a usual length");
    let rows = mass_matrix(&mut mechanism, &equations);
    let graph = &mechanism.graph;
    let value = |e: &ExprId| graph.evaluate(*e, &state);
    let mass = rows
        .iter()
        .map(|row| row.iter().map(value).collect())
        .collect();
    let force: Vec<f64> = equations.force.iter().map(value).collect();
    let (eliminated, _) = dense(&mass, &force);
    let programs = programs(&mut mechanism, &equations, Besides::default());
    let regular = programs.acceleration.as_ref().expect("a solve");
    let mut found = vec![0.0; links as usize];
    for (slot, value) in interpret(&regular.program, &|symbol| Some(state(symbol))) {
        if slot.array == "acceleration" {
            found[slot.row] = value;
        }
    }
    (programs, [found, eliminated, exact(links as usize)])
}

/// Accelerations of the chain from its mass matrix in closed form: `m L² cos(φ_i − φ_j)` times
/// the number of rods that both move, one that both move by its middle counting half.
pub(super) fn exact(n: usize) -> Vec<f64> {
    let (m, length) = (state(Symbol::Parameter(0)), 0.5);
    let phi: Vec<f64> = (0..n as u32)
        .map(|i| state(Symbol::Coordinate(i)))
        .collect();
    let rate: Vec<f64> = (0..n as u32).map(|i| state(Symbol::Velocity(i))).collect();
    // How many rods a rod moves with its end, and half of itself.
    let beyond = |i: usize| (n - 1 - i) as f64;
    let coupling = |i: usize, j: usize| match i == j {
        true => beyond(i) + 1.0 / 4.0,
        false => beyond(i.max(j)) + 1.0 / 2.0,
    };
    let mut mass = vec![vec![0.0; n]; n];
    let mut force = vec![0.0; n];
    for i in 0..n {
        for j in 0..n {
            let share = m * length * length * coupling(i, j);
            mass[i][j] = share * (phi[i] - phi[j]).cos();
            force[i] -= share * (phi[i] - phi[j]).sin() * rate[j] * rate[j];
        }
        mass[i][i] += m * length * length / 12.0;
        force[i] -= 9.81 * m * length * (beyond(i) + 0.5) * phi[i].sin();
        force[i] -= 0.2 * rate[i];
        force[i] += length * (phi[i].cos() + 0.3 * phi[i].sin());
    }
    dense(&mass, &force).0
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| most.max(x.abs()))
}

pub(super) fn difference(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

#[test]
fn a_long_chain_is_solved_from_body_to_body_and_a_short_one_is_not() {
    for (links, way) in [(4, Way::Schur), (30, Way::Shared), (60, Way::Shared)] {
        let (programs, [found, eliminated, exact]) = accelerations(links);
        let solved = programs.acceleration.expect("a solve");
        assert_eq!(solved.way, way, "{links} links");
        let bound = 1e-11 * largest(&exact);
        let (one, other) = (difference(&found, &exact), difference(&eliminated, &exact));
        assert!(one < bound, "{links} links: the solve is off by {one:e}");
        assert!(
            other < bound,
            "{links} links: the terms are off by {other:e}"
        );
    }
}

#[test]
fn what_an_acceleration_takes_grows_as_the_chain_does() {
    let weight = |links| {
        cost(
            &accelerations(links)
                .0
                .acceleration
                .expect("a solve")
                .program,
        )
        .weight()
    };
    let (short, long) = (weight(30), weight(60));
    assert!(long < 9 * short / 4, "{short} and {long} operations");
}

#[test]
fn a_hundred_links_in_angles_of_the_links_are_compiled() {
    let compiled = compile_source(&of_rods(), "chain", "chain.mech", &of_length(100));
    let compiled = compiled.unwrap_or_else(|errors| panic!("{}", errors.render("", &of_rods())));
    assert!(compiled.code.contains("fn acceleration("));
    let lines = compiled.code.lines().count();
    assert!(lines < 40_000, "{lines} lines");
}

#[test]
fn long_functions_declare_names_many_at_a_time() {
    // rustc describes the scope of each `let` for the debugger within the one before, by
    // recursion, and runs out of stack at less than 3000.
    const LETS: usize = 1200;
    let compiled = compile_source(&of_rods(), "chain", "chain.mech", &of_length(50));
    let code = compiled.expect("it is compiled").code;
    let code = code.replace("        pub fn ", "        fn ");
    let functions: Vec<&str> = code.split("\n        fn ").collect();
    let assigned = |line: &&str| line.trim_start().starts_with("sum");
    assert!(
        functions
            .iter()
            .any(|f| f.lines().filter(assigned).count() > LETS)
    );
    for function in functions {
        let lets = function
            .lines()
            .filter(|line| line.trim_start().starts_with("let "));
        assert!(
            lets.count() < LETS,
            "{}",
            function.lines().next().unwrap_or_default()
        );
    }
}
