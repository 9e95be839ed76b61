//! Errors of runs.

use super::point::{
    POINT, Point, REGULAR, WITH_ANGLE, WITH_EVENT, WITH_MANY_EVENTS, corner, crossing, cusp,
    doubled, line, squared, three_lines, torn,
};
use super::{Case, Said};
use crate::fixtures::{Framed, simulate, system_of};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Dp5, DynamicsError, Form, Integrator, Mechanism, Method, Options, Recorder, Rk4, Settings,
    Sides, Solver, Stabilisation, State, StepControl, Stepper, System, Tolerance,
};

/// An error of a run from rest at the origin, of one second.
fn refused(point: Point, options: Options<f64>) -> Said {
    from(point, [[0.0, 0.0], [0.0, 0.0]], options)
}

/// An error of a run from a position with a velocity.
fn from(point: Point, [q, v]: [[f64; 2]; 2], options: Options<f64>) -> Said {
    let start = State::new(0.0, q.into(), v.into());
    let framed = Framed {
        events: point.events,
        ..Framed::new(point, point.structure)
    };
    let result = simulate::<2, 1>(&framed, &start, &options, &mut []);
    Said::of(result.map_err(|failure| failure.error))
}

/// A unit mass that a force pushes along `y = 0`.
fn pushed(force: fn(&State<f64, 2>, Sides) -> [f64; 2]) -> Point {
    Point {
        force,
        ..Point::on(line)
    }
}

fn rk4() -> Options<f64> {
    Options::rk4(1.0, 0.01)
}

fn dp5() -> Options<f64> {
    Options::dp5(1.0, 1e-6)
}

/// Through (1, 1) shortly before t = 1, to the right.
const THROUGH: [[f64; 2]; 2] = [[0.005, 1.0], [1.0, 0.0]];

/// Slides along `y = 0` from the origin, with speed one.
const SLIDES: [[f64; 2]; 2] = [[0.0, 0.0], [1.0, 0.0]];

