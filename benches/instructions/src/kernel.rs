//! What is counted: one call, many times.
//!
//! In:  a name, a number of rounds.
//! Out: nothing but the work; [`ROUND`] calls a round.
//!
//! Calls go through functions that are not inlined, so that what surrounds them is the
//! same for all; the kernel `call` is that surrounding alone.

use crate::kernels::ROUND;
use bricard_codegen::Builder;
use bricard_runtime::{
    Acceleration, Audit, Correction, Interface, Mechanism, Method, Options, Settings, Solver,
    State, StepControl, Stepper, Terms, assemble, simulate,
};
use bricard_testkit::Random;
use instructions::hand::{self, ByHand};
use instructions::mechanism as generated;
use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;

/// Length of a step (s).
const STEP: f64 = 0.01;
/// Length of a run (s).
const SPAN: f64 = 8.0;
/// How far rods are from lying in one line (rad), at least.
const NEAR: f64 = 1e-4;
/// Distance of the states from which steps begin (s).
const APART: f64 = 0.02;

type Failed = Box<dyn Error>;

/// What is asked of a mechanism.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Work {
    Call,
    Terms,
    Regular,
    Correction,
    Step,
    /// An acceleration and the way back onto the constraints, near the position where
    /// all rods of a row lie in one line.
    Robust,
    /// An acceleration and the way back onto the constraints, near the position where the rods of
    /// one swing of many lie in one line.
    Turning,
    /// Eight seconds.
    Run(Method),
    /// Eight seconds by `simulate`.
    Simulated(Method, Audit),
}

