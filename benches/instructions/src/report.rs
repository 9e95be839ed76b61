//! Counts to tables.

use crate::peers::{OTHERS, PLANAR};
use crate::recorded::Recorded;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Counts by kernel.
pub type Counts = BTreeMap<String, f64>;

/// Every count beside the hand-written one, and beside what is recorded, if that is
/// something else.
pub fn counts(counts: &Counts, recorded: Option<&Recorded>) -> String {
    let mut text = String::from(match recorded {
        Some(_) => {
            "| kernel | instructions | by hand | ratio | recorded |\n|---|--:|--:|--:|--:|\n"
        }
        None => "| kernel | instructions | by hand | ratio |\n|---|--:|--:|--:|\n",
    });
    let number =
        |value: Option<f64>| value.map_or("–".to_string(), |value| format!("{value:.0}"));
    for (kernel, count) in counts {
        let (subject, work) = kernel.split_once('/').unwrap_or((kernel, ""));
        let subject = subject
            .trim_end_matches("_open")
            .trim_end_matches("_eliminated");
        let by_hand = counts.get(&format!("{subject}_hand/{work}")).copied();
        let ratio = by_hand.map_or("–".to_string(), |by_hand| {
            format!("{:.2}", count / by_hand)
        });
        let mut line = vec![format!("{count:.0}"), number(by_hand), ratio];
        line.extend(recorded.map(|recorded| number(recorded.of(kernel))));
        let _infallible = writeln!(text, "| {kernel} | {} |", line.join(" | "));
    }
    text
}

/// The peers' published figures with ours.
pub fn peers(counts: &Counts) -> String {
    let mut text = String::from(
        "\n| | slider–crank: evaluation | q̈ | double four-bar: evaluation | q̈ |\n|---|--:|--:|--:|--:|\n",
    );
    let cell = |value: Option<f64>| value.map_or("–".to_string(), |value| format!("{value:.0}"));
    let mut row = |name: &str, values: [Option<f64>; 4]| {
        let _infallible = writeln!(text, "| {name} | {} |", values.map(cell).join(" | "));
    };
    for (name, values) in PLANAR {
        row(name, values.map(|value| value.map(f64::from)));
    }
    let ours = |suffix: &str| {
        ["slider_crank", "double_four_bar"].map(|subject| {
            ["terms", "regular"]
                .map(|work| counts.get(&format!("{subject}{suffix}/{work}")).copied())
        })
    };
    for (name, suffix) in [
        ("by hand in Rust, inlined sincos", "_hand"),
        ("bricard", ""),
        ("bricard, run-time parameters", "_open"),
    ] {
        let [[a, b], [c, d]] = ours(suffix);
        row(name, [a, b, c, d]);
    }
    text.push_str("\n| evaluation | best peer | goal | bricard |\n|---|--:|--:|--:|\n");
    for (name, peer, goal, kernel) in OTHERS {
        let _infallible = writeln!(
            text,
            "| {name} | {peer} | {goal} | {} |",
            cell(counts.get(kernel).copied())
        );
    }
    text
}

/// How counts grow with the number of loops: the exponent from 10 on.
pub fn growth(counts: &Counts) -> String {
    let mut text = String::from(
        "\n| loops | 2 | 5 | 10 | 20 | 40 | 80 | exponent |\n|---|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for (name, chain, work, unit) in [
        ("evaluation", "row", "terms", 1.0),
        ("q̈", "row", "regular", 1.0),
        ("step", "row", "step", 1.0),
        ("robust", "row", "robust", 1.0),
        ("robust, one loop of them weak", "swings", "turning", 1.0),
        ("robust, two degrees of freedom", "hung", "robust", 1.0),
        ("generation, millions", "row", "generation", 1e6),
    ] {
        let at = |n: u32| Some(counts.get(&format!("{chain}_{n}/{work}"))? / unit);
        let cells = [2, 5, 10, 20, 40, 80]
            .map(|n| at(n).map_or("–".to_string(), |count| format!("{count:.0}")));
        let last = [80, 40].into_iter().find_map(|n| Some((n, at(n)?)));
        let exponent = match (at(10), last) {
            (Some(few), Some((n, many))) => {
                format!("{:.2}", (many / few).ln() / (f64::from(n) / 10.0).ln())
            }
            _ => "–".to_string(),
        };
        let _infallible = writeln!(text, "| {name} | {} | {exponent} |", cells.join(" | "));
    }
    text
}

/// What audits cost.
pub fn audited(counts: &Counts) -> String {
    let mut text = String::from(
        "\n| 8 s | method | stepper | simulate | with all audits | ratio |\n|---|---|--:|--:|--:|--:|\n",
    );
    for (name, subject) in [
        ("slider–crank", "slider_crank"),
        ("double four-bar", "double_four_bar"),
    ] {
        for (title, method) in [("RK4, h = 0.01 s", "rk4"), ("DOP853, 1e-9", "dop853")] {
            let [stepper, without, with] = ["run", "simulated", "audited"]
                .map(|work| counts.get(&format!("{subject}/{work}_{method}")).copied());
            let ratio = without.zip(with).map(|(without, with)| with / without);
            let cells =
                [(stepper, 0), (without, 0), (with, 0), (ratio, 2)].map(|(number, digits)| {
                    number.map_or("–".to_string(), |number| format!("{number:.digits$}"))
                });
            let _infallible = writeln!(text, "| {name} | {title} | {} |", cells.join(" | "));
        }
    }
    text
}

/// What leaving out the coordinates that constraints give saves.
pub fn eliminated(counts: &Counts) -> String {
    let mut text =
        String::from("\n| | evaluation | q̈ | correction | step |\n|---|--:|--:|--:|--:|\n");
    let subjects = [
        ("slider–crank, 3 → 2 coordinates", "slider_crank"),
        ("quick return, 5 → 4", "quick_return"),
        ("scotch yoke, 3 → 1", "scotch_yoke"),
    ];
    for (name, subject) in subjects {
        let cells = ["terms", "regular", "correction", "step"].map(|work| {
            let [all, less] = ["", "_eliminated"]
                .map(|suffix| counts.get(&format!("{subject}{suffix}/{work}")).copied());
            match all.zip(less) {
                Some((all, less)) => format!("{all:.0} → {less:.0}"),
                None => "–".to_string(),
            }
        });
        let _infallible = writeln!(text, "| {name} | {} |", cells.join(" | "));
    }
    text
}