pub const MOTIONS: &[Case] = &[
    (
        "DynamicsError::NotFinite",
        "the force `sqrt(0.5 - t)`",
        || {
            let force = |state: &State<f64, 2>, _| [(0.5 - state.t).sqrt(), 0.0];
            refused(pushed(force), rk4())
        },
        "at t = … s the equations of motion gave a number that is infinite or NaN; look for a \
         force or an input that grows without bound, or take a smaller step",
    ),
    (
        "Watched::KineticEnergy",
        "a kinetic energy with `ln(0.5 - t)` in it",
        || {
            let mut point = Point::on(line);
            point.spoil = |state, energy| {
                energy.kinetic = (0.5 - state.t).ln();
                energy.balance = energy.kinetic;
            };
            refused(point, rk4())
        },
        "at t = … s the kinetic energy is infinite or NaN; look for the root or the logarithm of \
         a negative number, or a division by zero, in what it is made of",
    ),
    (
        "Watched::PotentialEnergy",
        "a potential energy with `sqrt(0.5 - t)` in it",
        || {
            let mut point = Point::on(line);
            point.spoil = |state, energy| energy.balance += (0.5 - state.t).sqrt();
            refused(point, rk4())
        },
        "at t = … s the potential energy is infinite or NaN; look for the root or the logarithm \
         of a negative number, or a division by zero, in what it is made of",
    ),
    (
        "Watched::Power",
        "a power of `sqrt(0.5 - t)`",
        || {
            let mut point = Point::on(line);
            point.spoil = |state, energy| energy.power = (0.5 - state.t).sqrt();
            refused(point, rk4())
        },
        "at t = … s the power that is supplied is infinite or NaN; look for the root or the \
         logarithm of a negative number, or a division by zero, in what it is made of",
    ),
    (
        "Watched::ConstraintError",
        "the constraint `y + 0*sqrt(0.5 - t) = 0`, without projection",
        || {
            let mut point = Point::on(line);
            point.constraint = |state| {
                let mut jet = line(state);
                jet.0 += 0.0 * (0.5 - state.t).sqrt();
                jet
            };
            let mut options = rk4();
            options.settings.stabilisation = Stabilisation::None;
            refused(point, options)
        },
        "at t = … s the error of a constraint is infinite or NaN; look for the root or the \
         logarithm of a negative number, or a division by zero, in what it is made of",
    ),
    (
        "Watched::Event",
        "`event hit: sqrt(0.5 - t) + 1 crossing;`",
        || {
            let point = Point {
                events: |state, values| values.fill((0.5 - state.t).sqrt() + 1.0),
                structure: &WITH_EVENT,
                ..Point::on(line)
            };
            refused(point, rk4())
        },
        "at t = … s the function of the event `hit` is infinite or NaN; look for the root or the \
         logarithm of a negative number, or a division by zero, in what it is made of",
    ),
    (
        "Watched::Condition",
        "a condition on `sqrt(0.5 - t) + 1`",
        || {
            let mut point = Point::on(line);
            point.side = Some(|state| (0.5 - state.t).sqrt() + 1.0);
            refused(point, rk4())
        },
        "at t = … s what is compared in `if x < 1/2` is infinite or NaN; look for the root or \
         the logarithm of a negative number, or a division by zero, in what it is made of",
    ),
    (
        "DynamicsError::SingularPosition",
        "two lines that cross, `(x - 1)*(y - 1) = 0`, passed with `--form multipliers`",
        || {
            let mut options = rk4();
            options.settings.form = Form::Multipliers;
            options.until = 2.0;
            from(Point::on(crossing), THROUGH, options)
        },
        "at t = … s the gradient of the only constraint equation, `g = 0` (line 3), vanishes, and \
         the form `multipliers` cannot pass a singular position; use the form `reduced` or `full`",
    ),
    (
        "Singularity::Unresolved",
        "three lines that meet in a point, passed",
        || from(Point::on(three_lines), [[0.495, 0.495], [1.0, 1.0]], rk4()),
        "at t = … s the constraint `g = 0` (line 3) has a gradient that nearly vanishes, and the \
         branches of motion that meet there can't be told apart by the digits of the numbers; if \
         a length was meant to be exactly that of another, write both by one parameter",
    ),
    (
        "Singularity::Turning",
        "a cusp, `(y - 1)^2 = (x - 1)^3`, passed",
        || from(Point::on(cusp), [[1.25, 0.875], [-1.0, 0.75]], rk4()),
        "at t = … s the constraint `g = 0` (line 3) has a gradient that nearly vanishes, and the branch \
         of motion ends, or turns faster than steps can follow; check that what is prescribed can \
         be reached, or take a smaller tolerance or step",
    ),
    (
        "Singularity::Touching",
        "`(x - 1)^2*(y - 1) = 0`, where one of two crossing lines counts twice",
        || from(Point::on(doubled), THROUGH, rk4()),
        "at t = … s the constraint `g = 0` (line 3) has a gradient that vanishes, and branches of \
         motion touch there, so that the way on can't be told; describe the branch that is meant by \
         constraints of its own",
    ),
    (
        "Singularity::Drifted",
        "`(x - 1)*(y - 1) = 0`, begun 1e-3 beside it, where nothing projects",
        || {
            let mut options = rk4();
            options.settings.stabilisation = Stabilisation::None;
            from(Point::on(crossing), [[0.5, 1.002], [1.0, 0.0]], options)
        },
        "at t = … s the constraint `g = 0` (line 3) has a gradient that nearly vanishes, and the motion \
         has drifted too far off the constraints to tell on which branch it goes on; keep it \
         there by projection, or take larger gains or a smaller tolerance",
    ),
    (
        "Singularity::Undetermined",
        "`(x - 1)*(y - 1) = 0`, begun at rest where the lines cross",
        || {
            let force = |_: &State<f64, 2>, _| [1.0, 1.0];
            let point = Point {
                force,
                ..Point::on(crossing)
            };
            from(point, [[1.0, 1.0], [0.0, 0.0]], rk4())
        },
        "at t = 0 s the constraint `g = 0` (line 3) has a gradient that vanishes, and nothing tells \
         which of the branches of motion that cross there is meant; begin next to this \
         configuration, or with a velocity",
    ),
    (
        "Singularity::Vanishing",
        "`(x^2 + y^2 - 1)^2 = 0`",
        || from(Point::on(squared), [[0.6, 0.8], [0.8, -0.6]], rk4()),
        "at t = 0 s the constraint `g = 0` (line 3) has a gradient that vanishes not only here \
         but wherever it holds, so that it restricts no motion; if it says that a square is \
         zero, write what is squared; else check the parameters",
    ),
    (
        "Singularity::Kink",
        "`y = |x|`, followed into its corner",
        || from(Point::on(corner), [[-0.5, 0.5], [1.0, -1.0]], dp5()),
        "at t = … s the constraint `g = 0` (line 3) has a kink, as a length has where it becomes \
         zero: the velocities that it allows jump, and no smooth motion goes on; end the run \
         before, or describe by an event what happens there",
    ),
    (
        "DynamicsError::NotRegular",
        "`(x - 1)*(y - 1) = 0`, generated as `regular`, passed where the lines cross",
        || {
            let point = Point {
                structure: &REGULAR,
                ..Point::on(crossing)
            };
            let mut options = rk4();
            options.until = 2.0;
            from(point, THROUGH, options)
        },
        "at t = … s the gradient of the only constraint equation, `g = 0` (line 3), vanishes, \
         though the mechanism was declared to be regular; generate it without that declaration",
    ),
    (
        "DynamicsError::MassSingular",
        "a mass of zero along `x`",
        || {
            refused(
                Point {
                    mass: [0.0, 1.0],
                    ..Point::on(line)
                },
                rk4(),
            )
        },
        "at t = 0 s the coordinate `x` can move without kinetic energy and no constraint \
         restricts it; give it inertia or a constraint",
    ),
    (
        "DynamicsError::AngleTooLarge",
        "an angle `phi` that begins at 1e17 rad",
        || {
            let point = Point {
                structure: &WITH_ANGLE,
                ..Point::on(line)
            };
            from(point, [[1e17, 0.0], [0.0, 0.0]], rk4())
        },
        "at t = 0 s the angle `phi` is 1e17 rad, and round-off leaves less than \
         half of the digits of a turn; begin without the whole turns, multiples of 2*pi",
    ),
    (
        "DynamicsError::SharedReaction",
        "the reaction of `(x - 1)*(y - 1) = 0` asked for where the lines cross",
        || {
            let point = Point::on(crossing);
            let state = State::new(0.0, [1.0, 1.0].into(), [1.0, 0.0].into());
            let settings = Settings {
                published: true,
                ..Settings::default()
            };
            let mut solver = Solver::<f64, 2, 1>::new(settings);
            let shared = system_of(&mut solver, &point).multipliers(&state);
            // What whoever asks for the reaction of a row makes of it.
            let (t, row, structure) = (state.t, 0, &POINT);
            let error = DynamicsError::SharedReaction { t, row, structure };
            Said::of(shared.and_then(|each| each[row].ok_or(error)))
        },
        "at t = 0 s the constraint `g = 0` (line 3) has a gradient that vanishes, and its \
         multiplier is not determined; ask for the reactions at coordinates, `reactions`, which are",
    ),
    (
        "DynamicsError::Sticks",
        "a force of 5 N towards `x = 0.5` from both sides, begun there at rest",
        || {
            let mut point = Point::on(line);
            point.side = Some(|state| state.q[0] - 0.5);
            point.force = |state, sides| match sides.above(0, state.q[0] > 0.5) {
                true => [-5.0, 0.0],
                false => [5.0, 0.0],
            };
            from(point, [[0.5, 0.0], [0.0, 0.0]], Options::rk4(1.0, 0.13))
        },
        "at t = … s the condition `if x < 1/2` (line 5) changes again and again without time \
         going on; write a force that rises steeply instead of jumping, such as `tanh(x/d)` for \
         `sign(x)`",
    ),
    (
        "DynamicsError::ProjectionFailed",
        "`y = 0` until t = 0.5 s, then a constraint that nothing satisfies",
        || refused(Point::on(torn), rk4()),
        "at t = … s the constraint `g = 0` (line 3) is violated by … and the state could not \
         be brought back onto it; take a smaller step, or check that the constraints can be \
         satisfied together",
    ),
];

