//! Errors of starts.

use super::point::{Jet, Point, circle, crossing, diagonals, line, squared};
use super::{Case, Said};
use bricard_runtime::{Initial, Mechanism, Start, State, assemble};

fn hold(value: f64) -> Initial<f64> {
    Initial { value, held: true }
}

fn guess(value: f64) -> Initial<f64> {
    Initial { value, held: false }
}

/// An error of a start at t = 0.
fn refused(point: Point, q: [Initial<f64>; 2], v: [Initial<f64>; 2]) -> Said {
    let point: &dyn Mechanism<f64, 2, 1> = &point;
    Said::of(assemble(point, &Start { q, v }, 0.0))
}

/// Guesses of a position and of rest.
fn near(x: f64, y: f64) -> ([Initial<f64>; 2], [Initial<f64>; 2]) {
    ([guess(x), guess(y)], [guess(0.0); 2])
}

pub const STARTS: &[Case] = &[
    (
        "AssemblyError::NotFinite",
        "`y = 0` with a held `x` that is NaN",
        || {
            refused(
                Point::on(line),
                [hold(f64::NAN), guess(0.0)],
                [guess(0.0); 2],
            )
        },
        "the start at t = 0 s, or a constraint or the mass matrix there, is infinite or NaN; \
         check the values in `start` and the parameters",
    ),
    (
        "AssemblyError::Positions",
        "`x^2 + y^2 = 1` with `x = 1.5;` held",
        || refused(Point::on(circle), [hold(1.5), guess(0.2)], [guess(0.0); 2]),
        "no position near the start satisfies the constraints: `g = 0` (line 3) is off by 1.25; \
         these held values contradict each other or the parameters: x; turn one of them into a \
         guess (`~`)",
    ),
    (
        "AssemblyError::Positions",
        "`x^2 + y^2 = -1`, which nothing satisfies",
        || {
            let mut point = Point::on(circle);
            point.constraint = |state: &State<f64, 2>| {
                let Jet(value, slope, second, rate) = circle(state);
                Jet(value + 2.0, slope, second, rate)
            };
            let (q, v) = near(0.5, 0.5);
            refused(point, q, v)
        },
        "no position near the start satisfies the constraints: `g = 0` (line 3) is off by …; \
         check the parameters, or give guesses (`~`) that are nearer",
    ),
    (
        "AssemblyError::Velocities",
        "`x^2 + y^2 = 1` with `x = 1; der(x) = 0.5;` held",
        || {
            refused(
                Point::on(circle),
                [hold(1.0), guess(0.0)],
                [hold(0.5), hold(1.0)],
            )
        },
        "no velocities near the start satisfy the constraints: `g = 0` (line 3) is off by 1 per \
         second; these held values contradict each other or the parameters: der(x); turn one of \
         them into a guess (`~`)",
    ),
    (
        "AssemblyError::NoBranch",
        "`(x - 1)*(y - 1) = 0` with `der(x) = 1; der(y) = 1;` held where the lines cross",
        || refused(Point::on(crossing), [hold(1.0); 2], [hold(1.0); 2]),
        "the start is a singular position, and no branch of the motion through it has the held \
         velocities; these held values contradict each other or the parameters: der(x), der(y); \
         turn one of them into a guess (`~`)",
    ),
    (
        "AssemblyError::ManyBranches",
        "`y^2 = x^2` with `der(x) = 4;` held where the lines cross",
        || {
            refused(
                Point::on(diagonals),
                [hold(1.0); 2],
                [hold(4.0), guess(0.0)],
            )
        },
        "the start is a singular position, and several branches of the motion through it have \
         the held velocities; choose one by a guess (`~`) of a velocity, for example `der(y) ~ \
         4`",
    ),
    (
        "AssemblyError::Vanishing",
        "`(x^2 + y^2 - 1)^2 = 0`",
        || {
            let (q, v) = near(2.3, 1.4);
            refused(Point::on(squared), q, v)
        },
        "at the start `g = 0` (line 3) has a gradient that vanishes where it holds, and can't be \
         followed from there; if it says that a square is zero, write what is squared; else \
         check the parameters",
    ),
    (
        "AssemblyError::Start",
        "an equation of `start` that is NaN",
        || {
            let (q, v) = near(1.0, 0.0);
            let point = Point {
                wanted: Some([f64::NAN, 0.0]),
                ..Point::on(circle)
            };
            refused(point, q, v)
        },
        "an equation of `start`, or a constraint or the mass matrix, is infinite or NaN at t = 0 \
         s; check the values in `start` and the parameters",
    ),
    (
        "AssemblyError::Start",
        "`x^2 + y^2 = 1` with `x = 0.3;` held and the equation `y = height;` with `height` 0.5",
        || {
            let point = Point {
                wanted: Some([0.5, 0.0]),
                ..Point::on(circle)
            };
            refused(point, [hold(0.3), guess(1.0)], [guess(0.0); 2])
        },
        "no position near the start satisfies the constraints and the equations of `start`: `g = \
         0` (line 3) is off by …; these held values contradict each other or the parameters: x; \
         turn one of them into a guess (`~`)",
    ),
    (
        "AssemblyError::Start",
        "`x^2 + y^2 = 1` with `der(y) = 0.25;` held and the equation `der(y) = speed;` with `speed` 0.5",
        || {
            let point = Point {
                wanted: Some([0.0, 0.5]),
                ..Point::on(circle)
            };
            refused(point, [hold(1.0), guess(0.0)], [guess(0.0), hold(0.25)])
        },
        "no velocities near the start satisfy the constraints and the equations of `start`: \
         `der(y) = speed` (line 9) is off by -0.25 per second; these held values contradict each \
         other or the parameters: der(y); turn one of them into a guess (`~`)",
    ),
    (
        "AssemblyError::NegativeInertia",
        "a mass of -1 kg along `x`",
        || {
            let (q, v) = near(0.0, 0.0);
            refused(
                Point {
                    mass: [-1.0, 1.0],
                    ..Point::on(line)
                },
                q,
                v,
            )
        },
        "at t = 0 s the kinetic energy is negative where `x` moves; check the signs of masses \
         and moments of inertia among the parameters, and of the terms of `kinetic`",
    ),
];
