//! Findings as text: the source underlined, what is wrong, what to write instead.
//!
//! In:  findings, the name of the file and its text.
//! Out: plain text without colour, one block for each finding; the first line of a
//!      block begins with `file:line:column`, which editors make a link of.
//!
//! Not here: the drawing of snippets, which is annotate-snippets'.

use super::{Diagnostic, Diagnostics, LIBRARY, Label, Severity, without_mark};
use annotate_snippets::{Annotation, AnnotationKind, Level, Renderer, Snippet};

/// More findings than this are counted, not shown: the first ones usually cause
/// the rest.
const SHOWN: usize = 40;

impl Diagnostics {
    /// The findings with their source lines; empty if there are none. The first
    /// line of each begins with `file:line:column`.
    pub fn render(&self, file: &str, source: &str) -> String {
        render(&self.sorted(), file, without_mark(source))
    }
}

/// Renders findings in the order given.
fn render(diagnostics: &[&Diagnostic], file: &str, source: &str) -> String {
    let shown = diagnostics.iter().take(SHOWN);
    let blocks: Vec<String> = shown
        .map(|diagnostic| block(diagnostic, file, source))
        .collect();
    let mut text = blocks.join("\n");
    if diagnostics.len() > SHOWN {
        text.push_str(&format!("\n… and {} more\n", diagnostics.len() - SHOWN));
    }
    text
}

fn block(diagnostic: &Diagnostic, file: &str, source: &str) -> String {
    let place = diagnostic.place();
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    // The level is part of the first line, behind the place.
    let message = format!("{file}:{place}: {severity}: {}", diagnostic.message);
    let title = Level::ERROR.no_name().primary_title(&message);
    let mut group = title.element(snippet(diagnostic, source, false));
    if diagnostic.primary.span.library {
        let inside = snippet(diagnostic, LIBRARY, true);
        group = Level::ERROR
            .no_name()
            .primary_title(&message)
            .element(inside.path("parts"));
        group = group.element(snippet(diagnostic, source, false).path(file));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help));
    }
    let text = Renderer::plain().render(&[group]);
    text.lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

/// The labels of a finding in one file: the description, or the library of parts.
fn snippet<'a>(
    diagnostic: &'a Diagnostic,
    source: &'a str,
    library: bool,
) -> Snippet<'a, Annotation<'a>> {
    let primary = std::iter::once((AnnotationKind::Primary, &diagnostic.primary));
    let others = diagnostic.secondary.iter();
    let labels = primary.chain(others.map(|label| (AnnotationKind::Context, label)));
    let here = labels.filter(|(_, label)| label.span.library == library);
    let here = here.map(|(kind, label)| annotation(kind, label, source));
    Snippet::source(source).annotations(here)
}

/// A label on the bytes that its span covers, as far as the text has them.
fn annotation<'a>(kind: AnnotationKind, label: &'a Label, source: &str) -> Annotation<'a> {
    let range = label.span.range();
    let end = floor_char_boundary(source, range.end);
    let start = floor_char_boundary(source, range.start.min(end));
    let annotation = kind.span(start..end);
    match label.text.as_str() {
        "" => annotation,
        text => annotation.label(text),
    }
}

/// The last boundary between characters at or before a byte of the text.
fn floor_char_boundary(source: &str, byte: usize) -> usize {
    let last = byte.min(source.len());
    let boundary = (0..=last).rev().find(|&byte| source.is_char_boundary(byte));
    boundary.unwrap_or(0)
}
