//! Initial states: held values, guesses, singular positions, contradictions.

use crate::fixtures::{BEAD, Bead, Framed};
use crate::mechanisms::{FourBars, Hanging, RODS, SliderCrank, place};
use bricard_runtime::{
    AssemblyError, Initial, Mechanism, Position, Start, State, Structure, assemble,
};
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Largest constraint error of positions and velocities.
fn errors<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(
    mechanism: &M,
    state: &State<f64, N>,
) -> (f64, f64) {
    let mut at = Position::default();
    mechanism.position(state, &mut at);
    (
        at.residual.amax(),
        (at.jacobian * state.v + at.drift).amax(),
    )
}

/// `=` in a start block.
fn hold(value: f64) -> Initial<f64> {
    Initial { value, held: true }
}

/// `~` in a start block.
fn guess(value: f64) -> Initial<f64> {
    Initial { value, held: false }
}

/// Assembles and checks that it is on the constraints to round-off.
fn assembled<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(
    mechanism: &M,
    q: [Initial<f64>; N],
    v: [Initial<f64>; N],
) -> State<f64, N> {
    let state = match assemble(mechanism, &Start { q, v }, 0.0) {
        Ok(state) => state,
        Err(error) => panic!("{error}"),
    };
    let (position, velocity) = errors(mechanism, &state);
    assert!(position < 1e-15, "position off by {position:e}");
    assert!(velocity < 1e-14, "velocity off by {velocity:e}");
    for i in 0..N {
        assert!(
            !q[i].held || state.q[i] == q[i].value,
            "held coordinate {i} moved"
        );
        assert!(
            !v[i].held || state.v[i] == v[i].value,
            "held velocity {i} moved"
        );
    }
    state
}

#[test]
fn the_slider_crank_is_assembled_on_the_branch_of_its_guesses() {
    let crank = SliderCrank::default();
    let rest = [guess(0.0); 3];
    let near = assembled(&crank, [hold(FRAC_PI_4), guess(0.8), guess(0.7)], rest);
    assert!((near.q[1] - FRAC_PI_4).abs() < 1e-14, "{}", near.q);
    assert!((near.q[2] - FRAC_PI_4.cos()).abs() < 1e-14, "{}", near.q);
    let far = assembled(&crank, [hold(FRAC_PI_4), guess(2.5), guess(0.1)], rest);
    assert!((far.q[1] - 3.0 * FRAC_PI_4).abs() < 1e-14, "{}", far.q);
    assert!(far.q[2].abs() < 1e-14, "{}", far.q);
}

#[test]
fn guesses_of_zero_are_enough_where_one_coordinate_is_held() {
    let state = assembled(
        &SliderCrank::default(),
        [hold(FRAC_PI_4), guess(0.0), guess(0.0)],
        [hold(2.0), guess(0.0), guess(0.0)],
    );
    assert!(
        (state.v[1] - 2.0).abs() < 1e-14 || (state.v[1] + 2.0).abs() < 1e-14,
        "{}",
        state.v
    );
}

#[test]
fn velocities_follow_the_held_one() {
    let state = assembled(
        &SliderCrank::default(),
        [hold(0.5), guess(0.4), guess(1.0)],
        [hold(3.0), guess(0.0), guess(0.0)],
    );
    assert!((state.v[1] - 3.0).abs() < 1e-13, "{}", state.v);
    assert!(
        (state.v[2] + 3.0 * 0.5_f64.sin()).abs() < 1e-13,
        "{}",
        state.v
    );
}

#[test]
fn a_mechanism_at_rest_is_assembled_from_guesses_that_move() {
    let crank = SliderCrank::default();
    for angle in 1..60 {
        let q = f64::from(angle) * 0.05;
        let state = assembled(
            &crank,
            [hold(q), guess(q), guess(0.7)],
            [hold(0.0), guess(1.7), guess(0.37 + q)],
        );
        assert!(state.v.amax() < 1e-14, "at {q}: {}", state.v);
    }
}

#[test]
fn a_consistent_over_determined_start_is_kept_as_it_is() {
    let q = [hold(0.5), hold(0.5), hold(0.5_f64.cos())];
    let v = [hold(1.0), hold(1.0), hold(-0.5_f64.sin())];
    assembled(&SliderCrank::default(), q, v);
}

