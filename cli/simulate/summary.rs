//! A run in a few lines.

use crate::error::CommandError;
use crate::run::Report;
use crate::table::{Align, aligned};
use bricard_runtime::{Counters, Form, Settings, Stabilisation, Structure};
use serde_json::{Value, json};

/// Passages and events whose times are listed.
const LISTED: usize = 20;

/// Constraint error (m or rad) above which a motion is not that of the mechanism.
const DRIFTED: f64 = 1e-3;

/// Part of the exchanged energy by which the energy may be off.
const UNBALANCED: f64 = 0.1;

/// Energy (J) below which nothing moves but round-off.
const AT_REST: f64 = 1e-26;

/// What was done and how well, one quantity in a line.
pub fn summary(report: &Report, structure: &Structure, settings: &Settings<f64>) -> String {
    let rows = quantities(report, structure, settings);
    let rows: Vec<Vec<String>> = rows.into_iter().map(Vec::from).collect();
    let mut text = aligned(&rows, &[Align::Left, Align::Left]);
    text += &drifted(report, settings);
    text += &unbalanced(report);
    text
}

/// What to say of a motion whose energy does not add up.
fn unbalanced(report: &Report) -> String {
    let Report {
        energy_error: error,
        energy_exchanged: exchanged,
        ..
    } = *report;
    match error > UNBALANCED * exchanged && error > AT_REST {
        false => String::new(),
        true => format!(
            "warning: the energy is off by {error:.1e} J, where {exchanged:.1e} J at most were \
             exchanged, and the motion is not that of the mechanism; take smaller steps or a \
             smaller tolerance\n"
        ),
    }
}

/// What to say of a motion that has drifted off the constraints.
fn drifted(report: &Report, settings: &Settings<f64>) -> String {
    let error = report.constraint_error;
    match settings.stabilisation {
        Stabilisation::Projection => String::new(),
        _ if error <= DRIFTED => String::new(),
        _ => format!(
            "warning: the motion has drifted off the constraints by {error:.1e}, and is not that of \
             the mechanism; keep it there with `--stabilisation projection`, or take a smaller \
             tolerance\n"
        ),
    }
}

/// What was done and how well: quantities and their values.
pub fn quantities(
    report: &Report,
    structure: &Structure,
    settings: &Settings<f64>,
) -> Vec<[String; 2]> {
    let mut rows = vec![
        ["steps".to_string(), report.steps.to_string()],
        ["rejected steps".to_string(), report.rejected.to_string()],
        [
            "wall time".to_string(),
            wall_time(report.wall.as_secs_f64()),
        ],
        energy(report, structure),
    ];
    let accelerations = accelerations(&report.counters, structure, settings);
    let accelerations = ["accelerations".to_string(), accelerations];
    if structure.constraints.is_empty() {
        rows.push(accelerations);
    } else {
        rows.push([
            "largest constraint error".into(),
            format!("{:.1e}", report.constraint_error),
        ]);
        rows.push([
            "passages through singular positions".into(),
            passages(report, settings),
        ]);
        rows.push(accelerations);
        rows.extend(work(&report.counters));
        rows.extend(undetermined(&report.counters));
    }
    rows.extend(
        structure
            .events
            .iter()
            .map(|event| events(event.name, report)),
    );
    rows
}

/// What was done and how well, in one line.
pub fn line(report: &Report, structure: &Structure, settings: &Settings<f64>) -> String {
    let [what, error] = energy(report, structure);
    let mut line = format!("{} steps, {what} {error}", report.steps);
    if !structure.constraints.is_empty() {
        let constraints = report.constraint_error;
        line += &format!(", largest constraint error {constraints:.1e}");
        if !settings.published {
            let passages = report.passages.len();
            line += &format!(", passages through singular positions: {passages}");
        }
    }
    line
}