/// Runs a kernel.
///
/// # Errors
///
/// A name that nothing has; a run that fails.
pub fn run(name: &str, rounds: u64) -> Result<(), Failed> {
    let (subject, work) = name.split_once('/').ok_or("write SUBJECT/WORK")?;
    if let ("generation", Some(loops)) = (work, subject.strip_prefix("row_")) {
        return (0..rounds).try_for_each(|_| generate(loops.parse()?));
    }
    let work = match work {
        "call" => Work::Call,
        "terms" => Work::Terms,
        "regular" => Work::Regular,
        "correction" => Work::Correction,
        "step" => Work::Step,
        "robust" => Work::Robust,
        "turning" => Work::Turning,
        "run_rk4" => Work::Run(Method::Rk4),
        "run_dop853" => Work::Run(Method::Dop853),
        "simulated_rk4" => Work::Simulated(Method::Rk4, Audit::NONE),
        "simulated_dop853" => Work::Simulated(Method::Dop853, Audit::NONE),
        "audited_rk4" => Work::Simulated(Method::Rk4, Audit::ALL),
        "audited_dop853" => Work::Simulated(Method::Dop853, Audit::ALL),
        _ => return Err(format!("there is no kernel `{work}`").into()),
    };
    let job = (work, rounds);
    match subject {
        "slider_crank" => ours(
            &generated::slider_crank_folded::slider_crank::SliderCrank::default(),
            job,
        ),
        "slider_crank_open" => ours(
            &generated::slider_crank_open::slider_crank::SliderCrank::default(),
            job,
        ),
        "slider_crank_hand" => theirs(
            &hand::SliderCrank,
            &generated::slider_crank_folded::slider_crank::SliderCrank::default(),
            job,
        ),
        "double_four_bar" => ours(
            &generated::double_four_bar_folded::double_four_bar::DoubleFourBar::default(),
            job,
        ),
        "double_four_bar_open" => ours(
            &generated::double_four_bar_open::double_four_bar::DoubleFourBar::default(),
            job,
        ),
        "double_four_bar_hand" => theirs(
            &hand::DoubleFourBar,
            &generated::double_four_bar_folded::double_four_bar::DoubleFourBar::default(),
            job,
        ),
        "slider_crank_eliminated" => ours(
            &generated::slider_crank_eliminated::slider_crank::SliderCrank::default(),
            job,
        ),
        "scotch_yoke" => ours(
            &generated::scotch_yoke_folded::scotch_yoke::ScotchYoke::default(),
            job,
        ),
        "scotch_yoke_eliminated" => ours(
            &generated::scotch_yoke_eliminated::scotch_yoke::ScotchYoke::default(),
            job,
        ),
        "quick_return" => ours(
            &generated::quick_return_folded::quick_return::QuickReturn::default(),
            job,
        ),
        "quick_return_eliminated" => ours(
            &generated::quick_return_eliminated::quick_return::QuickReturn::default(),
            job,
        ),
        "pendulum" => ours(
            &generated::pendulum::spatial_double_pendulum::SpatialDoublePendulum::default(),
            job,
        ),
        "chain" => ours(
            &generated::chain::spatial_chain::SpatialChain::default(),
            job,
        ),
        #[cfg(feature = "long")]
        "row_2" => ours(&generated::row_2::n_four_bar::NFourBar::default(), job),
        #[cfg(feature = "long")]
        "row_5" => ours(&generated::row_5::n_four_bar::NFourBar::default(), job),
        "andrews" => ours(&generated::andrews_folded::andrews::Andrews::default(), job),
        "row_10" => ours(&generated::row_10::n_four_bar::NFourBar::default(), job),
        #[cfg(feature = "long")]
        "row_20" => ours(&generated::row_20::n_four_bar::NFourBar::default(), job),
        "row_40" => ours(&generated::row_40::n_four_bar::NFourBar::default(), job),
        #[cfg(feature = "long")]
        "row_80" => ours(&generated::row_80::n_four_bar::NFourBar::default(), job),
        "swings_10" => ours(&generated::swings_10::swings::Swings::default(), job),
        "hung_10" => ours(&generated::hung_10::hung_row::HungRow::default(), job),
        "joint_10" => ours(
            &generated::joint_10::joint_chain::JointChain::default(),
            job,
        ),
        "joint_20" => ours(
            &generated::joint_20::joint_chain::JointChain::default(),
            job,
        ),
        "joint_50" => ours(
            &generated::joint_50::joint_chain::JointChain::default(),
            job,
        ),
        #[cfg(feature = "long")]
        "swings_20" => ours(&generated::swings_20::swings::Swings::default(), job),
        #[cfg(feature = "long")]
        "swings_40" => ours(&generated::swings_40::swings::Swings::default(), job),
        #[cfg(feature = "long")]
        "hung_20" => ours(&generated::hung_20::hung_row::HungRow::default(), job),
        #[cfg(feature = "long")]
        "hung_40" => ours(&generated::hung_40::hung_row::HungRow::default(), job),
        _ => Err(format!("there is no mechanism `{subject}`").into()),
    }
}

/// Generates the code of a row of so many loops.
fn generate(loops: u32) -> Result<(), Failed> {
    let out = std::env::temp_dir().join(format!("bricard_row_{loops}"));
    std::fs::create_dir_all(&out)?;
    let row = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../mechanisms/n_four_bar.mech"
    );
    let builder = Builder::new().constant("N", loops).out_dir(&out);
    builder.compile(row)?;
    Ok(std::fs::remove_dir_all(&out)?)
}

/// States all over the place: for what needs no closed loops.
fn scattered<const N: usize>() -> Vec<State<f64, N>> {
    let mut random = Random::seeded(1);
    let state = |_| {
        let mut state = State::<f64, N>::default();
        state.q.iter_mut().for_each(|q| *q = random.within(1.5));
        state.v.iter_mut().for_each(|v| *v = random.within(2.0));
        state
    };
    (0..ROUND).map(state).collect()
}

/// States along a motion from the start, which passes no singular position so soon.
fn along<M, const N: usize, const R: usize>(mechanism: &M) -> Result<Vec<State<f64, N>>, Failed>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    let mut state =
        assemble(mechanism, &mechanism.start(), 0.0).map_err(|error| error.to_string())?;
    let mut stepper = stepper(Method::Rk4)?;
    let mut states = Vec::new();
    for _ in 0..ROUND {
        states.push(state);
        stepper.step(mechanism, &mut state, APART)?;
    }
    Ok(states)
}