#[test]
fn a_contradictory_start_names_the_rows_and_the_held_values() {
    let start = Start {
        q: [hold(0.5), hold(0.6), guess(0.0)],
        v: [guess(0.0); 3],
    };
    match assemble(&SliderCrank::default(), &start, 0.0) {
        Err(AssemblyError::Positions {
            residual,
            conflicting,
            ..
        }) => {
            // The slider can satisfy the first equation, nothing the second.
            assert_eq!(residual[0], 0.0);
            assert!((residual[1] - 0.5 * (0.5_f64.sin() - 0.6_f64.sin())).abs() < 1e-12);
            assert_eq!(conflicting, [true, true, false]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_impossible_start_is_a_message_with_the_equation_and_its_line() {
    let bead = Framed::<_, 2>::new(
        Bead {
            radius: 1.0,
            rise: 0.0,
            weight: 1.0,
        },
        &BEAD,
    );
    let start = Start {
        q: [hold(1.5), guess(0.2)],
        v: [guess(0.0); 2],
    };
    let error = assemble::<_, _, 2, 1>(&bead, &start, 0.0).unwrap_err();
    let text = error.to_string();
    for part in ["`x^2 + y^2 = r^2` (line 7) is off by 1.25", ": x;", "`~`"] {
        assert!(text.contains(part), "{part} is not in: {text}");
    }
}

#[test]
fn contradictory_velocities_are_told_from_contradictory_positions() {
    let start = Start {
        q: [hold(0.5), guess(0.5), guess(1.0)],
        v: [hold(1.0), hold(1.1), guess(0.0)],
    };
    match assemble(&SliderCrank::default(), &start, 0.0) {
        Err(AssemblyError::Velocities { conflicting, .. }) => {
            assert_eq!(conflicting, [true, true, false]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_guess_where_every_direction_looks_the_same_is_left() {
    let bead = Bead {
        radius: 1.0,
        rise: 0.0,
        weight: 1.0,
    };
    assembled::<_, 2, 1>(&bead, [guess(0.0); 2], [guess(0.0); 2]);
}

#[test]
fn infinite_and_nan_values_are_typed_errors() {
    for bad in [f64::NAN, f64::INFINITY] {
        let start = Start {
            q: [hold(bad), guess(0.0), guess(0.0)],
            v: [guess(0.0); 3],
        };
        let error = assemble(&SliderCrank::default(), &start, 1.5).unwrap_err();
        assert_eq!(error, AssemblyError::NotFinite { t: 1.5 });
    }
}

#[test]
fn a_start_in_a_singular_position_takes_the_velocity_of_a_branch() {
    // Crank and rod upright over each other: the slider at rest, or both turning
    // together.
    let crank = SliderCrank::default();
    let q = [hold(FRAC_PI_2), guess(FRAC_PI_2), guess(0.0)];
    let state = assembled(&crank, q, [hold(4.0), guess(3.0), guess(-3.0)]);
    let along = (state.v[1] - 4.0).abs() < 1e-9 && (state.v[2] + 4.0).abs() < 1e-9;
    assert!(along, "not the branch near the guess: {}", state.v);
    let other = assembled(&crank, q, [hold(4.0), guess(-3.0), guess(0.0)]);
    let across = (other.v[1] + 4.0).abs() < 1e-9 && other.v[2].abs() < 1e-9;
    assert!(across, "not the branch near the guess: {}", other.v);
}

#[test]
fn a_stretched_double_four_bar_moves_along_one_branch_of_each_loop() {
    let q = [hold(0.0), guess(0.1), guess(-0.1), guess(0.0), guess(0.05)];
    let v = [hold(-5.0), guess(0.0), guess(-4.0), guess(0.0), guess(-4.0)];
    let state = assemble::<_, _, 5, 4>(&FourBars, &Start { q, v }, 0.0).unwrap();
    // Constraints that don't change to first order say where to be only to the
    // square root of round-off.
    let (position, velocity) = errors::<_, 5, 4>(&FourBars, &state);
    assert!(
        position < 1e-15 && velocity < 1e-7,
        "{position:e} {velocity:e}"
    );
    assert!(state.q.amax() < 1e-7, "{}", state.q);
    for i in [2, 4] {
        assert!((state.v[i] + 5.0).abs() < 1e-6, "{}", state.v);
    }
    for i in [1, 3] {
        assert!(state.v[i].abs() < 1e-6, "{}", state.v);
    }
}

#[test]
fn a_velocity_that_no_branch_has_is_refused() {
    let start = Start {
        q: [hold(FRAC_PI_2), hold(FRAC_PI_2), hold(0.0)],
        v: [hold(4.0), hold(3.0), guess(0.0)],
    };
    let error = assemble(&SliderCrank::default(), &start, 0.0).unwrap_err();
    assert!(matches!(error, AssemblyError::NoBranch { .. }), "{error}");
    assert!(error.to_string().contains("singular position"), "{error}");
}

#[test]
fn branches_that_a_guess_lies_between_are_told_apart_by_the_velocity_that_is_named() {
    let mut start = Start {
        q: [hold(FRAC_PI_2), hold(FRAC_PI_2), hold(0.0)],
        v: [hold(4.0), guess(0.0), guess(-2.0)],
    };
    let error = assemble(&SliderCrank::default(), &start, 0.0).unwrap_err();
    let AssemblyError::ManyBranches {
        coordinate,
        velocity,
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!(coordinate, 1);
    assert!((velocity.abs() - 4.0).abs() < 1e-12, "{velocity}");
    start.v[coordinate] = guess(velocity / 2.0);
    let state = assemble(&SliderCrank::default(), &start, 0.0).unwrap();
    assert!((state.v[1] - velocity).abs() < 1e-12, "{}", state.v);
}

#[test]
fn rest_in_a_singular_position_stays_rest() {
    let q = [hold(FRAC_PI_2), hold(FRAC_PI_2), guess(0.0)];
    let state = assembled(&SliderCrank::default(), q, [guess(0.0); 3]);
    assert_eq!(state.v.amax(), 0.0);
}

#[test]
fn free_coordinates_change_less_the_more_inertia_they_have() {
    // A bead and a wire at distance one along y: the free coordinate y goes there
    // and x stays.
    let wire = Bead {
        radius: 0.0,
        rise: 1.0,
        weight: 0.0,
    };
    let structure: &'static Structure = wire.structure();
    assert_eq!(structure.constraints.len(), 1);
    let start = Start {
        q: [guess(PI), guess(0.3)],
        v: [guess(0.7), guess(0.0)],
    };
    let state = assemble::<_, _, 2, 1>(&wire, &start, 2.0).unwrap();
    assert_eq!(state.q[0], PI);
    assert!((state.q[1] - 2.0).abs() < 1e-15);
    assert_eq!(state.v[0], 0.7);
    assert!((state.v[1] - 1.0).abs() < 1e-15);
}

/// The stack of a usual program.
const STACK: usize = 8 << 20;
/// Evaluations from a guess that is good, and from one that has to be disturbed and where
/// most steps are damped.
const FEW: usize = 25;
const MANY: usize = 250;

/// Assembles fifty rods that hang from both ends, as a program does that has done nothing
/// about its stack; the positions, and after how many evaluations.
fn hanging(guesses: fn(usize) -> [f64; 7]) -> (Vec<f64>, usize) {
    let work = move || {
        let chain = Hanging::default();
        let mut start = Start {
            q: [guess(0.0); 7 * RODS],
            v: [guess(0.0); 7 * RODS],
        };
        for rod in 0..RODS {
            for (kind, value) in guesses(rod).into_iter().enumerate() {
                start.q[place(kind, rod)].value = value;
            }
        }
        let state = match assemble(&chain, &start, 0.0) {
            Ok(state) => state,
            Err(error) => panic!("{error}"),
        };
        let evaluations = chain.evaluations.get();
        let (position, velocity) = errors(&chain, &state);
        assert!(position < 4e-14, "position off by {position:e}");
        assert!(velocity == 0.0, "velocity off by {velocity:e}");
        (state.q.as_slice().to_vec(), evaluations)
    };
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(work);
    thread.expect("a thread").join().expect("no overflow")
}

#[test]
fn fifty_bodies_are_assembled_on_a_usual_stack_in_few_evaluations() {
    // A V that is almost one.
    let (q, evaluations) = hanging(|rod| {
        let down = rod < RODS / 2;
        let (place, angle): (f64, f64) = (rod as f64 + 0.5, if down { -0.32 } else { 0.32 });
        let depth = place.min(RODS as f64 - place);
        let (s, c) = angle.sin_cos();
        let root = 0.5_f64.sqrt();
        [
            0.0,
            0.8 * place,
            -0.6 * depth,
            root * c,
            root * s,
            -root * s,
            root * c,
        ]
    });
    assert!(evaluations < FEW, "{evaluations} evaluations");
    // The lowest place is that of a symmetric V.
    let depth = 0.6 * (RODS as f64 / 2.0 - 0.5);
    assert!(
        (q[place(2, RODS / 2)] + depth).abs() < 0.3,
        "{}",
        q[place(2, RODS / 2)]
    );
}

#[test]
fn fifty_bodies_in_line_are_bent_where_their_ends_are_too_near() {
    let (q, evaluations) = hanging(|rod| {
        let root = 0.5_f64.sqrt();
        [0.0, 0.8 * (rod as f64 + 0.5), 0.0, root, 0.0, 0.0, root]
    });
    assert!(evaluations < MANY, "{evaluations} evaluations");
    let aside = (0..RODS).map(|rod| q[place(0, rod)].hypot(q[place(2, rod)]));
    assert!(aside.fold(0.0, f64::max) > 0.1);
}
