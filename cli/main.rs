//! The `bricard` command.
//!
//! In:  a command line.
//! Out: tables, equations, rows of numbers and pictures; exit status 0, 1 for a
//!      run that failed, 2 for a command line that is wrong, 130 after Ctrl-C.
//!
//! Not here: mechanics. This is a host program like any other, which happens to
//! know every mechanism of the library by its name.

mod arguments;
mod cache;
mod captions;
mod changes;
mod check;
mod checkpoint;
mod column;
mod comparison;
mod compiled;
mod description;
mod error;
mod export;
mod figure;
mod file_error;
mod files;
mod formula;
mod gallery;
mod hash;
mod interrupt;
mod law;
mod list;
mod manual;
mod mechanism;
mod mistakes;
mod new;
mod number;
mod output;
mod page;
#[cfg_attr(not(feature = "parquet"), path = "without_parquet.rs")]
mod parquet;
mod passage;
mod place;
mod plot;
mod progress;
mod raster;
mod reproduce;
mod rows;
mod run;
mod scene;
mod show;
mod simulate;
mod table;
mod validate;
mod watch;
mod workprecision;

use arguments::{Arguments, Command};
use clap::Parser;
use error::CommandError;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let performed = arguments.command.as_ref().map_or_else(greet, perform);
    match performed {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if !error.is_silent() {
                output::complain(&error);
            }
            ExitCode::from(error.status())
        }
    }
}

/// What somebody sees who types nothing but the command's name.
fn greet() -> Result<(), CommandError> {
    output::print(
        "bricard simulates closed-loop mechanisms straight through their singular positions.\n\n\
         Begin with\n  \
         bricard list                                      what mechanisms there are\n  \
         bricard simulate slider_crank --plot crank.html   one of them; open crank.html to see it move\n  \
         bricard new my-engine                             a mechanism of your own\n\n\
         `bricard --help` lists all commands.\n",
    )
}

fn perform(command: &Command) -> Result<(), CommandError> {
    if let Command::Simulate(arguments) | Command::Watch(arguments) = command
        && arguments.quiet
    {
        output::be_quiet();
    }
    match command {
        Command::List => list::list(),
        Command::Show(arguments) => show::show(arguments),
        Command::Simulate(arguments) => simulate::simulate(arguments),
        Command::Reproduce(arguments) => reproduce::reproduce(arguments),
        Command::WorkPrecision(arguments) => workprecision::workprecision(arguments),
        Command::Passage(arguments) => passage::passage(arguments),
        Command::Watch(arguments) => watch::watch(arguments),
        Command::Cache(arguments) => cache::cache(arguments),
        Command::Check(arguments) => check::check(arguments),
        Command::Export(arguments) => export::export(arguments),
        Command::Gallery(arguments) => gallery::gallery(arguments),
        Command::New(arguments) => new::new(arguments),
        Command::Completions(arguments) => manual::completions(arguments),
        Command::Man(arguments) => manual::man(arguments),
        Command::Validate(arguments) => validate::validate(arguments),
    }
}