/// A state of a row of parallelograms that has almost fallen into one line.
fn in_line<const N: usize, const R: usize>(k: u64) -> State<f64, N> {
    let mut state = State::default();
    for crank in 0..=R / 2 {
        state.q[crank] = FRAC_PI_2 - NEAR * (k + 1) as f64;
        state.v[crank] = 1.0;
    }
    state
}

/// A state of swings of which the one in the middle has almost fallen into one line.
fn one_in_line<const N: usize>(k: u64) -> State<f64, N> {
    let mut state = State::default();
    let swings = N / 3;
    for swing in 0..swings {
        let angle = if swing == swings / 2 {
            FRAC_PI_2 - NEAR * (k + 1) as f64
        } else {
            0.7 + 0.01 * swing as f64
        };
        for crank in [swing, swings + swing] {
            state.q[crank] = angle;
            state.v[crank] = 1.0;
        }
    }
    state
}

/// Steps of 0.01 s, or as long as an error of 1e-9 allows.
fn step_control(method: Method) -> StepControl<f64> {
    match method {
        Method::Rk4 => StepControl::Fixed { step: STEP },
        _ => StepControl::Adaptive {
            relative: 1e-9,
            absolute: 1e-9,
        },
    }
}

fn options(method: Method, audit: Audit) -> Options<f64> {
    let mut options = Options::rk4(SPAN, STEP);
    (options.method, options.step_control) = (method, step_control(method));
    options.audit = audit;
    options
}

fn stepper<const N: usize, const R: usize>(
    method: Method,
) -> Result<Box<Stepper<f64, N, R>>, Failed> {
    let control = step_control(method);
    Ok(Box::new(Stepper::new(
        method,
        control,
        Settings::default(),
    )?))
}

fn ours<M, const N: usize, const R: usize>(
    mechanism: &M,
    (work, rounds): (Work, u64),
) -> Result<(), Failed>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    match work {
        Work::Call => repeat(&scattered::<N>(), rounds, mechanism, &mut (), nothing),
        Work::Terms => repeat(
            &scattered::<N>(),
            rounds,
            mechanism,
            &mut *Box::<Terms<_, N, R>>::default(),
            terms,
        ),
        Work::Regular => {
            let mut out = Box::<Acceleration<_, N, R>>::default();
            if !mechanism.acceleration(&scattered::<N>()[0], &mut out) {
                return Err("there is no regular path".into());
            }
            repeat(&scattered::<N>(), rounds, mechanism, &mut *out, regular);
        }
        Work::Correction => repeat(
            &along(mechanism)?,
            rounds,
            mechanism,
            &mut *Box::<Correction<_, N, R>>::default(),
            correction,
        ),
        Work::Step => {
            let mut stepper = stepper::<N, R>(Method::Rk4)?;
            let starts = along(mechanism)?;
            for _ in 0..rounds {
                for start in &starts {
                    let mut state = *start;
                    stepper.step(mechanism, &mut state, STEP)?;
                    black_box(&state);
                }
            }
        }
        Work::Robust => near_dependent(mechanism, rounds, in_line::<N, R>)?,
        Work::Turning => near_dependent(mechanism, rounds, one_in_line::<N>)?,
        Work::Run(method) => runs(mechanism, rounds, |start| {
            let mut state = *start;
            stepper::<N, R>(method)?.step(mechanism, &mut state, SPAN)?;
            black_box(&state);
            Ok(())
        })?,
        Work::Simulated(method, audit) => {
            let options = options(method, audit);
            runs(mechanism, rounds, |start| {
                black_box(simulate(mechanism, start, &options, &mut [])?);
                Ok(())
            })?;
        }
    }
    Ok(())
}

/// Runs from the start.
fn runs<M, const N: usize, const R: usize>(
    mechanism: &M,
    rounds: u64,
    run: impl Fn(&State<f64, N>) -> Result<(), Failed>,
) -> Result<(), Failed>
where
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    for _ in 0..rounds {
        let start =
            assemble(mechanism, &mechanism.start(), 0.0).map_err(|error| error.to_string())?;
        run(&start)?;
    }
    Ok(())
}

