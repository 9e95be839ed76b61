//! Which checkpoints a run writes and goes on from, from the options of the command line.

use super::cases::Case;
use crate::arguments::Simulate;
use crate::checkpoint::{Checkpoint, Checkpoints, NONE, read};
use crate::error::CommandError;
use crate::formula::Setting;
use crate::mechanism::identity;
use crate::output::{probe, say};
use crate::run::Plan;
use bricard_driver::Changes;
use bricard_runtime::Structure;
use std::path::Path;

/// The checkpoints of a run, if it has some.
///
/// # Errors
///
/// [`CommandError::Read`], [`CommandError::Write`], [`CommandError::Checkpoint`].
pub fn checkpoints(
    (arguments, case): (&Simulate, &Case),
    plan: &Plan,
    changes: &Changes,
    structure: &'static Structure,
) -> Result<Option<Checkpoints>, CommandError> {
    if arguments.checkpoint.is_none() && arguments.resume.is_none() {
        return Ok(None);
    }
    if let Some(file) = &arguments.checkpoint {
        probe(file)?;
    }
    let run = described((arguments, case), plan, changes)?;
    let from = arguments.resume.as_ref();
    let from = from.map(|file| read(file, &run, structure)).transpose()?;
    if let (Some(file), Some(checkpoint)) = (&arguments.resume, &from) {
        goes_further(arguments.until, file, checkpoint)?;
    }
    Ok(Some(Checkpoints {
        run,
        file: arguments.checkpoint.clone(),
        from,
    }))
}

/// Refuses an end that the run has passed already.
fn goes_further(until: f64, file: &Path, checkpoint: &Checkpoint) -> Result<(), CommandError> {
    match checkpoint.state.first() {
        Some(&t) if until < t => Err(CommandError::Checkpoint {
            path: file.to_path_buf(),
            reason: format!("the run has come to t = {t} s already; give a later --until"),
        }),
        _ => Ok(()),
    }
}

/// Everything that decides the bits of a run, a line for each choice. Its end is not among
/// it: a run may be taken up again to go further.
fn described(
    (arguments, case): (&Simulate, &Case),
    plan: &Plan,
    changes: &Changes,
) -> Result<String, CommandError> {
    let (options, settings) = (&plan.options, &plan.options.settings);
    let is_law = |setting: &&Setting| matches!(setting, Setting::Law { .. });
    let laws: Vec<&Setting> = case.set.iter().filter(is_law).collect();
    let set = (&changes.parameters, &changes.inputs, laws);
    let lines: [(&str, String); 13] = [
        ("version", env!("CARGO_PKG_VERSION").to_string()),
        ("mechanism", identity(&arguments.name)?),
        ("--set", format!("{set:?}")),
        ("--start", format!("{:?}", changes.given)),
        ("--method", options.method.to_string()),
        ("step or tolerance", format!("{:?}", options.step_control)),
        ("--form", settings.form.to_string()),
        ("--stabilisation", format!("{:?}", settings.stabilisation)),
        ("--published", settings.published.to_string()),
        ("--across-switches", settings.across_switches.to_string()),
        ("--keep-energy", options.keep_energy.to_string()),
        ("--every", format!("{:?}", plan.every)),
        ("--columns", format!("{:?}", plan.columns)),
    ];
    let lines = lines.map(|(name, choice)| format!("{name}: {choice}"));
    Ok(lines.join("\n"))
}

/// Says how a run that ended early can be taken up again, or why it can't.
pub fn say_how_to_go_on(arguments: &Simulate, resumable: bool) {
    let Some(file) = arguments.checkpoint.as_ref() else {
        return;
    };
    let file = file.display();
    match resumable {
        true => say(&format!(
            "the run can be taken up again: the same command with `--resume {file}`"
        )),
        false => say(NONE),
    }
}
