//! The numbers of the experiments, as tables.

use super::experiment::{Outcome, STEP};
use super::reference::{PASSAGES, PASSAGES_IN_PAPER};
use crate::number::largest;
use crate::table::{Align, headed};

/// Distance at which a passage counts as the exact one, whose time is rounded to
/// the millisecond (s).
const PASSAGE_TIME: f64 = 1e-3;
/// Bound of the differences between the parallel cranks of the double four-bar
/// (rad).
const SYMMETRY_BOUND: f64 = 1e-12;

/// Which bounds are not kept, so far.
#[derive(Debug, Default)]
pub struct Findings {
    /// A sentence for each.
    pub broken: Vec<String>,
}

impl Findings {
    /// Says whether a value keeps a bound, and remembers it if it does not.
    pub fn judge(&mut self, what: &str, value: f64, bound: f64) -> String {
        if value <= bound {
            return "ok".to_string();
        }
        self.broken
            .push(format!("{what}: {value:.2e}, bound {bound:.0e}"));
        "BROKEN".to_string()
    }
}

/// What the tables are about.
pub fn introduction() -> String {
    format!(
        "Phong & Hoang, Multibody System Dynamics 27 (2012) 487–503, section 4:\n\
         RK4, h = {STEP} s, positions and velocities projected after each step.\n\n"
    )
}

/// End values beside the exact ones.
pub fn end_values(outcomes: &[Outcome], findings: &mut Findings) -> String {
    let mut rows = Vec::new();
    for outcome in outcomes {
        let (experiment, end) = (outcome.experiment, outcome.end());
        let error = (end.q1 - experiment.exact.q1).abs();
        let verdict = findings.judge(
            &format!("{}: error of q1", experiment.title),
            error,
            experiment.angle_bound,
        );
        rows.push(vec![
            experiment.title.to_string(),
            "q1 (rad)".to_string(),
            format!("{:.12}", end.q1),
            format!("{:.12}", experiment.exact.q1),
            format!("{error:.1e}"),
            format!("{:.0e}", experiment.angle_bound),
            verdict,
        ]);
        rows.push(vec![
            String::new(),
            "der(q1) (rad/s)".to_string(),
            format!("{:.12}", end.dq1),
            format!("{:.12}", experiment.exact.dq1),
            format!("{:.1e}", (end.dq1 - experiment.exact.dq1).abs()),
            String::new(),
            String::new(),
        ]);
    }
    let heading = ["end values", "", "here", "exact", "error", "bound", ""];
    let (left, right) = (Align::Left, Align::Right);
    headed(
        &heading,
        &rows,
        &[left, left, right, right, right, right, left],
    ) + "\n"
}

/// Constraint errors beside the paper's.
pub fn constraint_errors(outcomes: &[Outcome], findings: &mut Findings) -> String {
    let row = |outcome: &Outcome| {
        let experiment = outcome.experiment;
        let position = outcome.largest_error(0);
        let what = format!("{}: constraint error", experiment.title);
        let verdict = findings.judge(&what, position, experiment.constraint_bound);
        vec![
            experiment.title.to_string(),
            format!("{position:.1e}"),
            format!("{:.1e}", outcome.largest_error(1)),
            experiment.paper_error.to_string(),
            format!("{:.0e}", experiment.constraint_bound),
            verdict,
        ]
    };
    let rows: Vec<_> = outcomes.iter().map(row).collect();
    let heading = [
        "largest constraint error",
        "positions (m)",
        "velocities (m/s)",
        "paper",
        "bound",
        "",
    ];
    let right = Align::Right;
    headed(
        &heading,
        &rows,
        &[Align::Left, right, right, right, right, Align::Left],
    ) + "\n"
}

/// Passages through singular positions, those of the double four-bar beside the
/// exact ones.
pub fn passages(outcomes: &[Outcome], findings: &mut Findings) -> String {
    let mut text = "passages through singular positions\n".to_string();
    for outcome in outcomes {
        let times: Vec<f64> = outcome
            .report
            .passages
            .iter()
            .map(|passage| passage.t)
            .collect();
        let title = outcome.experiment.title;
        text.push_str(&format!(
            "{title}: {}\n  found  {}\n",
            times.len(),
            listed(&times)
        ));
        if outcome.experiment.mechanism == "double_four_bar" {
            text.push_str(&format!(
                "  exact  {}\n  The paper speaks of {PASSAGES_IN_PAPER}; the exact solution has {}.\n",
                listed(&PASSAGES),
                PASSAGES.len()
            ));
            let same = times.len() == PASSAGES.len();
            let off = largest(
                times
                    .iter()
                    .zip(PASSAGES)
                    .map(|(found, exact)| found - exact),
            );
            let off = if same { off } else { f64::INFINITY };
            findings.judge(
                &format!("{title}: times of passages (s)"),
                off,
                PASSAGE_TIME,
            );
        }
    }
    text + "\n"
}

fn listed(times: &[f64]) -> String {
    let times: Vec<String> = times.iter().map(|t| format!("{t:.3}")).collect();
    let lines: Vec<String> = times.chunks(12).map(|chunk| chunk.join("  ")).collect();
    if lines.is_empty() {
        "none".to_string()
    } else {
        lines.join("\n         ")
    }
}

/// Whether the cranks of the double four-bar stay parallel.
pub fn symmetry(outcomes: &[Outcome], findings: &mut Findings) -> String {
    let Some(outcome) = outcomes
        .iter()
        .find(|o| o.experiment.mechanism == "double_four_bar")
    else {
        return String::new();
    };
    let apart = |row: &Vec<f64>| match row[..] {
        [_, q1, _, q3, _, q5, ..] => largest([q1 - q3, q1 - q5]),
        _ => f64::NAN,
    };
    let most = largest(outcome.rows.iter().map(apart));
    let verdict = findings.judge("double four-bar: q1 = q3 = q5", most, SYMMETRY_BOUND);
    format!(
        "double four-bar: q1, q3 and q5 differ by at most {most:.1e} rad \
         (bound {SYMMETRY_BOUND:.0e})  {verdict}\n\n"
    )
}

/// What the runs cost.
pub fn work(outcomes: &[Outcome]) -> String {
    let row = |outcome: &Outcome| {
        let report = &outcome.report;
        let counters = &report.counters;
        let total = counters.cheap_accelerations
            + counters.beside_accelerations
            + counters.robust_accelerations;
        vec![
            outcome.experiment.title.to_string(),
            report.steps.to_string(),
            format!("{:.1} ms", 1e3 * report.wall.as_secs_f64()),
            format!(
                "{:.1} %",
                100.0 * counters.cheap_accelerations as f64 / total.max(1) as f64
            ),
            counters.rank_decisions.to_string(),
            format!("{:.1e} J", report.energy_error),
        ]
    };
    let rows: Vec<_> = outcomes.iter().map(row).collect();
    let heading = [
        "work",
        "steps",
        "wall time",
        "cheap accelerations",
        "rank decisions",
        "energy error",
    ];
    let right = Align::Right;
    headed(
        &heading,
        &rows,
        &[Align::Left, right, right, right, right, right],
    )
}
