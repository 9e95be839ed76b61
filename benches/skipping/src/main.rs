//! What is saved where a description does not need something: instructions of pairs of
//! descriptions that differ in that one thing.
//!
//! Prints the table; `write` writes it to `docs/skipping.md`.

use bricard_runtime::{
    Audit, Method, Options, Settings, State, StepControl, Stepper, Whole, assemble, simulate,
};
use bricard_testkit::callgrind::counted;
use skipping::pairs::PAIRS;
use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::path::Path;

type Failed = Box<dyn Error>;

/// Length of a step (s).
const STEP: f64 = 0.01;
/// Steps of the two runs that are compared, so that what is done once drops out.
const STEPS: [u32; 2] = [16, 80];
/// Steps of a run through a singular position, of which one passes it.
const PASSAGE: u32 = 12;

const HEAD: &str = "# What a description does not need

Instructions of one step of Runge and Kutta's classical method, four accelerations with
positions and velocities brought back onto the constraints, of pairs of descriptions that
differ in one thing: the first needs it, the second does not. Counted by callgrind on code
built for x86-64-v3. The last rows but one are runs of 12 steps through the position in which
the rods of a parallelogram lie in one line, the last is one step with the audits of `simulate`
(energy, constraint errors, passages) and without.

That it is left out is looked up in the generated programs by `tests/skipping.rs`;
`bricard show` says of each mechanism what is.

This page is written by `cargo run --release -p skipping -- write`, in `benches/`.

| what is not needed | what is left out | needed | not needed | ratio |
|---|---|--:|--:|--:|
";

macro_rules! runs {
    ($($name:literal: $with:ident, $without:ident;)*) => {
        fn run(name: &str, needed: bool, audit: bool, steps: u32) -> Result<(), Failed> {
            match (name, needed) {
                $(
                    ($name, true) => go(&skipping::$with::Pair::default(), audit, steps),
                    ($name, false) => go(&skipping::$without::Pair::default(), audit, steps),
                )*
                _ => Err(format!("there is no pair `{name}`").into()),
            }
        }
    };
}

runs! {
    "mass": mass_with, mass_without;
    "ignorable": ignorable_with, ignorable_without;
    "constraints": constraints_with, constraints_without;
    "rank": rank_with, rank_without;
    "clock": clock_with, clock_without;
    "zeros": zeros_with, zeros_without;
    "ties": ties_with, ties_without;
    "parameters": parameters_with, parameters_without;
    "conditions": conditions_with, conditions_without;
    "passage": passage_with, passage_without;
    "sheets": sheets_with, sheets_without;
}

fn go<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    audit: bool,
    steps: u32,
) -> Result<(), Failed> {
    let start = assemble(mechanism, &mechanism.start(), 0.0).map_err(|e| e.to_string())?;
    let end: State<f64, N> = match audit {
        true => audited(mechanism, start, steps)?,
        false => stepped(mechanism, start, steps)?,
    };
    black_box(&end);
    Ok(())
}

fn stepped<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    mut state: State<f64, N>,
    steps: u32,
) -> Result<State<f64, N>, Failed> {
    let control = StepControl::Fixed { step: STEP };
    let mut stepper = Stepper::<f64, N, R>::new(Method::Rk4, control, Settings::default())?;
    stepper.step(mechanism, &mut state, STEP * f64::from(steps))?;
    Ok(state)
}

fn audited<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    start: State<f64, N>,
    steps: u32,
) -> Result<State<f64, N>, Failed> {
    let mut options = Options::rk4(STEP * f64::from(steps), STEP);
    options.audit = Audit::ALL;
    let done = simulate(mechanism, &start, &options, &mut []);
    Ok(done.map_err(|failure| failure.error.to_string())?.end)
}

/// Instructions of a run.
fn collected(name: &str, needed: bool, audit: bool, steps: u32) -> Result<f64, Failed> {
    let [needed, audit] = [needed, audit].map(|flag| flag.to_string());
    counted(&["run", name, &needed, &audit, &steps.to_string()])
}

/// Instructions of one step, or of a whole run through a singular position.
fn instructions(name: &str, needed: bool, audit: bool) -> Result<f64, Failed> {
    let passes = ["passage", "sheets"].contains(&name);
    let [few, many] = if passes { [0, PASSAGE] } else { STEPS };
    let parts = if passes { 1 } else { many - few };
    let more = collected(name, needed, audit, many)?;
    let less = collected(name, needed, audit, few)?;
    Ok((more - less) / f64::from(parts))
}

fn table() -> Result<String, Failed> {
    let mut text = String::new();
    let mut row = |what: &str, left_out: &str, [with, without]: [f64; 2]| {
        let ratio = without / with;
        text += &format!("| {what} | {left_out} | {with:.0} | {without:.0} | {ratio:.2} |\n");
    };
    for pair in PAIRS {
        let counts = [
            instructions(pair.name, true, false)?,
            instructions(pair.name, false, false)?,
        ];
        row(pair.what, pair.left_out, counts);
    }
    let audits = [true, false].map(|audit| instructions("constraints", true, audit));
    let [with, without] = audits;
    row("audits", "what they would look at", [with?, without?]);
    Ok(text)
}

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["run", name, needed, audit, steps] => {
            run(name, needed.parse()?, audit.parse()?, steps.parse()?)
        }
        [] => {
            print!("{}", table()?);
            Ok(())
        }
        ["write"] => {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/skipping.md");
            fs::write(path, format!("{HEAD}{}", table()?))?;
            Ok(())
        }
        _ => Err("write nothing, or `write`".into()),
    }
}
