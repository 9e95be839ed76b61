//! The recorded figures as a page of the documentation.
//!
//! In:  the recorded figures.
//! Out: `docs/instructions.md`.

use crate::recorded::Recorded;
use crate::report;
use std::error::Error;
use std::fs;
use std::path::PathBuf;

const HEAD: &str = "# Instructions of the generated code

Instructions of one call in the steady state, counted by callgrind on code built for
x86-64-v3, beside other generators and code written by hand. One evaluation is everything
that an acceleration needs: the mass matrix, the forces, the constraints' Jacobian and
their right-hand side. A step is one of Runge and Kutta's classical method, four
accelerations, with positions and velocities brought back onto the constraints. `robust`
is one acceleration and the way back onto the constraints of a row that has fallen into
one line up to 2e-4 rad, where half of its constraints lose their rank; the same of
parallelograms side by side, each with its own degree of freedom, of which one has fallen
into its line; and of a row with a pendulum on it. Whatever the number of degrees of
freedom is, such an acceleration is interpolated between regular states of the same sheet
of the constraint set on both sides, and costs as much as the factorisations of the
constraints at these states.

Two or three sines and cosines are computed one by one, which takes a tenth to a quarter
more instructions than a block of four lanes filled in part, and a tenth to a fifth less
time on the processors that compilers build for when they are not told (medians of 201
runs in turns: slider–crank 1.11, four-bar 1.22 times as long with blocks; with five angles
1.02, with six 0.96).

This page is written by `cargo run --release -p instructions -- table`, in `benches/`,
from `benches/recorded.json`; `short` counts again and compares, as CI does. The figures
of the others were counted once, in the same way.
";

const ELIMINATED: &str = "## Dependent coordinates

`Builder::eliminate(true)` leaves out dependent coordinates like the `q3` of
`L1*cos(q1) + L2*cos(q2) = q3`, with the constraint. The motion is the same one, through
singular positions too (`tests/eliminated.rs`). An evaluation costs as much, for what the
coordinate took goes into the other entries; the solves are smaller. It stays an option
all the same: by default the state has every coordinate that the description declares.
";

const AUDITED: &str = "## Audits

`simulate` looks at the energy and the constraint errors after each step and finds passages
through singular positions, unless it is told not to. Runs of 8 s through singular positions,
their assembly among it; `ratio` is that of `simulate` with all audits to without any.
";

const STRAIGHT: &str = "## Straight lines or loops

Functions are straight lines, of which very long solves are cut into parts for the compiler's
sake (`Builder::straight_line`); `for` in a description is unrolled. Measured once (AMD EPYC,
32 kB of first-level instruction cache, 1 MB of second-level cache; processor time):

| loops in a row | 5 | 10 | 20 | 40 | 80 |
|---|--:|--:|--:|--:|--:|
| evaluation, per loop (ns) | 10 | 8 | 7 | 8 | 10 |
| q̈, per loop (ns) | 30 | 32 | 31 | 35 | 31 |
| step, per loop (ns) | 210 | – | 221 | 231 | 240 |
| machine code that a step runs (kB) | 12 | 28 | 57 | 113 | 218 |
| rustc (s) | – | 1.3 | 2.5 | 5.2 | 10.5 |

Nothing grows faster than the mechanism, and code seven times as long as the first-level
cache costs 14 % of a step. Farther on, four accelerations and a correction by themselves
take 217 ns a loop with 20 loops, 207 with 80, 227 with 160 and 227 with 320, whose code,
0.9 MB, fills the second-level cache. Loops over tables save no arithmetic (rolled by hand,
one loop in the row of 40 takes 61 instructions of an evaluation, here 71), so up to 320
there is nothing for them to win; that could begin where the code leaves that cache, at
about 370 loops.
";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/instructions.md")
}

fn text(recorded: &Recorded) -> String {
    let counts = recorded.counts();
    format!(
        "{HEAD}{}\n{ELIMINATED}{}\n{AUDITED}{}\n{STRAIGHT}\n## Every kernel\n\n{}",
        report::peers(&counts) + &report::growth(&counts),
        report::eliminated(&counts),
        report::audited(&counts),
        report::counts(&counts, None)
    )
}

/// Writes the page.
///
/// # Errors
///
/// What the system says.
pub fn write(recorded: &Recorded) -> Result<(), Box<dyn Error>> {
    fs::write(path(), text(recorded))?;
    Ok(())
}

/// Whether the page says what is recorded.
///
/// # Errors
///
/// A page that cannot be read.
pub fn is_current(recorded: &Recorded) -> Result<bool, Box<dyn Error>> {
    Ok(fs::read_to_string(path())? == text(recorded))
}
