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
constraints at these states. `generation` is the compiler's own work, from the description to
Rust.

Two or three sines and cosines are computed one by one, after one look at the sizes of all
angles. In lanes they would take fewer instructions, but the lanes are loaded from what was
stored entry by entry just before, for which processors wait: a run of the slider–crank takes
1.05 times as long by RK4 and 1.35 times by DOP853 (medians of 21 runs in turns, x86-64-v3).

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

Short functions are straight lines. In long ones, what comes again and again as bodies and loops
of a description do is a loop: steps of one form that refer, from turn to turn, to entries at
even distances. Both compute the same, to the last bit. A straight line keeps more in registers
and computes two values at once where it can; a loop is compiled in a fraction of the time, and
stays in the processor's first cache. `Builder::unrolled` says from how many operations on there
are loops: 8,000 unless it is given, where they are hardly slower on any processor; what the command
compiles for all processors has them from 3,000 on. Functions that no step of a run calls have
them from 1,000 on, for compilers look at them all the same. An acceleration has about 170
operations for each loop of a row, 730 for each body in Euler parameters, 130 for each rod.

Measured by `cargo run --release -p instructions -- size --record`, once; times of one run are to
be compared. Generation, lines, rustc and machine code are those for x86-64, of all functions of
the module.

";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/instructions.md")
}

/// The table of straight lines and loops.
const FORMS: &str = include_str!("../../forms.md");

/// Replaces it.
///
/// # Errors
///
/// What the system says.
pub fn record_forms(table: &str) -> Result<(), Box<dyn Error>> {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    Ok(fs::write(here.join("../forms.md"), table)?)
}

fn text(recorded: &Recorded) -> String {
    let counts = recorded.counts();
    format!(
        "{HEAD}{}\n{ELIMINATED}{}\n{AUDITED}{}\n{STRAIGHT}{FORMS}\n## Every kernel\n\n{}",
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
