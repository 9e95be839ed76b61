//! Parallelograms with several degrees of freedom.

use super::backwards::before;
use crate::trial::{Compare, Set, Trial};
use bricard_testkit::Random;
use core::f64::consts::PI;

const PENDULUM: &str = "parallelogram_pendulum";
const PENDULUM_REDUCED: &str = "parallelogram_pendulum_reduced";
const CART: &str = "two_parallelograms";
const CART_REDUCED: &str = "two_parallelograms_reduced";
/// How long the chaotic ones are (s).
const MINUTE: f64 = 60.0;

fn invariants(trial: Trial) -> Trial {
    let compare = Compare::Invariants;
    Trial { compare, ..trial }.uncounted()
}

fn pendulum(set: Set) -> Trial {
    Trial::short(PENDULUM, PENDULUM_REDUCED, set)
}

/// The parallelogram with a pendulum, released at rest, for a minute.
pub fn minute(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("a0", random.within(1.4)),
        ("b0", random.within(1.0)),
        ("wb0", random.within(3.0)),
    ];
    invariants(pendulum(set).until(MINUTE))
}

/// Starts at which earlier versions failed, one of them without a word.
pub fn named(_: &mut Random, index: usize) -> Trial {
    let (set, tolerance, until) = match index % 6 {
        0 => (vec![("wb0", 0.0)], 1e-12, 300.0),
        1 => {
            let start = vec![("wb0", 1.8641450878803782), ("a0", 0.605674594105652)];
            (start, 1e-9, 100.0)
        }
        2 => (vec![("a0", 0.6), ("b0", 0.2), ("wb0", -1.0)], 1e-6, 1.5),
        3 => (vec![("a0", 0.6), ("b0", 0.2), ("wb0", -1.0)], 1e-9, 1.5),
        4 => (
            turning_start(-0.00834469169738557, 0.7264071129000274, -5.0),
            1e-9,
            0.068,
        ),
        _ => (
            turning_start(-0.00010289251993546345, 0.11891541994152778, -20.3046),
            1e-12,
            0.06,
        ),
    };
    let trial = Trial {
        tolerance,
        ..pendulum(set).until(until)
    };
    match until > 10.0 {
        true => invariants(trial),
        false => trial,
    }
}

fn turning_start(a0: f64, w0: f64, wb0: f64) -> Set {
    let b0 = 1.032847176918608;
    vec![("a0", a0), ("w0", w0), ("b0", b0), ("wb0", wb0)]
}

/// The crank turns round, or crosses slowly, near its singular position while the
/// pendulum moves: it has the speed `w` at the angle `a`, some time after the start.
fn beside(random: &mut Random, a: f64, w: f64) -> Trial {
    let near = random.of_these(&[0.0, PI]);
    let reached = vec![
        ("a0", near + a),
        ("w0", w),
        ("b0", random.within(PI)),
        ("wb0", random.signed_decade(0.3, 20.0)),
    ];
    let span = random.decade(0.01, 0.1);
    let names = (PENDULUM, PENDULUM_REDUCED);
    let state = before(names, 4, &reached, &["w0", "wb0"], span);
    let set = vec![
        ("a0", state[0]),
        ("w0", state[4]),
        ("b0", state[3]),
        ("wb0", state[7]),
    ];
    pendulum(set).until(2.0 * span)
}

/// Turns round at 1e-6 … 1e-2 rad from the singular position, before it or behind it.
pub fn turning(random: &mut Random, _: usize) -> Trial {
    let at = random.signed_decade(1e-6, 1e-2);
    beside(random, at, 0.0)
}

/// Crosses at 1e-8 … 1 rad/s.
pub fn slow(random: &mut Random, _: usize) -> Trial {
    let speed = random.signed_decade(1e-8, 1.0);
    beside(random, 0.0, speed)
}

/// Released at rest 1e-8 … 1e-1 rad from the singular position.
pub fn rest_beside(random: &mut Random, index: usize) -> Trial {
    let at = random.sign() * 10f64.powi(-1 - (index % 8) as i32);
    let mut trial = pendulum(vec![
        ("a0", at),
        ("b0", random.within(1.0)),
        ("wb0", random.of_these(&[0.0, 1.0])),
    ]);
    trial.held = &[(0, "a0"), (3, "b0")];
    trial.until(1.0)
}

fn cart(random: &mut Random) -> Trial {
    let set = vec![
        ("a0", random.within(1.4)),
        ("wa", random.within(1.0)),
        ("b0", random.within(1.4)),
        ("wb", random.within(3.0)),
    ];
    Trial::short(CART, CART_REDUCED, set)
}

/// Two parallelograms on a cart, for a minute.
pub fn cart_minute(random: &mut Random, _: usize) -> Trial {
    invariants(cart(random).until(MINUTE))
}

/// Two parallelograms on a cart, for so short a time that the run can be compared.
pub fn cart_short(random: &mut Random, _: usize) -> Trial {
    cart(random).until(1.5)
}

/// A parallelogram on a carriage with two pendulums: one loop of it is singular at a time
/// when its rows are nearly dependent on each other, too.
pub fn mast(random: &mut Random, index: usize) -> Trial {
    let set = match index {
        0 => Vec::new(),
        _ => vec![
            ("L", random.between(0.3, 0.8)),
            ("W", random.between(0.4, 1.5)),
            ("x0", random.within(0.2)),
            ("a0", random.within(PI)),
            ("wa", random.within(6.0)),
            ("b0", random.within(1.0)),
            ("wb", random.within(3.0)),
            ("c0", random.within(1.0)),
            ("wc", random.within(3.0)),
        ],
    };
    Trial::short("mast", "mast_reduced", set).until(1.5)
}

/// A parallelogram on a carriage with two pendulums, for a minute.
pub fn mast_minute(random: &mut Random, index: usize) -> Trial {
    invariants(mast(random, index).until(MINUTE))
}

/// A rhombus, singular wherever two links lie on each other.
pub fn rhombus(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("a0", random.within(PI)),
        ("wa", random.within(3.0)),
        ("b0", random.within(PI)),
        ("wb", random.within(3.0)),
    ];
    Trial::short("rhombus", "rhombus_reduced", set).until(2.0)
}