/// An acceleration and the way back onto the constraints at states where some of their rows are
/// near-dependent.
fn near_dependent<M, const N: usize, const R: usize>(
    mechanism: &M,
    rounds: u64,
    state: fn(u64) -> State<f64, N>,
) -> Result<(), Failed>
where
    M: Mechanism<f64, N, R>,
{
    let mut solver = Box::new(Solver::new(Settings::default()));
    let mut system = solver.on(mechanism);
    for k in 0..rounds {
        let mut state = state(k);
        black_box(system.acceleration(&state)?);
        system.project(&mut state)?;
        black_box(&state);
    }
    Ok(())
}

fn theirs<H, M, const N: usize, const R: usize>(
    mechanism: &H,
    same: &M,
    (work, rounds): (Work, u64),
) -> Result<(), Failed>
where
    H: ByHand<N, R>,
    M: Mechanism<f64, N, R> + Interface<f64, N>,
{
    match work {
        Work::Terms => repeat(
            &scattered::<N>(),
            rounds,
            mechanism,
            &mut *Box::<Terms<_, N, R>>::default(),
            hand_terms,
        ),
        Work::Regular => repeat(
            &scattered::<N>(),
            rounds,
            mechanism,
            &mut State::default(),
            hand_acceleration::<H, N, R>,
        ),
        Work::Correction => repeat(
            &along(same)?,
            rounds,
            mechanism,
            &mut State::default(),
            hand_correction::<H, N, R>,
        ),
        Work::Step => repeat(
            &along(same)?,
            rounds,
            mechanism,
            &mut State::default(),
            hand_step::<H, N, R>,
        ),
        Work::Call | Work::Robust | Work::Turning | Work::Run(_) | Work::Simulated(..) => {
            return Err("not written by hand".into());
        }
    }
    Ok(())
}

fn repeat<M: ?Sized, O, const N: usize>(
    states: &[State<f64, N>],
    rounds: u64,
    mechanism: &M,
    out: &mut O,
    call: fn(&M, &State<f64, N>, &mut O),
) {
    let call = black_box(call);
    for _ in 0..rounds {
        for state in states {
            call(mechanism, state, out);
        }
    }
    black_box(out);
}

#[inline(never)]
fn nothing<M, const N: usize>(_mechanism: &M, _state: &State<f64, N>, _out: &mut ()) {}

#[inline(never)]
fn terms<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(
    mechanism: &M,
    state: &State<f64, N>,
    out: &mut Terms<f64, N, R>,
) {
    mechanism.terms(state, out);
}

#[inline(never)]
fn regular<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(
    mechanism: &M,
    state: &State<f64, N>,
    out: &mut Acceleration<f64, N, R>,
) {
    black_box(mechanism.acceleration(state, out));
}

#[inline(never)]
fn correction<M: Mechanism<f64, N, R>, const N: usize, const R: usize>(
    mechanism: &M,
    state: &State<f64, N>,
    out: &mut Correction<f64, N, R>,
) {
    black_box(mechanism.correction(state, out));
}

#[inline(never)]
fn hand_terms<H: ByHand<N, R>, const N: usize, const R: usize>(
    mechanism: &H,
    state: &State<f64, N>,
    out: &mut Terms<f64, N, R>,
) {
    mechanism.terms(state, out);
}

#[inline(never)]
fn hand_acceleration<H: ByHand<N, R>, const N: usize, const R: usize>(
    mechanism: &H,
    state: &State<f64, N>,
    out: &mut State<f64, N>,
) {
    out.v = mechanism.acceleration(state);
}

#[inline(never)]
fn hand_correction<H: ByHand<N, R>, const N: usize, const R: usize>(
    mechanism: &H,
    state: &State<f64, N>,
    out: &mut State<f64, N>,
) {
    (out.q, out.v) = mechanism.correction(state);
}

#[inline(never)]
fn hand_step<H: ByHand<N, R>, const N: usize, const R: usize>(
    mechanism: &H,
    state: &State<f64, N>,
    out: &mut State<f64, N>,
) {
    *out = hand::step(mechanism, state, STEP);
}
