//! Chains in joint angles: accelerations, energies and lengths against the same chains in
//! angles of the links, and solves from body to body against dense elimination.

use super::shared::{chain, difference, exact, largest, of_length, state as of_link};
use super::solve::dense;
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{Equations, Shared, derive, mass_matrix, shared};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::optimise::{
    Besides, Program, Programs, Slot, Way, interpret, optimise, programs, shared_solve,
};

/// The chain in angles between neighbours.
pub(super) fn of_joints() -> String {
    chain(
        "coord theta[N];
        let phi[i in 0..N] = if i == 0 then theta[0] else phi[i-1] + theta[i];",
    )
}

/// Bodies in other company: masses without inertia at the ends of rods, whose own velocities
/// have no mass in the shared ones; a trolley with gears, springs and motors in the joints;
/// a chain that forks.
pub(super) const OTHERS: [&str; 3] = [
    "mechanism Points {
        const N = 7;
        coord phi[N];
        param m = 2;
        let end[i in 0..N] = [sin(phi[i]), -cos(phi[i])]
            + (if i == 0 then [0, 0] else end[i-1]);
        for i in 0..N { kinetic m/2*norm2(der(end[i])); potential m*end[i].y; }
    }",
    "mechanism Trolley {
        const N = 6;
        coord x;
        coord theta[N];
        param m = 2;
        let phi[i in 0..N] = if i == 0 then 0.5*theta[0] else phi[i-1] - 3*theta[i];
        let rod[i in 0..N] = [sin(phi[i]), -cos(phi[i])];
        let end[i in 0..N] = rod[i] + (if i == 0 then [x, 0] else end[i-1]);
        kinetic m*der(x)^2;
        for i in 0..N {
            let c = end[i] - rod[i]/2;
            kinetic m/2*norm2(der(c)) + m/24*der(phi[i])^2;
            potential m*c.y + 2*theta[i]^2;
            dissipation 0.3*der(theta[i])^2;
            force 0.2*cos(x) on theta[i];
        }
        force [der(x), 1] on end[2];
    }",
    "mechanism Fork {
        const N = 5;
        coord trunk[3];
        coord left[N];
        coord right[N];
        param m = 2;
        let stem = trunk[0] + trunk[1];
        let top = [cos(trunk[0]), sin(trunk[0])] + [cos(stem), sin(stem)] + [trunk[2], 0];
        let a[i in 0..N] = left[i] + (if i == 0 then stem else a[i-1]);
        let b[i in 0..N] = right[i] + (if i == 0 then stem else b[i-1]);
        let p[i in 0..N] = [cos(a[i]), sin(a[i])] + (if i == 0 then top else p[i-1]);
        let r[i in 0..N] = [cos(b[i]), sin(b[i])] + (if i == 0 then top else r[i-1]);
        kinetic m*norm2(der(top)) + der(stem)^2 + der(trunk[0])^2;
        for i in 0..N {
            kinetic m/2*norm2(der(p[i])) + m/2*norm2(der(r[i])) + der(a[i])^2;
            potential m*p[i].y*r[i].y;
        }
    }",
];

/// Six links in space, each velocity in the frame of its body.
const IN_SPACE: &str = include_str!("../../../benches/instructions/mechanisms/spatial_chain.mech");

/// Joint angles in which the links have the angles of the other chain.
pub(super) fn state(symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Coordinate(i) if i > 0 => of_link(symbol) - of_link(Symbol::Coordinate(i - 1)),
        Symbol::Velocity(i) if i > 0 => of_link(symbol) - of_link(Symbol::Velocity(i - 1)),
        _ => of_link(symbol),
    }
}

/// A mechanism and its equations, at one state.
pub(super) struct Case {
    pub(super) mechanism: Mechanism,
    pub(super) equations: Equations,
}

impl Case {
    pub(super) fn of(source: &str, settings: &CompileSettings) -> Self {
        let (mut mechanism, _) = analyse(source, settings).expect("it is right");
        let equations = derive(&mut mechanism).expect("equations of a usual length");
        Self {
            mechanism,
            equations,
        }
    }

    fn values(&self, entries: &[ExprId]) -> Vec<f64> {
        self.mechanism.graph.evaluate_all(entries, &state)
    }

    fn mass(&self) -> Vec<Vec<f64>> {
        let mut mechanism = self.mechanism.clone();
        let rows = mass_matrix(&mut mechanism, &self.equations);
        let values = |row: &Vec<ExprId>| mechanism.graph.evaluate_all(row, &state);
        rows.iter().map(values).collect()
    }

    fn eliminated(&self) -> Vec<f64> {
        dense(&self.mass(), &self.values(&self.equations.force)).0
    }

    pub(super) fn programs(&mut self) -> Programs {
        programs(&mut self.mechanism, &self.equations, Besides::default())
    }
}

/// The program from body to body, whether it is the shortest or not; none where bodies share
/// no velocities.
pub(crate) fn from_body_to_body(
    mechanism: &mut Mechanism,
    equations: &Equations,
) -> Option<Program> {
    let Shared {
        count,
        mass,
        links,
        force,
    } = shared(mechanism, equations)?;
    let entries = |array, entries: &[(usize, usize, ExprId)]| -> Vec<(Slot, ExprId)> {
        let slot = |&(row, column, e)| (Slot { array, row, column }, e);
        entries.iter().map(slot).collect()
    };
    let vector: Vec<_> = (0..).zip(&force).map(|(row, e)| (row, 0, *e)).collect();
    let wanted = [
        entries("mass", &mass),
        entries("links", &links),
        entries("force", &vector),
    ]
    .concat();
    let program = optimise(&mut mechanism.graph, &[], &wanted);
    let solved = shared_solve(&program, (force.len() - count, count));
    Some(solved.expect("a solve").program)
}

