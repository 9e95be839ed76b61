//! A run as one page: the mechanism moving, its curves, its description.
//!
//! In:  a mechanism, rows, what is known of the run.
//! Out: the text of an HTML file that needs nothing else, no network either.
//!
//! Not here: how it looks and what it does when it is open (`assets/`). All that a
//! description says reaches the page as one JSON text, which its script takes apart: no
//! name and no comment ever becomes markup.

mod data;
mod equations;
mod live;
mod sliders;
mod thin;

pub use live::Live;
pub use sliders::Sliders;

use crate::column::Column;
use crate::comparison::Comparison;
use crate::error::CommandError;
use crate::output::replace;
use bricard_driver::{AnyMechanism, WORDS};
use bricard_runtime::Structure;
use serde_json::Value;
use std::path::Path;

/// The page, with `{{NAME}}` where something has to go.
const TEMPLATE: &str = include_str!("assets/page.html");
/// What goes into all pages. Only `run` differs from one to the next.
const PARTS: [(&str, &str); 3] = [
    (
        "style",
        concat!(
            include_str!("assets/vendor/uPlot.min.css"),
            include_str!("assets/page.css"),
        ),
    ),
    ("uPlot", include_str!("assets/vendor/uPlot.iife.min.js")),
    (
        "script",
        concat!(
            include_str!("assets/text.js"),
            include_str!("assets/scene.js"),
            include_str!("assets/view.js"),
            include_str!("assets/curves.js"),
            include_str!("assets/player.js"),
            include_str!("assets/sliders.js"),
            include_str!("assets/page.js"),
        ),
    ),
];

/// The wrapper of a mechanism, for pages and Node.
const WRAPPER: &str = include_str!("../../wasm/js/index.js");
/// What runs a mechanism beside the page.
const WORKER: &str = include_str!("assets/worker.js");

/// What a page tells of a run.
pub struct Run<'a> {
    /// The mechanism, as it was set for the run.
    pub mechanism: &'a dyn AnyMechanism,
    /// What the command line calls it.
    pub name: &'a str,
    /// The file of its description and the text of it, as far as it is known.
    pub source: Option<(String, String)>,
    /// Columns besides time, coordinates and velocities.
    pub columns: &'a [Column],
    /// The columns that are drawn over time, by their places in the rows; all if there are
    /// none.
    pub curves: &'a [usize],
    /// The rows; of several runs those of the one that moves.
    pub rows: &'a [Vec<f64>],
    /// The curves of several runs, if there are several.
    pub compared: Option<Comparison>,
    /// What the run that moves is called among several.
    pub moving: &'a str,
    /// What happened, and when.
    pub marks: &'a [crate::plot::Marks],
    /// How it was integrated: pairs of words.
    pub settings: Vec<[String; 2]>,
    /// What came of it: pairs of words.
    pub summary: Vec<[String; 2]>,
    /// Why it ended early.
    pub error: Option<String>,
    /// What keeps the page up to date, if something does.
    pub live: Option<&'a Live>,
    /// The mechanism itself, if the page has sliders.
    pub sliders: Option<&'a Sliders<'a>>,
}

/// Whether a file of this name is a page.
pub fn is_page(path: &Path) -> bool {
    path.extension()
        .is_some_and(|kind| kind.eq_ignore_ascii_case("html"))
}

/// The columns that a page shows: those that are wanted, and what every run has that costs
/// little to tell.
pub fn columns(wanted: &[Column], structure: &Structure) -> Vec<Column> {
    let mut all = wanted.to_vec();
    let of_all = |column: &Column| match column {
        Column::Energy | Column::Kinetic | Column::Potential => true,
        Column::ConstraintError => !structure.constraints.is_empty(),
        _ => false,
    };
    let outputs = (0..structure.outputs.len()).map(Column::Output);
    let words = WORDS.iter().map(|(_, column)| *column).filter(of_all);
    for column in outputs.chain(words) {
        if !all.contains(&column) {
            all.push(column);
        }
    }
    all
}

/// Writes the page of a run, whole or not at all.
///
/// # Errors
///
/// [`CommandError::Write`]; [`CommandError::Draw`] if the mechanism does not answer.
pub fn write(path: &Path, run: &Run) -> Result<(), CommandError> {
    let failed = |reason| CommandError::Draw(path.to_path_buf(), reason);
    let data = data::data(run).map_err(failed)?;
    replace(path, page(run.mechanism.structure().name, &data).as_bytes())?;
    run.live.map_or(Ok(()), Live::renew)
}

/// The text of a page.
fn page(title: &str, data: &Value) -> String {
    let mut text = String::new();
    let mut rest = TEMPLATE;
    while let Some((before, name, after)) = marker(rest) {
        text.push_str(before);
        match name {
            "title" => text.push_str(&escaped(title)),
            // What would end the element, or begin a comment in it, begins with this.
            "worker" if data["sliders"].is_object() => text.push_str(&worker()),
            "run" => text.push_str(&data.to_string().replace('<', "\\u003c")),
            _ => text.extend(
                PARTS
                    .iter()
                    .filter(|part| part.0 == name)
                    .map(|part| part.1),
            ),
        }
        rest = after;
    }
    text + rest
}

/// The script of the worker. It is no module, which pages without a server can't start
/// everywhere.
fn worker() -> String {
    let wrapper = WRAPPER.replace("\nexport class", "\nclass");
    wrapper.replace("import.meta.url", "location.href") + WORKER
}

/// The first `{{NAME}}` of a text, and what is before and after it.
fn marker(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once("{{")?;
    let (name, after) = rest.split_once("}}")?;
    Some((before, name, after))
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{PARTS, TEMPLATE, marker, page, worker};
    use serde_json::json;

    #[test]
    fn every_marker_of_the_page_has_something_to_go_there() {
        let mut rest = TEMPLATE;
        let mut found = 0;
        while let Some((_, name, after)) = marker(rest) {
            let known = PARTS.iter().any(|part| part.0 == name);
            let other = ["title", "run", "worker"].contains(&name);
            assert!(known || other, "{name}");
            found += 1;
            rest = after;
        }
        assert_eq!(found, PARTS.len() + 3);
    }

    #[test]
    fn no_part_ends_the_element_that_it_stands_in() {
        let worker = ("worker", &*worker());
        for (name, part) in PARTS.into_iter().chain([worker]) {
            assert!(
                !part.contains("</script") && !part.contains("</style"),
                "{name}"
            );
        }
    }

    #[test]
    fn the_worker_is_no_module_and_only_where_there_are_sliders() {
        let worker = worker();
        assert!(!worker.contains("\nexport ") && !worker.contains("import.meta"));
        assert!(page("x", &json!({ "sliders": {} })).contains(&worker));
        assert!(!page("x", &json!({})).contains(&worker));
    }

    #[test]
    fn what_a_description_says_never_becomes_markup() {
        let hostile = "</script><script>alert('1')</script><!-- {{script}} \"ä\u{2028}";
        let text = page(hostile, &json!({ "docs": hostile }));
        let count = |what: &str| text.matches(what).count();
        let plain = page("x", &json!({}));
        assert_eq!(count("</script"), plain.matches("</script").count());
        assert_eq!(count("<script"), plain.matches("<script").count());
        assert_eq!(count("<!--"), plain.matches("<!--").count());
        assert!(text.contains("{{script}}"));
    }
}
