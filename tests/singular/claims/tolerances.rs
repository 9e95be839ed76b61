//! Each tolerance of the runtime is needed at about its value: the test with its name fails
//! if it alone is a lot smaller or larger. `tests/singular/mutate` shows that.

use crate::SEED;
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    ConstraintRow, Dop853, DynamicsError, Energy, Integrator, Mechanism, Position, Quantity,
    Settings, Solver, State, Structure, Terms, Tolerance,
};
use bricard_singular::{Score, find, run_all};
use std::sync::LazyLock;

/// Motions whose law of time stops in the singular configuration, which several tolerances
/// are judged by: so many right of so many, at this tolerance.
const STOPS: (&str, (usize, usize), f64) = ("driven_stops", (71, 72), 1e-12);

/// Demands of these runs what [`right`] does; they are made once.
fn stops() {
    static MADE: LazyLock<(usize, usize)> = LazyLock::new(|| {
        let (name, (_, runs), tolerance) = STOPS;
        scores(name, runs, tolerance)
    });
    demand(STOPS, *MADE);
}

/// How many of a series' runs at a tolerance are right, and how many wrong.
fn scores(name: &str, runs: usize, tolerance: f64) -> (usize, usize) {
    let series = find(name).expect("it is a series");
    let ran = run_all(series.trials(SEED, 0..runs, &[tolerance]));
    let count = |score| ran.iter().filter(|ran| ran.verdict.score == score).count();
    (count(Score::Right), count(Score::Wrong))
}

/// Demands that so many of a series' runs at a tolerance are right, and none wrong.
fn right(name: &str, (least, runs): (usize, usize), tolerance: f64) {
    demand(
        (name, (least, runs), tolerance),
        scores(name, runs, tolerance),
    );
}

fn demand(
    (name, (least, runs), tolerance): (&str, (usize, usize), f64),
    (right, wrong): (usize, usize),
) {
    assert_eq!(wrong, 0, "{name} at {tolerance:e}");
    assert!(right >= least, "{name} at {tolerance:e}: {right} of {runs}");
}

/// Sheets are left to themselves too near to singular configurations, or interpolated too
/// far from them.
#[test]
fn window() {
    right("driven_stops", (40, 40), 1e-9);
    right("rest_on", (2, 6), 1e-9);
}

/// Steps pass singular configurations before anyone looks.
#[test]
fn safe_steps() {
    let series = find("knife_edges").expect("it is a series");
    for ran in run_all(series.trials(SEED, 0..series.runs, &[])) {
        assert!(
            !ran.verdict.miscounted(),
            "{}: {:?}",
            ran.trial,
            ran.verdict.passages
        );
    }
}

/// Nodes are singular themselves, or hardly any spacing will do.
#[test]
fn clearance() {
    stops();
}

/// Iterations are given up that would have ended, or followed onto another sheet.
#[test]
fn contraction() {
    right("surfaces_named", (12, 15), 1e-6);
}

/// More digits are asked for than there are.
#[test]
fn round_off() {
    right("cart_short", (20, 20), 1e-9);
}

/// Gaps are taken for crossings, or the other way round.
#[test]
fn critical() {
    right("gaps", (42, 72), 1e-9);
    right("rest_on", (2, 6), 1e-9);
}

/// The search for a better spacing ends too early.
#[test]
fn resolved() {
    stops();
}

/// Interpolations are asked for more digits than they have, or for too few.
#[test]
fn resolvable() {
    stops();
    right("curves_named", (15, 15), 1e-12);
}

/// Differences do not show how rows change: round-off hides it, or curvature.
#[test]
fn difference() {
    right("products", (20, 20), 1e-9);
}

/// Rows count as dependent where they are only weak: crossings and gaps are looked for with
/// ranks that are too small.
#[test]
fn regular() {
    right("curves", (59, 60), 1e-9);
    right("unlike_almost_parallelogram", (98, 100), 1e-9);
}

