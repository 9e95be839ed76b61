//! A point in the plane of which everything can be spoilt.

use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    Condition, ConstraintRow, Direction, Discontinuity, Energy, Event, Mechanism, Position,
    Quantity, Sides, Start, StartEquations, StartFault, State, Structure, Switches, Terms, meet,
};

/// A function of the position: its value, gradient and second derivatives.
pub struct Jet(
    pub f64,
    pub SVector<f64, 2>,
    pub [[f64; 2]; 2],
    /// The derivative by time.
    pub f64,
);

/// A mass in the plane on one constraint.
#[derive(Clone, Copy)]
pub struct Point {
    pub structure: &'static Structure,
    /// Masses that move along `x` and `y`.
    pub mass: [f64; 2],
    pub constraint: fn(&State<f64, 2>) -> Jet,
    pub force: fn(&State<f64, 2>, Sides) -> [f64; 2],
    /// What is added to the energies.
    pub spoil: fn(&State<f64, 2>, &mut Energy<f64>),
    pub events: fn(&State<f64, 2>, &mut [f64]),
    /// What decides the condition of the force, if it has one.
    pub side: Option<fn(&State<f64, 2>) -> f64>,
    /// Where the `start` block wants `y`, and the speed along it.
    pub wanted: Option<[f64; 2]>,
}

impl Point {
    /// A unit mass without forces.
    pub fn on(constraint: fn(&State<f64, 2>) -> Jet) -> Self {
        Self {
            structure: &POINT,
            mass: [1.0; 2],
            constraint,
            force: |_, _| [0.0; 2],
            spoil: |_, _| (),
            events: |_, values| values.fill(1.0),
            side: None,
            wanted: None,
        }
    }
}

const fn length(name: &'static str) -> Quantity {
    Quantity {
        name,
        unit: "",
        docs: "",
    }
}

const fn row(text: &'static str, line: u32) -> ConstraintRow {
    ConstraintRow {
        text,
        line,
        holonomic: true,
    }
}

const HIT: Event = Event {
    name: "hit",
    direction: Direction::Crossing,
};

/// What is known of a point: lengths, and no more.
pub static POINT: Structure = Structure {
    name: "Point",
    scleronomic: true,
    coordinates: &[length("x"), length("y")],
    constraints: &[row("g = 0", 3)],
    ..Structure::PLAIN
};

pub static REGULAR: Structure = Structure {
    assumed_regular: true,
    ..POINT
};

pub static WITH_ANGLE: Structure = Structure {
    coordinates: &[Quantity {
        name: "phi",
        unit: "rad",
        docs: "",
    }],
    ..POINT
};

pub static WITH_EVENT: Structure = Structure {
    events: &[HIT],
    ..POINT
};

pub static WITH_MANY_EVENTS: Structure = Structure {
    events: &[HIT; 65],
    ..POINT
};

/// The constraint, and the equation of the `start` block for a position or a velocity.
static WITH_START: [Structure; 2] = [
    Structure {
        constraints: &[row("g = 0", 3), row("y = height", 8)],
        ..POINT
    },
    Structure {
        constraints: &[row("g = 0", 3), row("der(y) = speed", 9)],
        ..POINT
    },
];

static CONDITIONS: [Condition; 1] = [Condition {
    text: "if x < 1/2",
    line: 5,
    discontinuity: Discontinuity::Jump,
    of_time: false,
}];

impl Mechanism<f64, 2, 1> for Point {
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    fn terms(&self, state: &State<f64, 2>, out: &mut Terms<f64, 2, 1>) {
        let Jet(_, gradient, second, _) = (self.constraint)(state);
        let bend = SMatrix::from(second) * state.v;
        out.mass = SMatrix::from_diagonal(&self.mass.into());
        out.force = (self.force)(state, out.sides).into();
        out.jacobian = gradient.transpose();
        out.bias[0] = -state.v.dot(&bend);
    }

    fn position(&self, state: &State<f64, 2>, out: &mut Position<f64, 2, 1>) {
        let Jet(value, gradient, _, rate) = (self.constraint)(state);
        out.mass = SMatrix::from_diagonal(&self.mass.into());
        out.residual[0] = value;
        out.jacobian = gradient.transpose();
        out.drift[0] = rate;
    }

    fn begin(&self, start: &mut Start<f64, 2>, t: f64) -> Result<(), StartFault<f64, 2>> {
        let [positions, velocities] = &WITH_START;
        match self.wanted {
            Some(_) => meet::<_, _, 2, 1, 2, 2>(self, [positions, velocities], start, t),
            None => Ok(()),
        }
    }

