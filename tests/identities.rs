//! What mechanics says whatever the numbers are: energies, ideal constraints, forms
//! that agree.

use crate::dense::{dot, null_space, size};
use crate::library::{Inspect, has_regular_states, inspect, is_of_unit_size, names};
use bricard::four_bar::FourBar;
use bricard::slider_crank::SliderCrank;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    ConstraintError, Form, Initial, Interface, Position, Settings, Solver, Start, State, Terms,
    Whole, assemble,
};
use bricard_testkit::Random;

/// What a residual may leave over, relative to what cancels in it.
const ROUND_OFF: f64 = 1e-12;

/// The least sine of the weakest constraint at a regular state.
const REGULAR: f64 = 0.1;

/// Consistent random states for each mechanism.
const STATES: u64 = 40;

/// What each form of the equations says at one state.
struct Sample {
    name: &'static str,
    seed: u64,
    mass: Vec<Vec<f64>>,
    force: Vec<f64>,
    jacobian: Vec<Vec<f64>>,
    bias: Vec<f64>,
    v: Vec<f64>,
    kinetic: f64,
    /// The kinetic energy that is left with all velocities zero.
    frame: f64,
    position_error: f64,
    velocity_error: f64,
    rank: usize,
    rows: usize,
    /// `q̈` and `r`, for each form.
    forms: Vec<(Form, Vec<f64>, Vec<f64>)>,
}

/// A random consistent state; none where no regular one is near.
struct Ask {
    name: &'static str,
    seed: u64,
}

impl Inspect<f64> for Ask {
    type Output = Option<Sample>;

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> Option<Sample> {
        let mechanism = &*mechanism;
        let state = consistent(mechanism, self.seed)?;
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(mechanism);
        let rank = system.rank(&state).ok()?;
        let error = system.constraint_error(&state);
        if rank.rank < R || (R > 0 && rank.sine < REGULAR) {
            return None;
        }
        let mut terms: Terms<f64, N, R> = Terms::default();
        mechanism.terms(&state, &mut terms);
        let mut position: Position<f64, N, R> = Position::default();
        mechanism.position(&state, &mut position);
        let numbers = |x: &SVector<f64, N>| x.as_slice().to_vec();
        let row = |i: usize| (0..N).map(|j| terms.jacobian[(i, j)]).collect();
        let still = State::new(state.t, state.q, SVector::zeros());
        let forms = Form::ALL.map(|form| {
            let mut solver = Solver::new(Settings {
                form,
                ..Settings::default()
            });
            let reaction = solver.on(mechanism).reaction(&state);
            let (acceleration, reaction) = reaction.expect("a regular state");
            (form, numbers(&acceleration), numbers(&reaction))
        });
        Some(Sample {
            name: self.name,
            seed: self.seed,
            mass: (0..N)
                .map(|i| (0..N).map(|j| terms.mass[(i, j)]).collect())
                .collect(),
            force: numbers(&terms.force),
            jacobian: (0..R).map(row).collect(),
            bias: terms.bias.as_slice().to_vec(),
            v: numbers(&state.v),
            kinetic: mechanism.energy(&state).kinetic,
            frame: mechanism.energy(&still).kinetic,
            position_error: error.position,
            velocity_error: error.velocity,
            rank: rank.rank,
            rows: R,
            forms: forms.into(),
        })
    }
}

/// A state on the constraints, near a random one.
fn consistent<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    seed: u64,
) -> Option<State<f64, N>> {
    let mut random = Random::seeded(seed);
    let mut guess = || Initial {
        value: random.between(-2.0, 2.0),
        held: false,
    };
    let start = Start {
        q: [(); N].map(|()| guess()),
        v: [(); N].map(|()| guess()),
    };
    let t = random.between(0.0, 1.0);
    assemble(mechanism, &start, t).ok()
}

/// Runs a check on samples of every mechanism of the library.
fn check(claim: impl Fn(&Sample, &str)) {
    let tested = |name: &&str| is_of_unit_size(name) && has_regular_states(name);
    for name in names().filter(tested) {
        let ask = |seed| inspect(name, Ask { name, seed });
        let samples: Vec<Sample> = (0..STATES).filter_map(ask).collect();
        assert!(
            4 * samples.len() as u64 > STATES,
            "{name}: {} regular states",
            samples.len()
        );
        for sample in samples {
            claim(&sample, &format!("{}, seed {}", sample.name, sample.seed));
        }
    }
}

fn vanishes(left: f64, scale: f64, what: &str) {
    assert!(
        left.abs() <= ROUND_OFF * (1.0 + scale),
        "{what}: {left:e} is left of {scale:e}"
    );
}

#[test]
fn assembled_states_are_on_the_constraints() {
    check(|sample, what| {
        assert!(
            sample.position_error <= 1e-14,
            "{what}: {:e}",
            sample.position_error
        );
        assert!(
            sample.velocity_error <= 1e-13,
            "{what}: {:e}",
            sample.velocity_error
        );
        assert_eq!(sample.rank, sample.rows, "{what}");
    });
}

/// Energy is never negative: where none is left at rest, the part of `T` that is linear
/// in the velocities vanishes too.
#[test]
fn without_moving_frames_the_kinetic_energy_is_half_the_quadratic_form_of_the_mass_matrix() {
    check(|sample, what| {
        if sample.frame != 0.0 {
            return;
        }
        let v = &sample.v;
        let momentum: Vec<f64> = sample.mass.iter().map(|row| dot(row, v)).collect();
        vanishes(
            0.5 * dot(&momentum, v) - sample.kinetic,
            size(&momentum, v),
            what,
        );
    });
}

