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
one line up to 2e-4 rad, where half of its constraints lose their rank.

This page is written by `cargo run --release -p instructions -- table`, in `benches/`,
from `benches/recorded.json`; `short` counts again and compares, as CI does. The figures
of the others were counted once, in the same way.
";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/instructions.md")
}

fn text(recorded: &Recorded) -> String {
    let counts = recorded.counts();
    format!(
        "{HEAD}{}\n## Every kernel\n\n{}",
        report::peers(&counts) + &report::growth(&counts),
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