    fn switches(
        &self,
        state: &State<f64, 2>,
        _acceleration: &SVector<f64, 2>,
        out: &mut Switches<'_, f64>,
    ) -> &'static [Condition] {
        let Some(side) = self.side else {
            return &[];
        };
        if let [first, ..] = out.values {
            first.value = side(state);
            first.rate = state.v[0];
        }
        &CONDITIONS
    }

    fn energy(&self, state: &State<f64, 2>) -> Energy<f64> {
        let mass = SMatrix::from_diagonal(&self.mass.into());
        let kinetic = 0.5 * state.v.dot(&(mass * state.v));
        let mut energy = Energy {
            kinetic,
            balance: kinetic,
            ..Energy::default()
        };
        (self.spoil)(state, &mut energy);
        energy
    }
}

impl StartEquations<f64, 2> for Point {
    fn position_errors(&self, state: &State<f64, 2>, values: &mut [f64]) {
        values[0] = state.q[1] - self.wanted.map_or(0.0, |wanted| wanted[0]);
    }

    fn position_slopes(&self, _state: &State<f64, 2>, values: &mut [f64]) {
        values.copy_from_slice(&[0.0, 1.0]);
    }

    fn velocity_errors(&self, _state: &State<f64, 2>, values: &mut [f64]) {
        values[0] = -self.wanted.map_or(0.0, |wanted| wanted[1]);
    }

    fn velocity_slopes(&self, _state: &State<f64, 2>, values: &mut [f64]) {
        values.copy_from_slice(&[0.0, 1.0]);
    }
}

/// `y = 0`.
pub fn line(state: &State<f64, 2>) -> Jet {
    Jet(state.q[1], [0.0, 1.0].into(), [[0.0; 2]; 2], 0.0)
}

/// A circle of radius one about the origin.
pub fn circle(state: &State<f64, 2>) -> Jet {
    let q = &state.q;
    Jet(
        q.norm_squared() - 1.0,
        q * 2.0,
        [[2.0, 0.0], [0.0, 2.0]],
        0.0,
    )
}

/// A circle of radius one about the origin, written as a square that is zero.
pub fn squared(state: &State<f64, 2>) -> Jet {
    let Jet(u, slope, _, _) = circle(state);
    let second = slope * slope.transpose() * 2.0 + SMatrix::identity() * (4.0 * u);
    Jet(u * u, slope * (2.0 * u), second.into(), 0.0)
}

/// Two lines that cross at (1, 1).
pub fn crossing(state: &State<f64, 2>) -> Jet {
    let (x, y) = (state.q[0] - 1.0, state.q[1] - 1.0);
    Jet(x * y, [y, x].into(), [[0.0, 1.0], [1.0, 0.0]], 0.0)
}

/// Two lines that cross at (1, 1), at 45° to the axes.
pub fn diagonals(state: &State<f64, 2>) -> Jet {
    let (x, y) = (state.q[0] - 1.0, state.q[1] - 1.0);
    Jet(
        y * y - x * x,
        [-2.0 * x, 2.0 * y].into(),
        [[-2.0, 0.0], [0.0, 2.0]],
        0.0,
    )
}

/// Three lines that meet at (1, 1).
pub fn three_lines(state: &State<f64, 2>) -> Jet {
    let (x, y) = (state.q[0] - 1.0, state.q[1] - 1.0);
    Jet(
        x * (y * y - x * x),
        [y * y - 3.0 * x * x, 2.0 * x * y].into(),
        [[-6.0 * x, 2.0 * y], [2.0 * y, 2.0 * x]],
        0.0,
    )
}

/// A curve that turns back at (1, 1).
pub fn cusp(state: &State<f64, 2>) -> Jet {
    let (x, y) = (state.q[0] - 1.0, state.q[1] - 1.0);
    Jet(
        y * y - x * x * x,
        [-3.0 * x * x, 2.0 * y].into(),
        [[-6.0 * x, 0.0], [0.0, 2.0]],
        0.0,
    )
}

/// Two lines that cross at (1, 1), one of them written twice.
pub fn doubled(state: &State<f64, 2>) -> Jet {
    let (x, y) = (state.q[0] - 1.0, state.q[1] - 1.0);
    Jet(
        x * x * y,
        [2.0 * x * y, x * x].into(),
        [[2.0 * y, 2.0 * x], [2.0 * x, 0.0]],
        0.0,
    )
}

/// Two lines that meet in a corner at the origin.
pub fn corner(state: &State<f64, 2>) -> Jet {
    let (x, y) = (state.q[0], state.q[1]);
    Jet(y - x.abs(), [-x.signum(), 1.0].into(), [[0.0; 2]; 2], 0.0)
}

/// `y = 0`, which has no solution after t = 1/2.
pub fn torn(state: &State<f64, 2>) -> Jet {
    let mut jet = line(state);
    if state.t > 0.5 {
        jet.0 += 0.1_f64.copysign(jet.0);
    }
    jet
}