#[test]
fn every_form_obeys_the_constraints() {
    check(|sample, what| {
        for (form, acceleration, _) in &sample.forms {
            for (row, bias) in sample.jacobian.iter().zip(&sample.bias) {
                let left = dot(row, acceleration) - bias;
                vanishes(
                    left,
                    size(row, acceleration) + bias.abs(),
                    &format!("{what}, {form}"),
                );
            }
        }
    });
}

#[test]
fn reactions_do_no_work_along_the_constraints() {
    check(|sample, what| {
        let directions = null_space(&sample.jacobian, sample.v.len());
        for (form, _, reaction) in &sample.forms {
            for direction in &directions {
                // A reaction is what is left of the forces.
                let scale = size(direction, reaction) + size(direction, &sample.force);
                vanishes(
                    dot(direction, reaction),
                    scale,
                    &format!("{what}, {form}: Dᵀr"),
                );
            }
        }
    });
}

#[test]
fn the_null_space_has_as_many_directions_as_degrees_of_freedom() {
    check(|sample, what| {
        let directions = null_space(&sample.jacobian, sample.v.len());
        assert_eq!(directions.len(), sample.v.len() - sample.rank, "{what}");
        for (row, direction) in sample
            .jacobian
            .iter()
            .flat_map(|row| directions.iter().map(move |direction| (row, direction)))
        {
            vanishes(
                dot(row, direction),
                size(row, direction),
                &format!("{what}: A D"),
            );
        }
    });
}

#[test]
fn the_forms_agree_at_regular_states() {
    check(|sample, what| {
        let (_, exact, reaction) = &sample.forms[0];
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (form, acceleration, other) in &sample.forms {
            let what = format!("{what}, {form}");
            for (a, b) in acceleration.iter().zip(exact) {
                vanishes(a - b, 100.0 * largest(exact), &what);
            }
            for (a, b) in other.iter().zip(reaction) {
                vanishes(a - b, 100.0 * (largest(reaction) + largest(exact)), &what);
            }
        }
    });
}

/// Projection leaves a state that is on the constraints where it is.
struct Project {
    seed: u64,
}

impl Inspect<f64> for Project {
    /// How far a consistent state moves, and a slightly inconsistent one.
    type Output = Option<(f64, f64, f64)>;

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> Self::Output {
        let mechanism = &*mechanism;
        let state = consistent(mechanism, self.seed)?;
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(mechanism);
        let rank = system.rank(&state).ok()?;
        if rank.rank < R || (R > 0 && rank.sine < REGULAR) {
            return None;
        }
        let mut still = state;
        system.project(&mut still).ok()?;
        let mut random = Random::seeded(self.seed + 1000);
        let mut left = ConstraintError::<f64>::default();
        // Positions that are off by much, and velocities that are.
        for (far, fast) in [(1e-4, 0.0), (1e-10, 1.0)] {
            let mut pushed = state;
            pushed.q = pushed.q.map(|x| x + random.between(-far, far));
            pushed.v = pushed.v.map(|x| x + random.between(-fast, fast));
            system.project(&mut pushed).ok()?;
            let here = system.constraint_error(&pushed);
            left.position = left.position.max(here.position);
            left.velocity = left.velocity.max(here.velocity);
        }
        let moved = (still.q - state.q).amax().max((still.v - state.v).amax());
        Some((moved, left.position, left.velocity))
    }
}

#[test]
fn projection_keeps_what_is_right_and_repairs_what_is_not() {
    for name in names() {
        for seed in 0..STATES {
            let visited = inspect(name, Project { seed });
            let Some((moved, position, velocity)) = visited else {
                continue;
            };
            assert!(moved <= 1e-12, "{name}, seed {seed}: moved by {moved:e}");
            assert!(
                position <= 1e-14,
                "{name}, seed {seed}: {position:e} is left"
            );
            // Beside a singular position a near-dependent row holds as far as the tangent
            // space is interpolated, 1.1e-11 of velocities of up to 2 (1.4e-11 was the most).
            assert!(
                velocity <= 3e-11,
                "{name}, seed {seed}: {velocity:e}/s is left"
            );
        }
    }
}

/// Both have three coordinates and two rows; where the one has zeros, the other has numbers.
#[test]
fn a_solver_knows_nothing_of_another_mechanism_of_its_sizes() {
    let (first, second) = (FourBar::<f64>::default(), SliderCrank::<f64>::default());
    let at_first = assemble(&first, &first.start(), 0.0).expect("the start assembles");
    let at_second = assemble(&second, &second.start(), 0.0).expect("the start assembles");
    for form in Form::ALL {
        let settings = Settings {
            form,
            ..Settings::default()
        };
        let mut alone = Solver::new(settings);
        let mut both = Solver::new(settings);
        both.on(&first)
            .project(&mut at_first.clone())
            .expect("a position");
        both.on(&first).reaction(&at_first).expect("a reaction");
        let mut found = at_second;
        let mut wanted = at_second;
        for state in [&mut found, &mut wanted] {
            state.q[0] += 1e-3;
        }
        both.on(&second).project(&mut found).expect("a position");
        alone.on(&second).project(&mut wanted).expect("a position");
        assert_eq!(found, wanted, "{form:?}");
        let found = both.on(&second).reaction(&found);
        assert_eq!(found, alone.on(&second).reaction(&wanted), "{form:?}");
    }
}
