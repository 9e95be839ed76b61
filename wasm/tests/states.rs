//! First-order states, and runs, by the functions of a module.

use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    Canvas, Energy, Initial, Interface, Mechanism, Quantity, Start, State, Structure, Terms,
};
use bricard_wasm::{ROOM, Session};

const fn quantity(name: &'static str) -> Quantity {
    let (unit, docs) = ("", "");
    Quantity { name, unit, docs }
}

/// A mass that falls, and a charge that leaks: `ẍ = −1`, `ż = −z`. The second coordinate is
/// the integral of the state `z`.
static STRUCTURE: Structure = Structure {
    name: "Falling",
    coordinates: &[quantity("x"), quantity("z")],
    states: 1,
    constant_mass: true,
    ..Structure::PLAIN
};

struct Falling;

impl Mechanism<f64, 2, 0> for Falling {
    fn structure(&self) -> &'static Structure {
        &STRUCTURE
    }

    fn terms(&self, state: &State<f64, 2>, out: &mut Terms<f64, 2, 0>) {
        out.mass = SMatrix::identity();
        out.force = SVector::from([-1.0, -state.v[1]]);
    }

    fn energy(&self, state: &State<f64, 2>) -> Energy<f64> {
        let (kinetic, potential) = (state.v[0] * state.v[0] / 2.0, state.q[0]);
        Energy {
            kinetic,
            potential,
            balance: kinetic + potential,
            power: 0.0,
        }
    }
}

impl Interface<f64, 2> for Falling {
    fn parameter(&self, _: usize) -> Option<f64> {
        None
    }

    fn set_parameter(&mut self, _: usize, _: f64) -> bool {
        false
    }

    fn set_input(&mut self, _: usize, _: Option<f64>) -> bool {
        false
    }

    fn start(&self) -> Start<f64, 2> {
        let held = |value| Initial { value, held: true };
        Start {
            q: [held(3.0), held(0.0)],
            v: [held(0.5), held(2.0)],
        }
    }

    fn outputs(&self, _: &State<f64, 2>, _: &mut [f64]) {}

    fn events(&self, _: &State<f64, 2>, _: &mut [f64]) {}

    fn draw(&self, _: &State<f64, 2>, _: &mut dyn Canvas<f64>) {}
}

/// A session, and the numbers that a page reads.
fn session() -> Session<Falling, 2, 0> {
    let numbers = vec![0.0; ROOM].into_boxed_slice();
    let numbers: Box<[f64; ROOM]> = numbers.try_into().expect("they are as many");
    Session::new(Falling, Box::leak(numbers))
}

/// What can be read now.
fn read(session: &Session<Falling, 2, 0>, count: u32) -> Vec<f64> {
    session.read()[..count as usize].to_vec()
}

#[test]
fn the_integral_of_a_state_is_nowhere() {
    let mut falling = session();
    assert_eq!(falling.assemble(), 0);
    // Time, coordinate, velocity, state.
    let count = falling.state();
    assert_eq!(read(&falling, count), [0.0, 3.0, 0.5, 2.0]);
    assert_eq!(falling.advance(1.0), 0);
    let count = falling.state();
    let state = read(&falling, count);
    let leaked = 2.0 * (-1.0_f64).exp();
    assert!(
        (state[1] - 3.0).abs() < 1e-9 && (state[3] - leaked).abs() < 1e-8,
        "{state:?}"
    );
    // Acceleration, rate, reaction.
    assert_eq!(falling.forces(), 0);
    let forces = read(&falling, 3);
    assert!((forces[0] + 1.0).abs() < 1e-12 && (forces[1] + state[3]).abs() < 1e-12);
    assert!(forces[2].abs() < 1e-12, "{forces:?}");
    assert_eq!(falling.describe(), 0);
    let told = falling.told();
    assert!(
        told.contains(r#""coordinates":[{"name":"x","unit":"","docs":""}]"#),
        "{told}"
    );
    assert!(
        told.contains(r#""states":[{"name":"z","unit":"","docs":""}]"#),
        "{told}"
    );
}

#[test]
fn a_start_and_a_state_are_given_without_integrals() {
    let mut falling = session();
    assert_eq!(falling.start(2), 0);
    assert_eq!(read(&falling, 2), [2.0, 1.0]);
    // Coordinate, velocity, state; nothing behind.
    assert_eq!(falling.begin(2, 7.0, 1), 0);
    assert_eq!(falling.begin(3, 7.0, 1), 1);
    assert_eq!(falling.start(3), 1);
    assert_eq!(falling.assemble(), 0);
    let count = falling.state();
    assert_eq!(read(&falling, count), [0.0, 3.0, 0.5, 7.0]);
    for (place, value) in [(1, 4.0), (2, 5.0), (3, 6.0)] {
        assert_eq!(falling.place(place, value), 0);
    }
    assert_eq!(falling.place(4, 1.0), 1);
    let count = falling.state();
    assert_eq!(read(&falling, count), [0.0, 4.0, 5.0, 6.0]);
}

#[test]
fn rows_that_have_no_room_are_those_of_a_run_that_goes_on() {
    const ENERGIES: u32 = 32;
    let mut falling = session();
    let width = falling.width(ENERGIES);
    assert_eq!(width, 6);
    let every = 1e-5;
    assert_eq!(falling.assemble(), 0);
    let mut rows = Vec::new();
    let mut pieces = 0;
    loop {
        assert_eq!(
            falling.run(1.0, every, ENERGIES, u32::from(pieces > 0)),
            0,
            "{}",
            falling.told()
        );
        rows.extend(read(&falling, falling.rows() * width));
        pieces += 1;
        if falling.unfinished() == 0 {
            break;
        }
    }
    assert!(pieces > 2, "{pieces}");
    assert_eq!(rows.len(), 6 * 100_001);
    for (place, row) in rows.chunks(6).enumerate() {
        let t = place as f64 * every;
        let exact = [t, 3.0 + 0.5 * t - 0.5 * t * t, 0.5 - t, 2.0 * (-t).exp()];
        for (number, exact) in row.iter().zip(exact) {
            assert!((number - exact).abs() < 1e-8, "{place}: {row:?}");
        }
        assert!((row[4] + row[5] - 3.125).abs() < 1e-8, "{row:?}");
    }
}

#[test]
fn what_makes_no_run_is_refused_in_words() {
    let mut falling = session();
    assert_eq!(falling.run(1.0, 0.1, 0, 0), 1);
    assert!(falling.told().contains("isn't assembled yet"));
    assert_eq!(falling.assemble(), 0);
    for (until, every, columns, words) in [
        (
            1.0,
            0.0,
            0,
            "the interval between rows must be a positive number",
        ),
        (
            1.0,
            f64::NAN,
            0,
            "the interval between rows must be a positive number",
        ),
        (f64::NAN, 0.1, 0, "the end must be a number"),
        (
            -1.0,
            0.1,
            0,
            "the end must be a number and not come earlier",
        ),
        (1.0, 0.1, 256, "there are no columns of this number"),
    ] {
        assert_eq!(falling.run(until, every, columns, 0), 1);
        assert!(falling.told().contains(words), "{}", falling.told());
        assert_eq!(falling.rows(), 0);
    }
    assert_eq!(falling.settings(4, 0, 0.0, 0.0, 0), 1);
    assert_eq!(falling.settings(0, 3, 0.0, 0.0, 0), 1);
    assert_eq!(falling.settings(0, 2, f64::NAN, 1.0, 0), 1);
    assert!(falling.told().contains("gains"));
    assert_eq!(falling.settings(1, 2, 10.0, 10.0, 7), 0);
}
