//! Systems with closed forms, and mechanisms written by hand.

use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    Canvas, ConstraintRow, DynamicsError, Energy, Initial, Interface, Mechanism, Position,
    Quantity, Start, State, Structure, System, Terms,
};

/// A system given by a function of the state, without constraints.
pub struct Free<F>(pub F);

impl<F, const N: usize> System<f64, N> for Free<F>
where
    F: FnMut(&State<f64, N>) -> SVector<f64, N>,
{
    fn acceleration(
        &mut self,
        state: &State<f64, N>,
    ) -> Result<SVector<f64, N>, DynamicsError<f64>> {
        let a = (self.0)(state);
        match a.iter().all(|x| x.is_finite()) {
            true => Ok(a),
            false => Err(DynamicsError::NotFinite { t: state.t }),
        }
    }

    fn project(&mut self, _state: &mut State<f64, N>) -> Result<(), DynamicsError<f64>> {
        Ok(())
    }
}

/// Kepler's problem, eccentricity `e`, gravitational parameter 1, semi-major
/// axis 1: the start at the pericentre.
pub fn kepler_start(e: f64) -> State<f64, 2> {
    let speed = ((1.0 + e) / (1.0 - e)).sqrt();
    State::new(
        0.0,
        SVector::from([1.0 - e, 0.0]),
        SVector::from([0.0, speed]),
    )
}

/// The acceleration of Kepler's problem.
pub fn kepler(state: &State<f64, 2>) -> SVector<f64, 2> {
    let r = state.q.norm();
    -state.q / (r * r * r)
}

/// The exact state of Kepler's problem, from Kepler's equation.
pub fn kepler_exact(e: f64, t: f64) -> State<f64, 2> {
    let mut anomaly = t + e * t.sin();
    for _ in 0..50 {
        anomaly -= (anomaly - e * anomaly.sin() - t) / (1.0 - e * anomaly.cos());
    }
    let (s, c) = anomaly.sin_cos();
    let (b, rate) = ((1.0 - e * e).sqrt(), 1.0 / (1.0 - e * c));
    State::new(
        t,
        SVector::from([c - e, b * s]),
        SVector::from([-s * rate, b * c * rate]),
    )
}

/// The largest difference between two states, in any component.
pub fn distance<const N: usize>(a: &State<f64, N>, b: &State<f64, N>) -> f64 {
    (a.q - b.q).amax().max((a.v - b.v).amax())
}

/// A mechanism with what a program needs besides its equations.
#[derive(Clone, Copy, Debug)]
pub struct Framed<M, const N: usize> {
    /// The equations.
    pub mechanism: M,
    /// What [`Mechanism::structure`] returns.
    pub structure: &'static Structure,
    /// The event functions.
    pub events: fn(&State<f64, N>, &mut [f64]),
    /// A constant generalized force that a program may set, on coordinate 0.
    pub input: f64,
}

impl<M, const N: usize> Framed<M, N> {
    /// A mechanism without events.
    pub fn new(mechanism: M, structure: &'static Structure) -> Self {
        Self {
            mechanism,
            structure,
            events: |_, _| (),
            input: 0.0,
        }
    }
}

impl<M: Mechanism<f64, N, R>, const N: usize, const R: usize> Mechanism<f64, N, R>
    for Framed<M, N>
{
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        self.mechanism.terms(state, out);
        out.force[0] += self.input;
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        self.mechanism.position(state, out);
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        let mut energy = self.mechanism.energy(state);
        energy.power += self.input * state.v[0];
        energy
    }
}

impl<M, const N: usize> Interface<f64, N> for Framed<M, N> {
    fn parameter(&self, _index: usize) -> Option<f64> {
        None
    }

    fn set_parameter(&mut self, _index: usize, _value: f64) -> bool {
        false
    }

    fn set_input(&mut self, index: usize, value: Option<f64>) -> bool {
        self.input = value.unwrap_or(0.0);
        index == 0
    }

    fn start(&self) -> Start<f64, N> {
        let guess = Initial {
            value: 0.0,
            held: false,
        };
        Start {
            q: [guess; N],
            v: [guess; N],
        }
    }