/// A vector that a program computes.
fn computed(program: &Program, array: &str, n: usize) -> Vec<f64> {
    let mut found = vec![0.0; n];
    for (slot, value) in interpret(program, &|symbol| Some(state(symbol))) {
        if slot.array == array {
            found[slot.row] = value;
        }
    }
    found
}

fn joint_accelerations(links: usize) -> Vec<f64> {
    let phi = exact(links);
    let before = std::iter::once(0.0).chain(phi.iter().copied());
    phi.iter().zip(before).map(|(a, b)| a - b).collect()
}

#[test]
fn joint_angles_accelerate_as_differences_of_the_angles_of_links() {
    for (links, way) in [(3, Way::Schur), (10, Way::Shared), (50, Way::Shared)] {
        let mut case = Case::of(&of_joints(), &of_length(links));
        let solved = case.programs().acceleration.expect("a solve");
        assert_eq!(solved.way, way, "{links} links");
        let n = links as usize;
        let exact = joint_accelerations(n);
        let found = computed(&solved.program, "acceleration", n);
        let off = difference(&found, &exact) / largest(&exact);
        assert!(off < 1e-12, "{links} links: off by {off:e}");
    }
}

#[test]
fn the_terms_of_a_chain_in_joint_angles_give_the_same_accelerations() {
    for links in [3, 10, 40] {
        let case = Case::of(&of_joints(), &of_length(links));
        let exact = joint_accelerations(links as usize);
        let off = difference(&case.eliminated(), &exact) / largest(&exact);
        assert!(off < 1e-10, "{links} links: off by {off:e}");
    }
}

#[test]
fn the_mass_matrix_of_composite_bodies_has_the_kinetic_energy() {
    for links in [3, 10, 40] {
        let case = Case::of(&of_joints(), &of_length(links));
        let rates: Vec<f64> = (0..links).map(|i| state(Symbol::Velocity(i))).collect();
        let rows = case.mass().into_iter().zip(&rates);
        let dot = |row: Vec<f64>| -> f64 { row.iter().zip(&rates).map(|(m, v)| m * v).sum() };
        let twice: f64 = rows.map(|(row, rate)| dot(row) * rate).sum();
        let kinetic = case.values(&[case.equations.energies.kinetic])[0];
        let off = (twice / 2.0 - kinetic).abs() / kinetic;
        assert!(off < 1e-12, "{links} links: {twice} is not twice {kinetic}");
    }
}

#[test]
fn the_energy_of_a_chain_in_joint_angles_changes_by_what_is_supplied() {
    for links in [3, 10] {
        let mut case = Case::of(&of_joints(), &of_length(links));
        let program = case.programs().acceleration.expect("a solve").program;
        let acceleration = computed(&program, "acceleration", links as usize);
        let energies = case.equations.energies;
        let mut terms = Vec::new();
        for i in 0..links {
            let graph = &mut case.mechanism.graph;
            let by = [Symbol::Coordinate(i), Symbol::Velocity(i)];
            let slopes = by.map(|symbol| graph.differentiate(energies.balance, symbol));
            let slopes = case.values(&slopes);
            terms.push(slopes[0] * state(Symbol::Velocity(i)));
            terms.push(slopes[1] * acceleration[i as usize]);
        }
        let power = case.values(&[energies.power])[0];
        let off = (terms.iter().sum::<f64>() - power).abs() / largest(&terms);
        assert!(off < 1e-12, "{links} links: off by {off:e}");
    }
}

#[test]
fn what_a_chain_in_joint_angles_takes_grows_as_it_does() {
    let length = |links| {
        let mut case = Case::of(&of_joints(), &of_length(links));
        case.programs().acceleration.expect("a solve").program.len()
    };
    let (short, long) = (length(20), length(40));
    assert!(10 * long <= 22 * short, "{short} and {long} operations");
    assert!(long < 6_000, "{long} operations");
}

#[test]
fn elimination_from_body_to_body_agrees_with_dense_elimination() {
    for source in OTHERS.into_iter().chain([IN_SPACE]) {
        let mut case = Case::of(source, &CompileSettings::default());
        let eliminated = case.eliminated();
        let program = from_body_to_body(&mut case.mechanism, &case.equations);
        let program = program.expect("shared velocities");
        let found = computed(&program, "acceleration", eliminated.len());
        let off = difference(&found, &eliminated) / largest(&eliminated);
        assert!(off < 1e-11, "{source}: off by {off:e}");
    }
}

#[test]
fn pivots_from_body_to_body_are_those_of_the_mass_matrix() {
    for source in OTHERS.into_iter().chain([IN_SPACE]) {
        let mut case = Case::of(source, &CompileSettings::default());
        let mass = case.mass();
        let program = from_body_to_body(&mut case.mechanism, &case.equations);
        let program = program.expect("shared velocities");
        let diagonal: Vec<f64> = (0..mass.len()).map(|i| mass[i][i]).collect();
        let pivots = computed(&program, "mass_pivots", mass.len());
        let wholes = computed(&program, "mass_diagonal", mass.len());
        let mut product = 1.0;
        for ((pivot, whole), entry) in pivots.iter().zip(&wholes).zip(&diagonal) {
            // What elimination leaves as it is is not handed out.
            let is_left = *whole == 0.0;
            assert!(is_left || (whole / entry - 1.0).abs() < 1e-12, "{source}");
            product *= if is_left { *entry } else { *pivot };
        }
        let (_, determinant) = dense(&mass, &diagonal);
        let off = (product / determinant - 1.0).abs();
        assert!(off < 1e-10, "{source}: {product} is not {determinant}");
    }
}
