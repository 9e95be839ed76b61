//! Constraints whose gradient vanishes wherever they hold restrict no motion, and are
//! refused; those whose gradient vanishes at one place are passed.

use crate::fixtures::{Framed, PLAIN, simulate};
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    AssemblyError, ConstraintRow, DynamicsError, Energy, Initial, IntegrateError, Mechanism,
    Options, Position, Quantity, SimulateError, Singularity, Start, State, Structure, Terms,
    assemble,
};

/// Two coordinates without units, so that they may be angles and the usual size of the
/// row is that at other angles.
static LOOSE: Structure = Structure {
    coordinates: &[coordinate("x"), coordinate("y")],
    constraints: &[ConstraintRow {
        text: "u^n = e",
        line: 7,
        holonomic: true,
    }],
    conservative: true,
    scleronomic: true,
    ..PLAIN
};

const fn coordinate(name: &'static str) -> Quantity {
    Quantity {
        name,
        unit: "",
        docs: "",
    }
}

/// A value, its gradient and its second derivatives.
type Jet = (f64, SVector<f64, 2>, SMatrix<f64, 2, 2>);

/// A unit mass in the plane with one constraint `u^n = excess`, where `u` is a function of
/// the position with a constant matrix of second derivatives.
#[derive(Clone, Copy, Debug)]
struct Power {
    /// `u`, its gradient and its second derivatives.
    u: fn(&SVector<f64, 2>) -> Jet,
    n: i32,
    excess: f64,
}

impl Power {
    fn gradient(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        let (u, slope, _) = (self.u)(q);
        slope * (f64::from(self.n) * u.powi(self.n - 1))
    }
}

impl Mechanism<f64, 2, 1> for Power {
    fn structure(&self) -> &'static Structure {
        &LOOSE
    }

    fn terms(&self, state: &State<f64, 2>, out: &mut Terms<f64, 2, 1>) {
        let (u, slope, second) = (self.u)(&state.q);
        let (n, rate) = (f64::from(self.n), slope.dot(&state.v));
        let bend = state.v.dot(&(second * state.v));
        let curved = if self.n > 1 {
            (n - 1.0) * u.powi(self.n - 2)
        } else {
            0.0
        };
        out.mass = SMatrix::identity();
        out.force[1] = -9.81;
        out.jacobian = self.gradient(&state.q).transpose();
        out.bias[0] = -n * (curved * rate * rate + u.powi(self.n - 1) * bend);
    }

    fn position(&self, state: &State<f64, 2>, out: &mut Position<f64, 2, 1>) {
        out.mass = SMatrix::identity();
        out.residual[0] = (self.u)(&state.q).0.powi(self.n) - self.excess;
        out.jacobian = self.gradient(&state.q).transpose();
    }

    fn energy(&self, state: &State<f64, 2>) -> Energy<f64> {
        let (kinetic, potential) = (0.5 * state.v.norm_squared(), 9.81 * state.q[1]);
        crate::mechanisms::supplied(kinetic, potential, 0.0)
    }
}

fn circle(q: &SVector<f64, 2>) -> Jet {
    (q.norm_squared() - 1.0, q * 2.0, SMatrix::identity() * 2.0)
}

fn cross(q: &SVector<f64, 2>) -> Jet {
    let (x, y) = (q[0] - 1.0, q[1] - 1.0);
    (x * y, [y, x].into(), [[0.0, 1.0], [1.0, 0.0]].into())
}

/// Zero at one place alone.
fn distance(q: &SVector<f64, 2>) -> Jet {
    let away = q - SVector::from([1.0, 1.0]);
    (away.norm_squared(), away * 2.0, SMatrix::identity() * 2.0)
}

/// Two parabolas that touch.
fn touching(q: &SVector<f64, 2>) -> Jet {
    let (x, y) = (q[0] - 1.0, q[1] - 1.0);
    let slope = [-4.0 * x.powi(3), 2.0 * y].into();
    (
        y * y - x.powi(4),
        slope,
        [[-12.0 * x * x, 0.0], [0.0, 2.0]].into(),
    )
}

fn state(q: [f64; 2], v: [f64; 2]) -> State<f64, 2> {
    State::new(0.0, q.into(), v.into())
}

#[test]
fn a_gradient_that_vanishes_wherever_the_constraint_holds_is_refused_at_the_start() {
    let twice = Power {
        u: circle,
        n: 2,
        excess: 0.0,
    };
    let point = Power {
        u: distance,
        n: 1,
        excess: 0.0,
    };
    for (mechanism, start) in [
        (twice, state([0.6, 0.8], [0.0, 0.0])),
        (twice, state([0.6, 0.8], [0.8, -0.6])),
        (point, state([1.0, 1.0], [0.0, 0.0])),
        (point, state([1.0 - 1e-16, 1.0 + 2e-16], [0.0, 0.0])),
    ] {
        for options in [Options::rk4(2.0, 0.01), Options::dp5(2.0, 1e-8)] {
            let mechanism = Framed::new(mechanism, &LOOSE);
            let failure = simulate::<2, 1>(&mechanism, &start, &options, &mut [])
                .expect_err("it restricts nothing");
            let SimulateError::Integrate(IntegrateError::Dynamics(
                DynamicsError::SingularConfiguration { t, kind, row, .. },
            )) = failure.error
            else {
                panic!("{failure:?}");
            };
            assert_eq!((t, kind, row), (0.0, Singularity::Vanishing, 0));
            let said = failure.to_string();
            assert!(
                said.contains("vanishes not only here but wherever it holds"),
                "{said}"
            );
        }
    }
}