    fn outputs(&self, _state: &State<f64, N>, _values: &mut [f64]) {}

    fn events(&self, state: &State<f64, N>, values: &mut [f64]) {
        (self.events)(state, values);
    }

    fn draw(&self, _state: &State<f64, N>, _canvas: &mut dyn Canvas<f64>) {}
}

/// A point on a wire that moves: unit mass in the plane, `y = rise·t` if
/// `radius` is zero, else the circle of that radius about the origin, without
/// gravity.
#[derive(Clone, Copy, Debug)]
pub struct Bead {
    /// Radius of the circle, or zero for the rising wire.
    pub radius: f64,
    /// Speed of the rising wire.
    pub rise: f64,
    /// Weight of the bead.
    pub weight: f64,
}

/// Structure of the bead: two lengths, one constraint.
pub static BEAD: Structure = Structure {
    coordinates: &[
        Quantity {
            name: "x",
            unit: "m",
            docs: "",
        },
        Quantity {
            name: "y",
            unit: "m",
            docs: "",
        },
    ],
    constraints: &[ConstraintRow {
        text: "x^2 + y^2 = r^2",
        line: 7,
        holonomic: true,
    }],
    conservative: true,
    ..PLAIN
};

/// Structure of the bead on the moving wire: time occurs.
pub static MOVING_BEAD: Structure = Structure {
    conservative: false,
    constraints: &[ConstraintRow {
        text: "y = rise*t",
        line: 3,
        holonomic: true,
    }],
    ..BEAD
};

/// A structure that says nothing.
pub const PLAIN: Structure = Structure {
    name: "Toy",
    ..Structure::PLAIN
};

impl Mechanism<f64, 2, 1> for Bead {
    fn structure(&self) -> &'static Structure {
        if self.radius == 0.0 {
            &MOVING_BEAD
        } else {
            &BEAD
        }
    }

    fn terms(&self, state: &State<f64, 2>, out: &mut Terms<f64, 2, 1>) {
        let (q, v) = (&state.q, &state.v);
        out.mass = SMatrix::identity();
        out.force = [0.0, -self.weight].into();
        if self.radius == 0.0 {
            out.jacobian = SMatrix::from([[0.0], [1.0]]);
        } else {
            out.jacobian = SMatrix::from([[2.0 * q[0]], [2.0 * q[1]]]);
            out.bias[0] = -2.0 * v.norm_squared();
        }
    }

    fn position(&self, state: &State<f64, 2>, out: &mut Position<f64, 2, 1>) {
        let q = &state.q;
        out.mass = SMatrix::identity();
        if self.radius == 0.0 {
            out.residual[0] = q[1] - self.rise * state.t;
            out.jacobian = SMatrix::from([[0.0], [1.0]]);
            out.drift[0] = -self.rise;
        } else {
            out.residual[0] = q.norm_squared() - self.radius * self.radius;
            out.jacobian = SMatrix::from([[2.0 * q[0]], [2.0 * q[1]]]);
        }
    }

    fn energy(&self, state: &State<f64, 2>) -> Energy<f64> {
        let kinetic = 0.5 * state.v.norm_squared();
        let potential = self.weight * state.q[1];
        Energy {
            kinetic,
            potential,
            balance: kinetic + potential,
            power: 0.0,
        }
    }
}

/// A unit mass on a unit spring, damped: `q̈ = −q − damping·q̇`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Oscillator {
    /// Damping (1/s).
    pub damping: f64,
}

impl Mechanism<f64, 1, 0> for Oscillator {
    fn structure(&self) -> &'static Structure {
        &PLAIN
    }

    fn terms(&self, state: &State<f64, 1>, out: &mut Terms<f64, 1, 0>) {
        out.mass = SMatrix::identity();
        out.force = -state.q - state.v * self.damping;
    }

    fn energy(&self, state: &State<f64, 1>) -> Energy<f64> {
        let (kinetic, potential) = (0.5 * state.v[0].powi(2), 0.5 * state.q[0].powi(2));
        let power = -self.damping * state.v[0].powi(2);
        Energy {
            kinetic,
            potential,
            balance: kinetic + potential,
            power,
        }
    }
}