fn adaptive(method: Method, relative: f64) -> Options<f64> {
    let step_control = StepControl::Adaptive {
        relative,
        absolute: relative,
    };
    Options::new(1.0, method, step_control)
}

fn stepper() -> Stepper<f64, 2, 1> {
    let step_control = StepControl::Fixed { step: 0.01 };
    Stepper::new(Method::Rk4, step_control, Settings::default()).expect("a step")
}

/// A system of somebody else's that does not look at its numbers.
struct Careless;

impl System<f64, 2> for Careless {
    fn acceleration(
        &mut self,
        _state: &State<f64, 2>,
    ) -> Result<SVector<f64, 2>, DynamicsError<f64>> {
        Ok([f64::NAN, 0.0].into())
    }

    fn project(&mut self, _state: &mut State<f64, 2>) -> Result<(), DynamicsError<f64>> {
        Ok(())
    }
}

pub const STEPS: &[Case] = &[
    (
        "IntegrateError::StepUnderflow",
        "a force `der(x)^2`, which is infinite at t = 1 s, by `dp5`",
        || {
            // It is infinitely fast at t = 1.
            let force = |state: &State<f64, 2>, _| [state.v[0] * state.v[0], 0.0];
            let mut options = dp5();
            options.until = 2.0;
            from(pushed(force), SLIDES, options)
        },
        "at t = … s the tolerance demands a step of … s, which is lost in the round-off of time; \
         allow a larger tolerance, end the run earlier, or look for a force or a velocity that \
         grows without bound",
    ),
    (
        "IntegrateError::NotFinite",
        "a system of the program's own whose accelerations are NaN, by `dp5`",
        || {
            let tolerance = Tolerance::uniform(1e-6, 1e-6).expect("a tolerance");
            let state = State::new(0.0, [0.0; 2].into(), [1.0, 0.0].into());
            let mut method = Dp5::adaptive(tolerance);
            Said::of(method.step(&mut Careless, &state, 1.0).map(|_| ()))
        },
        "at t = … s the error estimate is infinite or NaN however short the step; look for a \
         force or an input that grows without bound",
    ),
    (
        "IntegrateError::NewtonDiverged",
        "the force `1e9*cos(1000*x)`, by `radau5` with a step of 0.01 s",
        || {
            let force = |state: &State<f64, 2>, _| [1e9 * (1e3 * state.q[0]).cos(), 0.0];
            let step_control = StepControl::Fixed { step: 0.01 };
            let options = Options::new(1.0, Method::Radau5, step_control);
            from(pushed(force), SLIDES, options)
        },
        "at t = … s the equations of an implicit step of … s could not be solved; take a shorter \
         step, or an explicit method",
    ),
    (
        "IntegrateError::ToleranceNotPositive",
        "a tolerance of -1e-6",
        || refused(Point::on(line), Options::dp5(1.0, -1e-6)),
        "a tolerance must be a positive number, not -1e-6",
    ),
    (
        "IntegrateError::ToleranceTooSmall",
        "a tolerance of 1e-17",
        || refused(Point::on(line), Options::dp5(1.0, 1e-17)),
        "a relative tolerance of 1e-17 is below the round-off of the numbers; the smallest that \
         makes sense is …",
    ),
    (
        "SimulateError::StepNotPositive",
        "a step of 0 s",
        || refused(Point::on(line), Options::rk4(1.0, 0.0)),
        "the step must be a positive number of seconds, not 0",
    ),
    (
        "SimulateError::StepLost",
        "a step of 1e-18 s",
        || refused(Point::on(line), Options::rk4(1.0, 1e-18)),
        "a step of 1e-18 s is lost in the round-off of time; the smallest that could be told \
         from zero here is … s",
    ),
    (
        "SimulateError::NoErrorEstimate",
        "`rk4` with a tolerance",
        || refused(Point::on(line), adaptive(Method::Rk4, 1e-6)),
        "the method rk4 has no error estimate and can't follow a tolerance; give it a fixed \
         step, or take dp5, dop853, radau5 or radau9",
    ),
    (
        "SimulateError::BadEnd",
        "a run from t = 0 s until t = -1 s",
        || refused(Point::on(line), Options::rk4(-1.0, 0.01)),
        "the run begins at t = 0 s and can't end at t = -1 s: the end must be a number and not \
         come earlier",
    ),
    (
        "SimulateError::TooManySteps",
        "four steps of 0.01 s for a run of 1 s",
        || {
            let mut options = rk4();
            options.most_steps = Some(4);
            refused(Point::on(line), options)
        },
        "after 4 steps the run had only come to t = 0.04 s; allow more steps or a larger \
         tolerance",
    ),
    (
        "SimulateError::TooMuchWork",
        "a step by `rk4` within three evaluations",
        || {
            let mut state = State::new(0.0, [0.0, 0.0].into(), [1.0, 0.0].into());
            let point: &dyn Mechanism<f64, 2, 1> = &Point::on(line);
            let result = stepper().step_within(point, &mut state, 0.01, 3);
            Said::of(result)
        },
        "3 evaluations of the equations are too few for the step at t = 0 s; grant more, or take \
         a shorter step",
    ),
];

