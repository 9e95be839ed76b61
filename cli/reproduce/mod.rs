//! `bricard reproduce`: the experiments of Phong & Hoang (2012), section 4.
//!
//! In:  the folder for the figures.
//! Out: figures 2, 3, 4 and 6; end values beside exact ones, constraint errors
//!      beside the paper's, passages through singular positions, the forms of
//!      the equations compared; a failure if a bound is not kept.

mod experiment;
mod figures;
mod forms;
mod order;
mod reference;
mod report;

use crate::arguments::Reproduce;
use crate::error::CommandError;
use crate::output::print;
use experiment::{EXPERIMENTS, Outcome};
use report::Findings;
use std::fs;

/// Runs the experiments.
pub fn reproduce(arguments: &Reproduce) -> Result<(), CommandError> {
    let folder = &arguments.out;
    fs::create_dir_all(folder).map_err(|error| CommandError::write(folder, error))?;
    let outcomes: Vec<Outcome> = EXPERIMENTS
        .iter()
        .map(experiment::perform)
        .collect::<Result<_, _>>()?;
    let mut findings = Findings::default();
    print(&report::introduction())?;
    print(&report::end_values(&outcomes, &mut findings))?;
    print(&report::constraint_errors(&outcomes, &mut findings))?;
    print(&report::passages(&outcomes, &mut findings))?;
    print(&report::symmetry(&outcomes, &mut findings))?;
    print(&forms::comparison(&outcomes, &mut findings)?)?;
    print(&order::table(&mut findings)?)?;
    print(&report::work(&outcomes))?;
    let written = figures::draw(folder, &outcomes)?;
    print(&format!("\nfigures: {}\n", written.join(", ")))?;
    match findings.broken {
        broken if broken.is_empty() => print("every bound is kept\n"),
        broken => Err(CommandError::OutOfBounds(broken)),
    }
}
