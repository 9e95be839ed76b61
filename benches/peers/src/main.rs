//! Chains and closed chains of 10 to 200 bodies beside diffsol, in one run, and beside
//! recorded figures of simulators.
//!
//! `peers` prints the tables; `peers write` writes them to `docs/peers.md`. Lengths of 100
//! and 200 need `--features long`.

mod by_hand;
mod chain;
mod clock;
mod generated;
mod page;
mod parallelograms;

use bricard_runtime::{Acceleration, Method, State, Whole};
use chain::Chain;
use clock::timed;
use std::error::Error;
use std::hint::black_box;
use std::thread;

/// Whatever went wrong.
pub type Failed = Box<dyn Error>;

/// End of a run (s).
const UNTIL: f64 = 1.0;
/// Error of an angle (rad) that is asked for.
const ASKED: f64 = 1e-6;
/// Tolerances are tried in turn from this one, each a third of the one before.
const FIRST: f64 = 1e-4;
const TOLERANCES: i32 = 16;
/// A run that is nothing but what is done before the first step (s).
const MOMENT: f64 = 1e-9;
/// Accelerations that are timed together.
const TOGETHER: u32 = 1000;
/// The matrices of 200 bodies lie on the stack.
const STACK: usize = 1 << 30;

/// What a solver needs for the error that is asked for.
#[derive(Clone, Debug)]
struct Reached {
    solver: &'static str,
    /// Tolerance, error (rad), processor time (s), or why there is none.
    run: Result<[f64; 3], String>,
    /// Of that time, what is spent before the first step (s).
    before: f64,
}

/// What was measured of a chain.
#[derive(Clone, Debug)]
struct Measured {
    bodies: usize,
    closed: bool,
    reached: Vec<Reached>,
    /// Processor time of making the start consistent (s).
    assembly: f64,
    /// Processor time of an acceleration by emitted code and by hand (s).
    acceleration: [f64; 2],
}

fn main() -> Result<(), Failed> {
    let write = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("write") => true,
        Some(other) => return Err(format!("`{other}` is neither nothing nor `write`").into()),
    };
    let work = move || page::make(write).map_err(|error| error.to_string());
    let thread = thread::Builder::new().stack_size(STACK).spawn(work)?;
    match thread.join() {
        Ok(done) => Ok(done?),
        Err(_) => Err("it panicked".into()),
    }
}

macro_rules! measure {
    ($($(#[$when:meta])* $open:ident, $closed:ident: $n:literal;)*) => {
        /// Measures all chains.
        fn measured() -> Result<Vec<Measured>, Failed> {
            let mut all = Vec::new();
            $(
                $(#[$when])*
                {
                    let chain = generated::$open::open_chain::OpenChain::default();
                    all.push(one::<$n, { 3 * $n }, { 2 * $n }>(&chain, false)?);
                    let chain = generated::$closed::closed_chain::ClosedChain::default();
                    all.push(one::<$n, { 3 * $n }, { 2 * $n + 2 }>(&chain, true)?);
                }
            )*
            all.sort_by_key(|measured| measured.closed);
            Ok(all)
        }
    };
}

measure! {
    open_10, closed_10: 10;
    open_50, closed_50: 50;
    #[cfg(feature = "long")]
    open_100, closed_100: 100;
    #[cfg(feature = "long")]
    open_200, closed_200: 200;
}

/// Measures one chain of `B` bodies.
fn one<const B: usize, const N: usize, const R: usize>(
    chain: &dyn Whole<f64, N, R>,
    closed: bool,
) -> Result<Measured, Failed> {
    let exact = by_hand::exact::<B>(closed)?;
    let (start, assembly) = timed(|| generated::start(chain))?;
    let mut reached = Vec::new();
    for (solver, method) in [
        ("bricard, DOP853", Method::Dop853),
        ("bricard, DP5", Method::Dp5),
    ] {
        eprintln!("{B} bodies, closed: {closed}, {solver}");
        let run = |tolerance| generated::whole(chain, &start, method, tolerance);
        let first = || generated::run(chain, &start, (method, FIRST), MOMENT);
        let before = timed(first).map_or(0.0, |(_, seconds)| seconds);
        reached.push(cheapest(solver, &exact, before, run));
    }
    eprintln!("{B} bodies, closed: {closed}, diffsol");
    let run = |tolerance| by_hand::diffsol(B, closed, tolerance);
    reached.push(cheapest("diffsol, Tsit45", &exact, 0.0, run));
    Ok(Measured {
        bodies: B,
        closed,
        reached,
        assembly,
        acceleration: accelerations::<B, N, R>(chain, &start, closed)?,
    })
}

/// The first run whose error is what is asked for.
fn cheapest(
    solver: &'static str,
    exact: &[f64],
    before: f64,
    run: impl Fn(f64) -> Result<Vec<f64>, Failed>,
) -> Reached {
    let far = |angles: &[f64]| {
        let pairs = angles.iter().zip(exact);
        pairs.fold(0.0, |most: f64, (x, exact)| most.max((x - exact).abs()))
    };
    let found = (0..TOLERANCES).find_map(|power| {
        let tolerance = FIRST / 3.0_f64.powi(power);
        match run(tolerance) {
            Err(error) => Some(Err(error.to_string())),
            Ok(angles) if far(&angles) > ASKED => None,
            Ok(angles) => match timed(|| run(tolerance)) {
                Ok((_, seconds)) => Some(Ok([tolerance, far(&angles), seconds])),
                Err(error) => Some(Err(error.to_string())),
            },
        }
    });
    let run = found.unwrap_or_else(|| Err("does not come as near".to_string()));
    Reached {
        solver,
        run,
        before,
    }
}

/// Processor time of an acceleration: by emitted code, and by hand.
fn accelerations<const B: usize, const N: usize, const R: usize>(
    chain: &dyn Whole<f64, N, R>,
    start: &State<f64, N>,
    closed: bool,
) -> Result<[f64; 2], Failed> {
    let mut room = Box::new(Acceleration::<f64, N, R>::default());
    let emitted = || -> Result<(), Failed> {
        for _ in 0..TOGETHER {
            black_box(generated::acceleration(chain, black_box(start), &mut room)?);
        }
        Ok(())
    };
    let ((), ours) = timed(emitted)?;
    let mut by_hand = Chain::new(B, closed);
    let (angles, rates) = (by_hand.start(), vec![0.0; B]);
    let mut out = vec![0.0; B];
    let hand = || -> Result<(), Failed> {
        for _ in 0..TOGETHER {
            by_hand.accelerations(black_box(&angles), &rates, &mut out);
            black_box(&out);
        }
        Ok(())
    };
    let ((), theirs) = timed(hand)?;
    Ok([ours, theirs].map(|seconds| seconds / f64::from(TOGETHER)))
}
