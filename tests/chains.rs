//! A chain in joint angles moves as the same chain in the angles of its links; the mass matrix
//! of a long one is that of its energy.
//!
//! All are compiled; the angle of a joint is the difference of those of two links.

use bricard_fixtures::chains::joint_chain::JointChain;
use bricard_fixtures::chains::link_chain::LinkChain;
use bricard_fixtures::chains::long_chain::LongChain;
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    Acceleration, Form, Mechanism, Method, Options, Settings, Solver, State, StepControl, Terms,
    Whole, assemble, simulate,
};
use bricard_testkit::Random;

const N: usize = 10;
/// Links of a chain whose mass matrix is computed column by column.
const LONG: usize = 40;
const STATES: usize = 100;

/// Round-off of an acceleration, relative to the largest of the chain.
const ROUND_OFF: f64 = 1e-12;

/// Round-off of an acceleration by a dense mass matrix, whose condition is that of joint angles,
/// relative to the largest of the chain.
const DENSE_ROUND_OFF: f64 = 1e-10;

/// How far two runs of a second may be apart (rad).
const APART: f64 = 1e-8;

/// What links do, as joints say it.
fn of_joints(links: &SVector<f64, N>) -> SVector<f64, N> {
    SVector::from_fn(|i, _| links[i] - if i == 0 { 0.0 } else { links[i - 1] })
}

/// A chain, with a driver that is compiled once for both.
type Chain = dyn Whole<f64, N, 0>;

/// Random states, in the angles of links and of joints.
fn states() -> Vec<[State<f64, N>; 2]> {
    let mut random = Random::seeded(1979);
    let mut state = || {
        let mut links = State::<f64, N>::default();
        links.q.iter_mut().for_each(|q| *q = random.within(3.0));
        links.v.iter_mut().for_each(|v| *v = random.within(5.0));
        let mut joints = links;
        (joints.q, joints.v) = (of_joints(&links.q), of_joints(&links.v));
        [links, joints]
    };
    (0..STATES).map(|_| state()).collect()
}

#[test]
fn joints_accelerate_as_differences_of_links() {
    let (by_links, by_joints) = (&LinkChain::default(), &JointChain::default());
    let (by_links, by_joints): (&Chain, &Chain) = (by_links, by_joints);
    for [links, joints] in states() {
        let mut found = [(); 2].map(|()| Acceleration::<f64, N, 0>::default());
        assert!(by_links.acceleration(&links, &mut found[0]));
        assert!(by_joints.acceleration(&joints, &mut found[1]));
        let exact = of_joints(&found[0].acceleration);
        let off = (found[1].acceleration - exact).amax() / exact.amax();
        assert!(off < ROUND_OFF, "off by {off:e} at {joints:?}");
        let mut solver = Solver::<f64, N, 0>::new(Settings {
            form: Form::Full,
            ..Settings::default()
        });
        let dense = solver.on(by_joints).acceleration(&joints);
        let off = (dense.expect("an acceleration") - exact).amax() / exact.amax();
        assert!(off < DENSE_ROUND_OFF, "dense: off by {off:e} at {joints:?}");
    }
}

#[test]
fn joints_move_as_differences_of_links() {
    let step_control = StepControl::Adaptive {
        relative: 1e-11,
        absolute: 1e-11,
    };
    let options = Options::new(1.0, Method::Dop853, step_control);
    let (by_links, by_joints) = (&LinkChain::default(), &JointChain::default());
    let (by_links, by_joints): (&Chain, &Chain) = (by_links, by_joints);
    let links = assemble(by_links, &by_links.start(), 0.0).expect("a start");
    let joints = assemble(by_joints, &by_joints.start(), 0.0).expect("a start");
    let links = simulate(by_links, &links, &options, &mut []).expect("a motion");
    let joints = simulate(by_joints, &joints, &options, &mut []).expect("a motion");
    let off = (joints.end.q - of_joints(&links.end.q)).amax();
    assert!(off < APART, "off by {off:e}");
}

/// A random state of the long chain.
fn long_state(random: &mut Random) -> State<f64, LONG> {
    let mut state = State::<f64, LONG>::default();
    state.q.iter_mut().for_each(|q| *q = random.within(3.0));
    state.v.iter_mut().for_each(|v| *v = random.within(5.0));
    state
}

/// Second derivatives of the kinetic energy, a quadratic form of the velocities.
fn second_derivatives(state: &State<f64, LONG>) -> SMatrix<f64, LONG, LONG> {
    let chain = LongChain::<f64>::default();
    let kinetic = |moving: &[usize]| {
        let mut state = *state;
        state.v = SVector::zeros();
        moving.iter().for_each(|i| state.v[*i] += 1.0);
        chain.energy(&state).kinetic
    };
    SMatrix::from_fn(|i, j| kinetic(&[i, j]) - kinetic(&[i]) - kinetic(&[j]))
}

#[test]
fn the_mass_matrix_of_a_long_chain_is_that_of_its_kinetic_energy() {
    let (chain, mut random) = (LongChain::default(), Random::seeded(1987));
    for _ in 0..5 {
        let state = long_state(&mut random);
        let (mass, exact) = (chain.mass_matrix(&state), second_derivatives(&state));
        let off = (mass - exact).amax() / exact.amax();
        assert!(off < ROUND_OFF, "off by {off:e} at {state:?}");
        assert_eq!(mass, mass.transpose());
        let mut terms = Terms::<f64, LONG, 0>::default();
        chain.terms(&state, &mut terms);
        assert_eq!(terms.mass, mass);
    }
}

#[test]
fn a_long_chain_accelerates_against_its_mass_matrix_as_forces_say() {
    let (chain, mut random) = (LongChain::default(), Random::seeded(1988));
    for _ in 0..STATES {
        let state = long_state(&mut random);
        let mut terms = Terms::<f64, LONG, 0>::default();
        let mut found = Acceleration::<f64, LONG, 0>::default();
        chain.terms(&state, &mut terms);
        assert!(chain.acceleration(&state, &mut found));
        // What round-off of the accelerations comes to.
        let size = (terms.mass.abs() * found.acceleration.abs()).amax();
        let off = (terms.mass * found.acceleration - terms.force).amax() / size;
        assert!(off < ROUND_OFF, "off by {off:e} at {state:?}");
    }
}
