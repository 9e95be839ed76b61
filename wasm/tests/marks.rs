//! What happens in a run, by the functions of a module: all of it, once, however much it is.

use bricard_runtime::nalgebra::SMatrix;
use bricard_runtime::{
    Canvas, ConstraintRow, Direction, Energy, Event, Initial, Interface, Mechanism, Position,
    Quantity, Start, State, Structure, Terms,
};
use bricard_wasm::{ROOM, Session};
use std::f64::consts::PI;

const fn quantity(name: &'static str) -> Quantity {
    let (unit, docs) = ("", "");
    Quantity { name, unit, docs }
}

const fn row(text: &'static str, line: u32) -> ConstraintRow {
    let holonomic = true;
    ConstraintRow {
        text,
        line,
        holonomic,
    }
}

/// A mass that drifts along z, held by `x = 0` and `x + slope·y = 0`; the event is that
/// `cos(rate·t)` changes its sign.
#[derive(Clone, Copy)]
struct Clock {
    rate: f64,
    slope: f64,
}

static STRUCTURE: Structure = Structure {
    name: "Clock",
    coordinates: &[quantity("x"), quantity("y"), quantity("z")],
    constraints: &[row("x = 0", 1), row("x + slope*y = 0", 2)],
    events: &[Event {
        name: "tick",
        direction: Direction::Crossing,
    }],
    constant_mass: true,
    ..Structure::PLAIN
};

impl Clock {
    fn jacobian(&self) -> SMatrix<f64, 2, 3> {
        SMatrix::from_row_slice(&[1.0, 0.0, 0.0, 1.0, self.slope, 0.0])
    }
}

impl Mechanism<f64, 3, 2> for Clock {
    fn structure(&self) -> &'static Structure {
        &STRUCTURE
    }

    fn terms(&self, _: &State<f64, 3>, out: &mut Terms<f64, 3, 2>) {
        out.mass = SMatrix::identity();
        out.jacobian = self.jacobian();
    }

    fn position(&self, state: &State<f64, 3>, out: &mut Position<f64, 3, 2>) {
        out.mass = SMatrix::identity();
        out.jacobian = self.jacobian();
        out.residual = self.jacobian() * state.q;
    }

    fn energy(&self, state: &State<f64, 3>) -> Energy<f64> {
        let kinetic = state.v.norm_squared() / 2.0;
        Energy {
            kinetic,
            potential: 0.0,
            balance: kinetic,
            power: 0.0,
        }
    }
}

impl Interface<f64, 3> for Clock {
    fn parameter(&self, _: usize) -> Option<f64> {
        None
    }

    fn set_parameter(&mut self, _: usize, _: f64) -> bool {
        false
    }

    fn set_input(&mut self, _: usize, _: Option<f64>) -> bool {
        false
    }

    fn start(&self) -> Start<f64, 3> {
        let held = |value| Initial { value, held: true };
        Start {
            q: [0.0; 3].map(held),
            v: [0.0, 0.0, 1.0].map(held),
        }
    }

    fn outputs(&self, _: &State<f64, 3>, _: &mut [f64]) {}

    fn events(&self, state: &State<f64, 3>, values: &mut [f64]) {
        values[0] = (self.rate * state.t).cos();
    }

    fn draw(&self, _: &State<f64, 3>, _: &mut dyn Canvas<f64>) {}
}

/// Times of events, and of rows, over ten seconds in fixed steps; how many pieces it took.
fn run(clock: Clock, step: f64, every: f64) -> (Vec<f64>, Vec<f64>, usize) {
    const RK4: u32 = 0;
    let numbers = vec![0.0; ROOM].into_boxed_slice();
    let numbers: Box<[f64; ROOM]> = numbers.try_into().expect("they are as many");
    let mut session = Session::new(clock, Box::leak(numbers));
    assert_eq!(session.fixed(RK4, step), 0);
    assert_eq!(session.assemble(), 0, "{}", session.told());
    let (mut ticks, mut rows, mut pieces) = (Vec::new(), Vec::new(), 0);
    loop {
        let again = u32::from(pieces > 0);
        assert_eq!(session.run(10.0, every, 0, again), 0, "{}", session.told());
        let width = session.width(0) as usize;
        let numbers = &session.read()[..session.rows() as usize * width];
        rows.extend(numbers.chunks(width).map(|row| row[0]));
        let count = 2 * session.marks() as usize;
        let marks = session.read()[..count].chunks(2);
        ticks.extend(marks.filter(|mark| mark[0] == 1.0).map(|mark| mark[1]));
        pieces += 1;
        if session.unfinished() == 0 {
            return (ticks, rows, pieces);
        }
    }
}

/// Every sign change is told once, and there is a row at every multiple of an interval.
fn check(clock: Clock, step: f64, every: f64) {
    let (ticks, rows, pieces) = run(clock, step, every);
    assert!(pieces > 1, "{pieces}");
    assert_eq!(ticks.len(), (10.0 * clock.rate / PI + 0.5) as usize);
    for (place, t) in ticks.iter().enumerate() {
        let exact = (place as f64 + 0.5) * PI / clock.rate;
        assert!((t - exact).abs() < 1e-9, "{place}: {t} for {exact}");
    }
    assert_eq!(rows.len(), (10.0 / every).round() as usize + 1);
    for (place, t) in rows.iter().enumerate() {
        assert!((t - place as f64 * every).abs() < 1e-12, "{place}: {t}");
    }
}

#[test]
fn all_events_of_a_long_run_are_told() {
    let (rate, slope) = (2000.0, 1.0);
    check(Clock { rate, slope }, 1e-3, 0.1);
}

#[test]
fn all_events_are_told_where_no_step_ends_away_from_singular_positions() {
    let (rate, slope) = (2000.0, 0.05);
    check(Clock { rate, slope }, 1e-3, 0.1);
}

#[test]
fn an_event_of_a_step_that_is_cut_by_its_rows_is_told_once() {
    let (rate, slope) = (19.0, 1.0);
    check(Clock { rate, slope }, 0.1, 1e-5);
}
