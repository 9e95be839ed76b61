//! The table, three times: for the terminal, as Markdown, as JSON.

use super::andrews::{PUBLISHED, Reached};
use super::problem::{Figures, Outcome};
use crate::table::{Align, headed};
use serde_json::{Value, json};

const HEADING: [&str; 10] = [
    "problem",
    "error",
    "bound",
    "energy (J)",
    "bound",
    "constraints",
    "steps",
    "time",
    "published",
    "",
];
const INTRODUCTION: &str = "\
# Benchmark problems

Written by `bricard validate`, which fails if a bound is not kept. Errors are those at
the end of the run, against closed forms and computed references whose sources stand in
`cli/validate/list.rs`. The energy is compared with what it was at the start and the
power supplied since; the constraint error is the largest of a constraint equation, in
its own unit. Times are those of the machine that wrote the table.

";
const WORK_HEADING: [&str; 5] = ["Andrews, error", "reached", "tolerance", "steps", "time"];

/// The tables for the terminal.
pub fn text(outcomes: &[Outcome], work: &[Reached]) -> String {
    let (left, right) = (Align::Left, Align::Right);
    let align = [
        left, right, right, right, right, right, right, right, left, left,
    ];
    let rows: Vec<Vec<String>> = outcomes.iter().map(row).collect();
    let mut text = headed(&HEADING, &rows, &align);
    text.extend(notes(outcomes).map(|note| format!("{note}\n")));
    let rows: Vec<Vec<String>> = work.iter().map(work_row).collect();
    let table = headed(&WORK_HEADING, &rows, &[left, right, right, right, right]);
    text + "\n" + &table + PUBLISHED + "\n"
}

/// The tables as Markdown.
pub fn markdown(outcomes: &[Outcome], work: &[Reached]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let table = |heading: &[&str], rows: Vec<Vec<String>>| {
        let heading: Vec<String> = heading.iter().map(|cell| cell.to_string()).collect();
        let rule = vec!["---".to_string(); heading.len()];
        let rows: String = rows.iter().map(|row| line(row)).collect();
        line(&heading) + &line(&rule) + &rows
    };
    let mut text = INTRODUCTION.to_string();
    text += &table(&HEADING, outcomes.iter().map(row).collect());
    text.push('\n');
    text.extend(notes(outcomes).map(|note| format!("{note}\n\n")));
    text += "## Work against accuracy\n\n";
    text += &table(&WORK_HEADING, work.iter().map(work_row).collect());
    text + "\n" + PUBLISHED + "\n"
}

/// The tables as JSON.
pub fn json(outcomes: &[Outcome], work: &[Reached]) -> String {
    let problems: Vec<Value> = outcomes.iter().map(entry).collect();
    let work: Vec<Value> = work.iter().filter_map(work_entry).collect();
    let all = json!({ "problems": problems, "andrews_work": work });
    format!("{all:#}\n")
}

fn row(outcome: &Outcome) -> Vec<String> {
    let problem = outcome.problem;
    let verdict = if outcome.broken().is_empty() {
        "ok"
    } else {
        "BROKEN"
    };
    let mut cells = vec![problem.title.to_string()];
    match &outcome.result {
        Ok(figures) => cells.extend([
            format!("{:.1e}", figures.error),
            format!("{:.0e}", problem.bound),
            format!("{:.1e}", figures.balance),
            problem
                .balance_bound
                .map_or(String::new(), |bound| format!("{bound:.0e}")),
            format!("{:.1e}", figures.constraint),
            figures.report.steps.to_string(),
            time(figures),
        ]),
        Err(_) => {
            cells.push("failed".to_string());
            cells.extend(vec![String::new(); 6]);
        }
    }
    cells.extend([problem.published.to_string(), verdict.to_string()]);
    cells
}

fn time(figures: &Figures) -> String {
    format!("{:.1} ms", 1e3 * figures.report.wall.as_secs_f64())
}

fn notes(outcomes: &[Outcome]) -> impl Iterator<Item = String> {
    outcomes.iter().filter_map(|outcome| {
        let title = outcome.problem.title;
        match &outcome.result {
            Ok(figures) => figures.stiffness.map(|ratio| {
                format!("{title}: dp5 takes {ratio:.0} times as many steps at the same tolerance")
            }),
            Err(reason) => Some(format!("{title}: {reason}")),
        }
    })
}

fn work_row(reached: &Reached) -> Vec<String> {
    let mut cells = vec![format!("{:.0e}", reached.wanted)];
    if let Ok(figures) = &reached.outcome.result {
        cells.extend([
            format!("{:.1e}", figures.error),
            format!("{:.1e}", reached.tolerance),
            figures.report.steps.to_string(),
            time(figures),
        ]);
    }
    cells
}

fn entry(outcome: &Outcome) -> Value {
    let problem = outcome.problem;
    let broken = outcome.broken();
    let mut entry = json!({
        "problem": problem.title,
        "mechanism": problem.mechanism,
        "until_s": problem.until,
        "method": problem.method.to_string(),
        "tolerance": { "relative": problem.tolerance.0, "absolute": problem.tolerance.1 },
        "error_bound": problem.bound,
        "balance_bound_J": problem.balance_bound,
        "constraint_bound": problem.constraint_bound,
        "published": problem.published,
        "passed": broken.is_empty(),
        "broken": broken,
    });
    if let (Ok(figures), Value::Object(entry)) = (&outcome.result, &mut entry) {
        let report = &figures.report;
        entry.insert("error".to_string(), json!(figures.error));
        entry.insert("balance_J".to_string(), json!(figures.balance));
        entry.insert("constraint_error".to_string(), json!(figures.constraint));
        entry.insert("steps".to_string(), json!(report.steps));
        entry.insert("rejected".to_string(), json!(report.rejected));
        entry.insert("passages".to_string(), json!(report.passages.len()));
        entry.insert("time_s".to_string(), json!(report.wall.as_secs_f64()));
        entry.insert("dp5_steps_over_these".to_string(), json!(figures.stiffness));
    }
    entry
}

fn work_entry(reached: &Reached) -> Option<Value> {
    let figures = reached.outcome.result.as_ref().ok()?;
    Some(json!({
        "wanted": reached.wanted,
        "error": figures.error,
        "tolerance": reached.tolerance,
        "steps": figures.report.steps,
        "time_s": figures.report.wall.as_secs_f64(),
    }))
}
