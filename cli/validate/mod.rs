//! `bricard validate`: the benchmark problems of the field.
//!
//! In:  the folder for the tables.
//! Out: one table of errors, balances, work and published figures, on standard
//!      output and as `validation.md` and `validation.json`; a failure if a bound is
//!      not kept.

mod andrews;
mod list;
mod problem;
mod report;

use crate::arguments::Validate;
use crate::error::CommandError;
use crate::output::{print, write};
use list::PROBLEMS;
use problem::Outcome;
use std::fs;

/// Runs the problems.
pub fn validate(arguments: &Validate) -> Result<(), CommandError> {
    let folder = &arguments.out;
    fs::create_dir_all(folder).map_err(|error| CommandError::write(folder, error))?;
    let chosen = PROBLEMS
        .iter()
        .filter(|problem| !(arguments.quick && problem.long));
    let outcomes: Vec<Outcome> = chosen.map(problem::solve).collect::<Result<_, _>>()?;
    let work = andrews::work(arguments.quick)?;
    print(&report::text(&outcomes, &work))?;
    let (markdown, json) = (folder.join("validation.md"), folder.join("validation.json"));
    write(&markdown, &report::markdown(&outcomes, &work))?;
    write(&json, &report::json(&outcomes, &work))?;
    print(&format!(
        "\nwritten: {}, {}\n",
        markdown.display(),
        json.display()
    ))?;
    let broken: Vec<String> = outcomes.iter().flat_map(Outcome::broken).collect();
    if broken.is_empty() {
        print("every bound is kept\n")
    } else {
        Err(CommandError::OutOfBounds(broken))
    }
}
