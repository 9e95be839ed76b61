//! How to integrate, from the options of the command line.

use super::record::is_parquet;
use crate::arguments::{MethodName, Simulate};
use crate::error::CommandError;
use crate::files::{apart, is_of, refuse};
use crate::mistakes::{all, both};
use crate::number::exact;
use crate::page::is_page;
use crate::parquet::MISSING;
use crate::run::Plan;
use bricard_codegen::internals::diagnostic::figure;
use bricard_runtime::{IntegrateError, Options, Settings, Stabilisation, StepControl, Tolerance};
use std::path::{Path, PathBuf};

/// Step of RK4, unless one is given (s).
const STEP: f64 = 0.01;
/// Relative and absolute tolerance of an adaptive method, unless one is given.
pub const TOLERANCE: f64 = 1e-9;

/// Kinds of files that rows are written to; one without a kind is CSV.
const ROWS: [&str; 4] = ["csv", "txt", "dat", "parquet"];

/// Kinds of files that plots and films are written to.
const PLOTS: [&str; 4] = ["html", "svg", "png", "pdf"];
const FILMS: [&str; 4] = ["gif", "svg", "png", "pdf"];

/// More rows than this fill a disk: they are refused.
const MOST_ROWS: f64 = 1e10;

/// Intervals of a plot, unless their length is given: the steps of an adaptive
/// method are too long for a smooth curve.
const PLOTTED: f64 = 1000.0;

/// Intervals for each second of a plot whose rows are for nothing else, and the most of them.
const DENSE: f64 = 20.0;
const MOST_DENSE: f64 = 20_000.0;

/// Intervals for each second of a page, on which the mechanism moves, and the most of them.
const FRAMES: f64 = 100.0;
const MOST_FRAMES: f64 = 6000.0;

/// The plan of a run, without columns. Its files are of kinds that can be written.
///
/// # Errors
///
/// [`CommandError::OutOfRange`], [`CommandError::UselessOption`], and those of
/// [`check_files`].
pub fn plan(arguments: &Simulate) -> Result<Plan, CommandError> {
    both(check_numbers(arguments), check_files(arguments))?;
    let method = method(arguments);
    let step_control = step_control(arguments, method);
    let mut options = Options::new(arguments.until, method.into(), step_control);
    options.settings = Settings {
        form: arguments.form.into(),
        stabilisation: arguments.stabilisation,
        published: arguments.published,
        across_switches: arguments.across_switches,
    };
    options.keep_energy = arguments.keep_energy;
    let adaptive = matches!(options.step_control, StepControl::Adaptive { .. });
    let drawn = arguments.plot.is_some() || arguments.film.is_some();
    let smooth = adaptive && drawn && arguments.until > 0.0;
    let moving = arguments.plot.as_deref().is_some_and(is_page) || arguments.film.is_some();
    let intervals = match moving {
        true => (FRAMES * arguments.until).clamp(PLOTTED, MOST_FRAMES),
        false if arguments.out.is_none() => (DENSE * arguments.until).clamp(PLOTTED, MOST_DENSE),
        false => PLOTTED,
    };
    let every = arguments
        .every
        .or(smooth.then_some(arguments.until / intervals));
    bounded(arguments, every, options.step_control)?;
    Ok(Plan {
        watched: !arguments.quiet,
        ..Plan::new(options, every, Vec::new())
    })
}

/// The method that is asked for, or the one that suits what is.
fn method(arguments: &Simulate) -> MethodName {
    arguments.method.unwrap_or(match arguments.step {
        Some(_) => MethodName::Rk4,
        None => MethodName::Dop853,
    })
}

/// The step of a method whose steps are all of one length.
fn fixed_step(arguments: &Simulate, method: MethodName) -> Option<f64> {
    let always = method == MethodName::Rk4;
    arguments.step.or(always.then_some(STEP))
}

fn step_control(arguments: &Simulate, method: MethodName) -> StepControl<f64> {
    match fixed_step(arguments, method) {
        Some(step) => StepControl::Fixed { step },
        None => {
            let relative = arguments.rtol.unwrap_or(TOLERANCE);
            StepControl::Adaptive {
                relative,
                absolute: arguments.atol.unwrap_or(relative),
            }
        }
    }
}

