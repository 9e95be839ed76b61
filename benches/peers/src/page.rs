//! The page: what was measured, beside what is recorded.

use crate::parallelograms::{self, Run};
use crate::{ASKED, Failed, Measured, UNTIL, measured};
use std::fs;
use std::path::Path;

const PAGE: &str = "../docs/peers.md";

const HEAD: &str = "# Beside other solvers

Chains of rods in the plane, open and with both ends on the ground, of 10 bodies and more: the
descriptions are `benches/peers/mechanisms/*.mech`, three coordinates for each body and a
constraint for each joint. All numbers that are not called recorded are from one run of
`cargo run --release -p peers -- write`, in `benches/`, which writes this page; with
`--features long` chains of 100 and 200 bodies are among them.

The other solver of that run is diffsol 0.18, whose explicit method of order 5 has been the
fastest of all peers on small mechanisms. It is given what its own users would write at their
best: the chain by hand in one angle for each rod, with the forces at the joints found by
elimination from joint to joint, so that an acceleration takes a number of operations that
grows with the rods (`benches/peers/src/chain.rs`). It gets neither more coordinates than
that nor a matrix. The equations had to be differentiated twice for it: its mass matrix may
be singular, but only as far as the algebraic unknowns are given by the equations they
stand in (index 1), and constraints on positions do not give the forces that keep them. Once
they are differentiated, the forces are eliminated at no cost, and what is left is neither
stiff nor algebraic, so that an explicit method is the right one. A closed chain that was
differentiated drifts apart; Baumgarte's terms with a gain of 50 keep it together.

bricard has the description alone, and projects onto its constraints in each step. DP5 is
of the same order as Tsit45, DOP853 what bricard takes for tight tolerances.
";

/// Measures, and prints or writes the page.
///
/// # Errors
///
/// What can't be measured or written.
pub fn make(write: bool) -> Result<(), Failed> {
    let all = measured()?;
    let rows = parallelograms::runs()?;
    let page = format!(
        "{HEAD}{}{}{}",
        runs(&all),
        accelerations(&all),
        loops(&rows)
    );
    match write {
        true => {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(PAGE);
            fs::write(path, page)?;
        }
        false => print!("{page}"),
    }
    Ok(())
}

fn runs(all: &[Measured]) -> String {
    let mut text = format!(
        "
## Runs

{UNTIL} s from rest, as cheap as each solver does it with an error of at most {ASKED:.0e} rad in
every angle; tolerances are tried from 1e-4, each a third of the one before. The exact
motion is that of the equations by hand, by a method of order 8 with a tolerance of 1e-13.
Processor time of one thread. `Before the first step` is what bricard does once for a motion:
it learns the sizes of the constraint equations and how many are independent. `Ratio` is that
of the times without it, to diffsol's.

| bodies | solver | tolerance | error (rad) | time (ms) | before the first step (ms) | ratio |
|--:|---|--:|--:|--:|--:|--:|
"
    );
    for measured in all {
        let theirs = measured.reached.iter().find_map(|reached| {
            let [_, _, seconds] = *reached.run.as_ref().ok()?;
            reached.solver.starts_with("diffsol").then_some(seconds)
        });
        let bodies = match measured.closed {
            true => format!("{}, closed", measured.bodies),
            false => measured.bodies.to_string(),
        };
        for reached in &measured.reached {
            let solver = reached.solver;
            let before = 1e3 * reached.before;
            text += &match &reached.run {
                Ok([tolerance, error, seconds]) => {
                    let stepping = (seconds - reached.before).max(0.0);
                    let ratio =
                        theirs.map_or("–".to_string(), |t| format!("{:.2}", stepping / t));
                    let time = 1e3 * seconds;
                    format!(
                        "| {bodies} | {solver} | {tolerance:.1e} | {error:.1e} | {time:.2} | {before:.2} | {ratio} |\n"
                    )
                }
                Err(reason) => {
                    let reason = reason.lines().next().unwrap_or_default();
                    format!("| {bodies} | {solver} | – | {reason} | – | {before:.2} | – |\n")
                }
            };
        }
    }
    text
}

fn accelerations(all: &[Measured]) -> String {
    let mut text = "
## One acceleration

That of the start, and the time in which the start itself is made consistent from its
guesses. Recorded: Pinocchio 4.1.0, articulated body algorithm on joint angles, called from
Python, the least of 7 × 2,000 calls on 2 shared cores of a Xeon with AVX-512, November 2026.

| bodies | bricard (µs) | by hand, for diffsol (µs) | Pinocchio, recorded (µs) | start made consistent (ms) |
|--:|--:|--:|--:|--:|
"
    .to_string();
    for measured in all {
        let recorded = match (measured.closed, measured.bodies) {
            (false, 10) => "3.3",
            (false, 100) => "33",
            (false, 200) => "71",
            _ => "–",
        };
        let closed = if measured.closed { ", closed" } else { "" };
        let [ours, hand] = measured.acceleration.map(|seconds| 1e6 * seconds);
        let assembly = 1e3 * measured.assembly;
        text += &format!(
            "| {}{closed} | {ours:.2} | {hand:.2} | {recorded} | {assembly:.2} |\n",
            measured.bodies
        );
    }
    text
}

fn loops(rows: &[Run]) -> String {
    let mut text = "
## Closed loops through singular positions

N parallelograms in a row, 2 N + 1 rods of 1 m and 1 kg, 10 s, in which all rods come to lie
in one line ten times: problem A02 of the IFToMM library. Ours are from this run, by DOP853
from the description to the end, assembly and all. The others were recorded in November
2026 on 2 shared cores of a Xeon with AVX-512, processor time of the loop over the steps, best
settings of each that passed all singular positions; they are not measured again, and the
machine was loaded: read factors of 2 and more.

| solver | loops | error of the first angle (rad) | change of energy (J) | time (ms) |
|---|--:|--:|--:|--:|
"
    .to_string();
    for run in rows {
        text += &format!(
            "| bricard, tolerance {:.0e} | {} | {:.1e} | {:.1e} | {:.1} |\n",
            run.tolerance,
            run.loops,
            run.error,
            run.change,
            1e3 * run.seconds
        );
    }
    text + RECORDED
}

const RECORDED: &str = "\
| Exudyn 1.13.6, generalised-α (ρ = 0.9), h = 1e-2, recorded | 10 | 3.9e-3 | 0.73 | 210 |
| | 40 | 3.7e-3 | 2.8 | 1100 |
| Exudyn 1.13.6, the same, h = 1e-3, recorded | 10 | 3.8e-5 | 7.3e-3 | 1700 |
| | 40 | 3.5e-5 | 2.8e-2 | 6200 |
| MuJoCo 4.0.0, RK4, stiff connections, h = 1e-3, recorded | 10 | 9.8e-5 | 6.5e-4 | 1070 |
| | 40 | 3.5e-5 | 9.4e-4 | 2100 |
| MuJoCo 4.0.0, Euler, stiff connections, h = 1e-3, recorded | 10 | 1.2e-4 | 0.40 | 160 |
| | 40 | 4.3e-5 | 1.5 | 590 |
| Pinocchio 4.1.0, RK4, proximal μ = 1e-10, gain 10, h = 1e-2, recorded | 10 | 3.9e-7 | 4.4e-6 | 150 |
| | 40 | 3.6e-7 | 1.7e-5 | 1030 |

diffsol has no row here: on index-1 equations its steps go over singular positions where they
happen not to come near one, and end at the wrong branch or not at all where they do;
`cargo run --release -p work_precision` counts how often. There are no recorded figures of
simulators for closed chains of other lengths.
";
