//! Reactions of single constraints in singular configurations: of those that stay independent
//! they are what they are on the way there.

use bricard_runtime::{Settings, Solver, Whole, assemble};
use bricard_singular::descriptions::driven_crank::DrivenCrank;
use bricard_singular::descriptions::parallelogram_pendulum::ParallelogramPendulum;
use bricard_singular::descriptions::two_loops_one_crank::TwoLoopsOneCrank;
use core::f64::consts::PI;

/// The multipliers at the start of a mechanism, near these velocities.
fn multipliers<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    velocities: [f64; N],
) -> [Option<f64>; R] {
    let mut start = mechanism.start();
    for (v, value) in start.v.iter_mut().zip(velocities) {
        v.value = value;
    }
    let start = assemble(mechanism, &start, 0.0).expect("it can be assembled");
    let mut solver = Solver::new(Settings::default());
    let found = solver.on(mechanism).multipliers(&start);
    found.unwrap_or_else(|error| panic!("{error}"))
}

/// Distances from the singular configuration (rad).
const DISTANCES: [f64; 12] = [
    0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 1e-3, 1e-2,
];

/// Compares the multipliers of rows that stay independent beside a singular configuration with
/// what a polynomial through regular states on both sides says.
fn check<const R: usize>(rows: &[usize], at: impl Fn(f64) -> [Option<f64>; R]) {
    let places: Vec<f64> = (-4..=4)
        .filter(|k| *k != 0)
        .map(|k| 0.03 * f64::from(k))
        .collect();
    let nodes: Vec<_> = places.iter().map(|place| at(*place)).collect();
    for distance in DISTANCES.into_iter().flat_map(|d| [d, -d]) {
        let found = at(distance);
        for row in rows {
            let mut exact = 0.0;
            for (i, (own, node)) in places.iter().zip(&nodes).enumerate() {
                let others = places.iter().enumerate().filter(|(j, _)| *j != i);
                let weight: f64 = others.map(|(_, p)| (distance - p) / (own - p)).product();
                exact += weight * node[*row].expect("a regular state tells it");
            }
            let Some(value) = found[*row] else {
                panic!("{distance:e}: row {row} is not told");
            };
            let off = value - exact;
            assert!(
                off.abs() < 1e-6 * (1.0 + exact.abs()),
                "{distance:e}: {value}, off by {off:e}"
            );
        }
    }
}

#[test]
fn a_motor_that_turns_a_crank_through_its_dead_centre_carries_its_load_there() {
    for speed in [3.0, 1e-3] {
        check(&[0, 1], |distance| {
            let mut mechanism = DrivenCrank::<f64>::default();
            (mechanism.parameters.p0, mechanism.parameters.w) = (PI / 2.0 + distance, speed);
            multipliers::<4, 3>(&mechanism, [speed, -speed, -speed, 0.0])
        });
    }
}

#[test]
fn a_parallelogram_with_a_freedom_more_shares_its_reaction_as_beside() {
    check(&[1], |distance| {
        let mut mechanism = ParallelogramPendulum::<f64>::default();
        (mechanism.parameters.a0, mechanism.parameters.w0) = (distance, 5.0);
        multipliers::<4, 2>(&mechanism, [5.0, 0.0, 5.0, 2.0])
    });
}

#[test]
fn two_loops_that_become_singular_at_once_share_theirs_as_beside() {
    check(&[1, 3], |distance| {
        let mut mechanism = TwoLoopsOneCrank::<f64>::default();
        mechanism.parameters.q0 = distance;
        let w = mechanism.parameters.w0;
        multipliers::<5, 4>(&mechanism, [w, 0.0, w, -w, 1.4 * w])
    });
}

/// What holds a crank that is lost there has no bound.
#[test]
fn of_a_row_that_vanishes_no_reaction_is_told() {
    let mut mechanism = ParallelogramPendulum::<f64>::default();
    (mechanism.parameters.a0, mechanism.parameters.w0) = (0.0, 5.0);
    let [across, along] = multipliers::<4, 2>(&mechanism, [5.0, 0.0, 5.0, 2.0]);
    assert_eq!((across, along.is_some()), (None, true));
}