/// The absolute tolerance of a run, if its steps follow one.
pub fn absolute(plan: &Plan) -> Option<f64> {
    match plan.options.step_control {
        StepControl::Adaptive { absolute, .. } => Some(absolute),
        StepControl::Fixed { .. } => None,
    }
}

/// Refuses lengths and tolerances that make no sense, or that the method has no use for.
fn check_numbers(arguments: &Simulate) -> Result<(), CommandError> {
    let fixed = fixed_step(arguments, method(arguments)).is_some();
    let useless = |option, given: Option<f64>| match given {
        Some(_) if fixed => Err(CommandError::UselessOption {
            option,
            method: "rk4",
            instead: "give --step, or take --method dp5, dop853, radau5 or radau9",
        }),
        _ => Ok(()),
    };
    all([
        fits("--until", Some(arguments.until), NOT_NEGATIVE),
        fits("--every", arguments.every, POSITIVE),
        fits("--step", arguments.step, POSITIVE),
        fits("--rtol", arguments.rtol, POSITIVE),
        fits("--rtol", arguments.rtol, BELOW_ONE),
        fits("--rtol", arguments.rtol, ABOVE_ROUND_OFF),
        fits("--atol", arguments.atol, POSITIVE),
        useless("--rtol", arguments.rtol),
        useless("--atol", arguments.atol),
        keepable(arguments),
    ])?;
    Ok(())
}

/// Refuses steps that are longer than the run, and more rows than can be meant.
fn bounded(
    arguments: &Simulate,
    every: Option<f64>,
    step_control: StepControl<f64>,
) -> Result<(), CommandError> {
    let until = arguments.until;
    if let Some(step) = arguments.step.filter(|step| *step > until && until > 0.0) {
        let wanted = format!("at most the {} s of the run", exact(until));
        return out_of_range("--step", step, &wanted);
    }
    let (option, distance) = match (every, step_control) {
        (Some(every), _) => ("--every", every),
        (None, StepControl::Fixed { step }) => ("--step", step),
        (None, StepControl::Adaptive { .. }) => return Ok(()),
    };
    let least = until / MOST_ROWS;
    match distance < least {
        true => {
            let wanted = format!(
                "at least {} s, for a run of {} s with at most {MOST_ROWS:e} rows",
                figure(least),
                exact(until)
            );
            out_of_range(option, distance, &wanted)
        }
        false => Ok(()),
    }
}