/// What was done and how well, as one JSON object.
pub fn json(report: &Report, structure: &Structure, error: Option<&CommandError>) -> Value {
    let passages: Vec<f64> = report.passages.iter().map(|passage| passage.t).collect();
    let events = report.events.iter();
    let events: Vec<Value> = events
        .map(|(name, t)| json!({ "name": name, "t": t }))
        .collect();
    json!({
        "mechanism": structure.name,
        "steps": report.steps,
        "rejected_steps": report.rejected,
        "wall_seconds": report.wall.as_secs_f64(),
        "conservative": structure.conservative,
        "energy_error": report.energy_error,
        "constraint_error": report.constraint_error,
        "passages": passages,
        "events": events,
        "accelerations": {
            "cheap": report.counters.cheap_accelerations,
            "beside_singular_positions": report.counters.beside_accelerations,
            "across_singular_positions": report.counters.robust_accelerations,
        },
        "rank_decisions": report.counters.rank_decisions,
        "undetermined": report.counters.undetermined,
        "error": error.map(ToString::to_string),
    })
}

fn energy(report: &Report, structure: &Structure) -> [String; 2] {
    let what = if structure.conservative {
        "energy drift"
    } else {
        "error of the power balance"
    };
    [what.to_string(), format!("{:.1e} J", report.energy_error)]
}

fn passages(report: &Report, settings: &Settings<f64>) -> String {
    if settings.published {
        return "not looked for with `--published`".to_string();
    }
    times(
        &report
            .passages
            .iter()
            .map(|passage| passage.t)
            .collect::<Vec<_>>(),
    )
}

fn events(name: &str, report: &Report) -> [String; 2] {
    let of_name = report.events.iter().filter(|(event, _)| *event == name);
    [
        format!("event {name}"),
        times(&of_name.map(|(_, t)| *t).collect::<Vec<_>>()),
    ]
}

/// How many, and when.
fn times(all: &[f64]) -> String {
    let listed: Vec<String> = all.iter().take(LISTED).map(|t| format!("{t:.3}")).collect();
    match all.len() {
        0 => "none".to_string(),
        count if count > LISTED => format!("{count}, at t = {}, … s", listed.join(", ")),
        count => format!("{count}, at t = {} s", listed.join(", ")),
    }
}

/// A duration with three digits.
fn wall_time(seconds: f64) -> String {
    if seconds < 1.0 {
        format!("{:.3} ms", 1e3 * seconds)
    } else {
        format!("{seconds:.3} s")
    }
}

/// What a user should know if the equations left it open.
fn undetermined(counters: &Counters) -> Option<[String; 2]> {
    (counters.undetermined > 0).then(|| {
        [
            "undetermined".to_string(),
            "the mechanism was at rest in a singular position, where nothing says which branch \
             it takes; all were left open"
                .to_string(),
        ]
    })
}

/// How many accelerations there were, and by which path where the form has several.
fn accelerations(counters: &Counters, structure: &Structure, settings: &Settings<f64>) -> String {
    let Counters {
        cheap_accelerations: cheap,
        beside_accelerations: beside,
        robust_accelerations: robust,
        ..
    } = *counters;
    let total = cheap + beside + robust;
    if structure.constraints.is_empty() || settings.form != Form::Reduced || settings.published {
        return total.to_string();
    }
    let share = 100.0 * cheap as f64 / total.max(1) as f64;
    format!(
        "{cheap} by the cheap path ({share:.1} %), {beside} beside singular positions, {robust} \
         across them"
    )
}

fn work(counters: &Counters) -> Vec<[String; 2]> {
    vec![
        [
            "rank decisions".to_string(),
            counters.rank_decisions.to_string(),
        ],
        [
            "factorisations".to_string(),
            format!(
                "{} of the mass matrix, {} of the constraints",
                counters.mass_factorisations, counters.constraint_factorisations
            ),
        ],
        [
            "projections".to_string(),
            format!(
                "{} with {} corrections of positions, {} beside singular positions",
                counters.projections, counters.projection_iterations, counters.robust_projections
            ),
        ],
    ]
}