#[test]
fn the_same_constraint_is_obeyed_where_its_gradient_does_not_vanish() {
    let mechanism = Framed::new(
        Power {
            u: circle,
            n: 2,
            excess: 0.25,
        },
        &LOOSE,
    );
    let start = state([1.5_f64.sqrt(), 0.0], [0.0, 0.0]);
    let options = Options::dop853(2.0, 1e-11);
    let summary = simulate::<2, 1>(&mechanism, &start, &options, &mut [])
        .unwrap_or_else(|failure| panic!("{failure}"));
    assert!((summary.end.q.norm_squared() - 1.5).abs() < 1e-13);
}

#[test]
fn a_start_where_two_lines_cross_is_not_refused() {
    let mechanism = Framed::new(
        Power {
            u: cross,
            n: 1,
            excess: 0.0,
        },
        &LOOSE,
    );
    let options = Options::dop853(1.0, 1e-11);
    let start = state([1.0, 1.0], [1.0, 0.0]);
    let summary = simulate::<2, 1>(&mechanism, &start, &options, &mut [])
        .unwrap_or_else(|failure| panic!("{failure}"));
    assert!(
        (summary.end.q - SVector::from([2.0, 1.0])).norm() < 1e-9,
        "{:?}",
        summary.end
    );
}

#[test]
fn parabolas_that_touch_are_not_taken_for_a_square() {
    let mechanism = Framed::new(
        Power {
            u: touching,
            n: 1,
            excess: 0.0,
        },
        &LOOSE,
    );
    let start = state([1.0, 1.0], [1.0, 0.0]);
    let failure = simulate::<2, 1>(&mechanism, &start, &Options::rk4(1.0, 0.01), &mut [])
        .expect_err("nothing tells which one is meant");
    let vanishing = format!("{:?}", failure.error).contains("Vanishing");
    assert!(!vanishing, "{failure}");
}

/// Lengths, so that nothing but the guess tells how large rows are.
static LENGTHS: Structure = Structure {
    coordinates: &[length("x"), length("y")],
    ..LOOSE
};

const fn length(name: &'static str) -> Quantity {
    Quantity {
        name,
        unit: "m",
        docs: "",
    }
}

/// Assembles the mechanism from a guess.
fn assembled(power: Power, q: [f64; 2]) -> Result<State<f64, 2>, AssemblyError<f64, 2, 1>> {
    let guess = |value| Initial { value, held: false };
    let start = Start {
        q: q.map(guess),
        v: [guess(0.0); 2],
    };
    assemble(&Framed::new(power, &LENGTHS), &start, 0.0)
}

#[test]
fn a_guess_that_leads_to_where_the_gradient_vanishes_is_refused_if_nothing_crosses_there() {
    let power = |u, n| Power { u, n, excess: 0.0 };
    for mechanism in [power(distance, 1), power(circle, 2), power(distance, 2)] {
        let error = assembled(mechanism, [2.3, 1.4]).expect_err("it can't be crossed");
        assert!(
            matches!(error, AssemblyError::Vanishing { row: 0, .. }),
            "{error:?}"
        );
        assert!(
            error.to_string().contains("write what is squared"),
            "{error}"
        );
    }
    // Where lines cross, or parabolas touch, the motion has somewhere to go.
    for mechanism in [power(cross, 1), power(touching, 1)] {
        for guess in [[1.3, 1.3], [2.3, 1.4], [0.4, 1.0]] {
            assembled(mechanism, guess).unwrap_or_else(|error| panic!("{guess:?}: {error}"));
        }
    }
}

/// A circle through the origin whose equation does not vanish there to the last bit.
fn wheel(q: &SVector<f64, 2>) -> Jet {
    let (x, y) = (q[0] - 0.7, q[1] - 0.1);
    let value = x * x + y * y - 0.5;
    (value, [2.0 * x, 2.0 * y].into(), SMatrix::identity() * 2.0)
}

/// Two lines that cross at the origin.
fn lines(q: &SVector<f64, 2>) -> Jet {
    (
        q[0] * q[1],
        [q[1], q[0]].into(),
        [[0.0, 1.0], [1.0, 0.0]].into(),
    )
}

/// Runs from a start where all coordinates are lengths that are zero.
fn from_nowhere(u: fn(&SVector<f64, 2>) -> Jet, v: [f64; 2]) -> Result<State<f64, 2>, String> {
    let mechanism = Framed::new(
        Power {
            u,
            n: 1,
            excess: 0.0,
        },
        &LENGTHS,
    );
    let options = Options::dop853(1.0, 1e-10);
    let ran = simulate::<2, 1>(&mechanism, &state([0.0; 2], v), &options, &mut []);
    ran.map(|summary| summary.end)
        .map_err(|failure| failure.error.to_string())
}

#[test]
fn a_start_where_all_coordinates_are_lengths_of_zero_has_a_scale() {
    for speed in [1e-3, 1.0, 1e3] {
        let end = from_nowhere(wheel, [speed, -7.0 * speed]).expect("the circle is smooth");
        let (residual, ..) = wheel(&end.q);
        let gained = 0.5 * (end.v.norm_squared() - 50.0 * speed * speed) + 9.81 * end.q[1];
        assert!(residual.abs() < 1e-15, "{end:?}");
        assert!(
            gained.abs() < 1e-8 * (1.0 + 50.0 * speed * speed),
            "{end:?}"
        );
    }
}

#[test]
fn a_start_where_lines_of_lengths_cross_at_zero_is_refused() {
    for v in [[0.0, 0.0], [1.0, 0.0]] {
        let error = from_nowhere(lines, v).expect_err("nothing tells how long the row is");
        assert!(
            error.contains("nothing tells which of the branches"),
            "{error}"
        );
    }
}