pub const ASKED: &[Case] = &[
    (
        "IntegrateError::BadBound",
        "a step backwards",
        || {
            let state = State::new(1.0, [0.0, 0.0].into(), [1.0, 0.0].into());
            let (point, mut solver) = (
                Point::on(line),
                Solver::<f64, 2, 1>::new(Settings::default()),
            );
            let result = Rk4::new()
                .step(&mut system_of(&mut solver, &point), &state, 0.5)
                .map(|step| *step.end());
            Said::of(result)
        },
        "cannot step from t = 1 s to t = 0.5 s: the end must come later",
    ),
    (
        "SimulateError::StartNotFinite",
        "a run from a state with NaN in it",
        || from(Point::on(line), [[f64::NAN, 0.0], [0.0, 0.0]], rk4()),
        "the initial state at t = 0 s is infinite or NaN; check what it was made from",
    ),
    (
        "SimulateError::NotConservative",
        "`keep_energy` for a mechanism with applied forces",
        || {
            let mut options = rk4();
            options.keep_energy = true;
            refused(Point::on(line), options)
        },
        "the energy can't be kept: the mechanism has dissipation, applied forces, inputs or \
         explicit time; run it without keeping the energy",
    ),
    (
        "SimulateError::TooManyEvents",
        "65 events",
        || {
            let point = Point {
                structure: &WITH_MANY_EVENTS,
                ..Point::on(line)
            };
            refused(point, rk4())
        },
        "the mechanism has 65 events, and there is room for 64; leave some out",
    ),
    (
        "BadInterval",
        "rows every 0 s",
        || Said::of(Recorder::<f64, 2>::new(0.0)),
        "the interval between rows must be a positive number of seconds, not 0",
    ),
];