/// A length.
const fn length(name: &'static str) -> Quantity {
    let unit = "m";
    Quantity {
        name,
        unit,
        docs: "",
    }
}

/// A constraint on positions.
const fn row(text: &'static str) -> ConstraintRow {
    ConstraintRow {
        text,
        line: 1,
        holonomic: true,
    }
}

/// A bead on a line that is written twice, in forms that come apart with time.
struct Apart;

static APART: Structure = Structure {
    name: "Apart",
    coordinates: &[length("x"), length("y")],
    constraints: &[row("y = 0"), row("y = 1e-6*t^2")],
    ..Structure::PLAIN
};

impl Mechanism<f64, 2, 2> for Apart {
    fn structure(&self) -> &'static Structure {
        &APART
    }

    fn terms(&self, _state: &State<f64, 2>, out: &mut Terms<f64, 2, 2>) {
        out.mass = SMatrix::identity();
        out.jacobian = SMatrix::from([[0.0, 0.0], [1.0, 1.0]]);
        out.bias[1] = 2e-6;
    }

    fn position(&self, state: &State<f64, 2>, out: &mut Position<f64, 2, 2>) {
        out.mass = SMatrix::identity();
        out.jacobian = SMatrix::from([[0.0, 0.0], [1.0, 1.0]]);
        out.residual = [state.q[1], state.q[1] - 1e-6 * state.t * state.t].into();
        out.drift[1] = -2e-6 * state.t;
    }

    fn energy(&self, state: &State<f64, 2>) -> Energy<f64> {
        let kinetic = 0.5 * state.v.norm_squared();
        Energy {
            kinetic,
            balance: kinetic,
            ..Energy::default()
        }
    }
}

/// Constraint errors pass that are no round-off.
#[test]
fn negligible() {
    let mut solver: Solver<f64, 2, 2> = Solver::new(Settings::default());
    let mut system = solver.on(&Apart);
    let mut method = Dop853::adaptive(Tolerance::uniform(1e-9, 1e-9).expect("it is one"));
    let mut state = State::new(0.0, [1.0, 0.0].into(), [1.0, 0.0].into());
    let failed = loop {
        match method.step(&mut system, &state, 1.0) {
            Ok(step) => state = *step.end(),
            Err(error) => break format!("{error:?}"),
        }
        assert!(state.t < 1.0, "the forms are a millionth apart");
    };
    assert!(failed.contains("ProjectionFailed"), "{failed}");
}

/// Two heavy masses that a light one connects.
struct Connected;

static CONNECTED: Structure = Structure {
    name: "Connected",
    coordinates: &[length("a"), length("b"), length("between")],
    constraints: &[row("a = between"), row("b = between")],
    ..Structure::PLAIN
};

impl Mechanism<f64, 3, 2> for Connected {
    fn structure(&self) -> &'static Structure {
        &CONNECTED
    }

    fn terms(&self, state: &State<f64, 3>, out: &mut Terms<f64, 3, 2>) {
        let mut at = Position::default();
        self.position(state, &mut at);
        (out.mass, out.jacobian) = (at.mass, at.jacobian);
    }

    fn position(&self, state: &State<f64, 3>, out: &mut Position<f64, 3, 2>) {
        out.mass = SMatrix::from_diagonal(&SVector::from([1e8, 1e8, 1.0]));
        out.jacobian = SMatrix::from([[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]]);
        out.residual = out.jacobian * state.q;
    }

    fn energy(&self, _state: &State<f64, 3>) -> Energy<f64> {
        Energy::default()
    }
}

/// Rows look dependent because of the masses that they connect.
#[test]
fn disproportionate() -> Result<(), DynamicsError<f64>> {
    let mut solver: Solver<f64, 3, 2> = Solver::new(Settings::default());
    let state = State::new(0.0, [1.0; 3].into(), [0.0; 3].into());
    let rank = solver.on(&Connected).rank(&state)?;
    assert_eq!(rank.rank, 2);
    assert!(rank.sine > 0.1, "{rank:?}");
    Ok(())
}