/// What is wanted of a number: in words, and whether one is otherwise.
type Wanted = (&'static str, fn(f64) -> bool);

const NOT_NEGATIVE: Wanted = ("zero or positive", |value| value < 0.0);
const POSITIVE: Wanted = ("a positive number", |value| value <= 0.0);
const BELOW_ONE: Wanted = (
    "less than 1, as the part of a value that may be wrong",
    |value| value >= 1.0,
);
const ABOVE_ROUND_OFF: Wanted = (
    "at least 2.3e-15, where the round-off of numbers begins",
    |value| {
        let taken = Tolerance::<f64, 0>::uniform(value, 1.0);
        value > 0.0 && matches!(taken, Err(IntegrateError::ToleranceTooSmall { .. }))
    },
);

/// Refuses a number that is not as it is wanted.
fn fits(
    option: &'static str,
    value: Option<f64>,
    (wanted, is_wrong): Wanted,
) -> Result<(), CommandError> {
    match value.filter(|value| is_wrong(*value)) {
        Some(value) => out_of_range(option, value, wanted),
        None => Ok(()),
    }
}

/// Refuses to keep the energy by velocities alone, while positions leave the constraints.
fn keepable(arguments: &Simulate) -> Result<(), CommandError> {
    match (arguments.keep_energy, arguments.stabilisation) {
        (true, Stabilisation::None) => Err(CommandError::UselessOption {
            option: "--keep-energy",
            method: "--stabilisation none",
            instead: "where nothing keeps the constraints, the energy is not kept either; take \
                      --stabilisation projection",
        }),
        _ => Ok(()),
    }
}

fn out_of_range(option: &'static str, value: f64, wanted: &str) -> Result<(), CommandError> {
    Err(CommandError::OutOfRange {
        option,
        value,
        wanted: wanted.to_string(),
    })
}

/// Refuses kinds of file that can't be written, before anything is computed.
///
/// # Errors
///
/// [`CommandError::FileKind`], [`CommandError::SameFile`], [`CommandError::ReadHere`].
fn check_files(arguments: &Simulate) -> Result<(), CommandError> {
    different(arguments)?;
    wide(arguments).and_then(|()| live(arguments))?;
    rows(arguments)?;
    if let Some(plot) = &arguments.plot
        && !is_of(plot, &PLOTS)
    {
        return refuse(
            plot,
            "plots are pages, SVG, PNG or PDF; write `--plot run.html`, `--plot run.svg`, \
             `--plot run.png` or `--plot run.pdf`",
        );
    }
    if let Some(plot) = &arguments.plot
        && arguments.phase.is_some()
        && is_page(plot)
    {
        return refuse(
            plot,
            "one quantity over another is drawn as SVG, PNG or PDF; write `--plot run.svg`",
        );
    }
    if let Some(film) = &arguments.film
        && !is_of(film, &FILMS)
    {
        return refuse(
            film,
            "films are GIF, strips of configurations SVG, PNG or PDF; write `--film run.gif` or \
             `--film run.svg`",
        );
    }
    Ok(())
}

/// Refuses rows in a kind of file that can't be written.
fn rows(arguments: &Simulate) -> Result<(), CommandError> {
    let Some(out) = &arguments.out else {
        return Ok(());
    };
    if out.extension().is_some() && !is_of(out, &ROWS) {
        return refuse(
            out,
            "rows are written as CSV or as Parquet; write `--out run.csv` or `--out run.parquet`",
        );
    }
    let unfinished = arguments.checkpoint.is_some() || arguments.resume.is_some();
    match (is_parquet(out), MISSING) {
        (true, Some(missing)) => refuse(out, missing),
        (true, None) if unfinished => refuse(
            out,
            "rows can't be added to Parquet after a checkpoint; write `--out run.csv`",
        ),
        _ => Ok(()),
    }
}

/// Refuses sliders where there is no page.
fn live(arguments: &Simulate) -> Result<(), CommandError> {
    match arguments.live && !arguments.plot.as_deref().is_some_and(is_page) {
        true => Err(CommandError::UselessOption {
            option: "--live",
            method: "a plot that is no page",
            instead: "write `--plot run.html`",
        }),
        false => Ok(()),
    }
}

/// Refuses a width where nothing has one.
fn wide(arguments: &Simulate) -> Result<(), CommandError> {
    let refuse = |method, instead| {
        Err(CommandError::UselessOption {
            option: "--width",
            method,
            instead,
        })
    };
    let for_print = |path: &&PathBuf| !is_page(path) && !is_of(path, &["gif"]);
    let mut pictures = arguments.plot.iter().chain(&arguments.film);
    match (arguments.width, pictures.clone().next()) {
        (None, _) => Ok(()),
        (Some(_), None) => refuse("a run without a picture", "add `--plot run.pdf`"),
        (Some(_), Some(_)) if pictures.any(|path| for_print(&path)) => Ok(()),
        (Some(_), Some(_)) => refuse(
            "what moves",
            "write `--plot run.pdf` or `--film run.pdf`, or another name in .svg or .png",
        ),
    }
}

/// Refuses one file for two purposes: the one would replace the other or what is read.
fn different(arguments: &Simulate) -> Result<(), CommandError> {
    let rows_go_there = match &arguments.out {
        Some(out) => out == Path::new("-"),
        None => arguments.plot.is_none() && arguments.film.is_none(),
    };
    if arguments.json && rows_go_there {
        return Err(CommandError::SameFile {
            options: ["--json", "--out"],
            path: PathBuf::from("standard output"),
            instead: "write the rows to a file, such as `--out run.csv`",
        });
    }
    let written = [
        ("--out", &arguments.out),
        ("--plot", &arguments.plot),
        ("--film", &arguments.film),
        ("--checkpoint", &arguments.checkpoint),
    ];
    apart(&arguments.name, &written)
}
