//! Findings as text: the source underlined, what is wrong, what to write instead.
//!
//! In:  findings, the name of the file and its text.
//! Out: plain text without colour, one block for each finding; the first line of a
//!      block begins with `file:line:column`, which editors make a link of.
//!
//! Not here: the drawing of snippets, which is annotate-snippets'.

use super::{Diagnostic, Diagnostics, LIBRARY, Label, Severity, without_mark};
use annotate_snippets::{Annotation, AnnotationKind, Level, Renderer, Snippet};
use std::borrow::Cow;
use std::ops::Range;

/// More findings than this are counted, not shown: the first ones usually cause
/// the rest.
const SHOWN: usize = 40;
/// Bytes of a long line that are looked at before and behind what is underlined; the screen
/// has room for fewer.
const BESIDE: usize = 4096;

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
    let here: Vec<_> = labels
        .filter(|(_, label)| label.span.library == library)
        .map(|(kind, label)| (kind, label, covered(label, source)))
        .collect();
    let part = surroundings(here.iter().map(|(_, _, range)| range), source);
    let here = here.into_iter().map(|(kind, label, range)| {
        let annotation = kind.span(range.start - part.start..range.end - part.start);
        match label.text.as_str() {
            "" => annotation,
            text => annotation.label(text),
        }
    });
    let line = 1 + source[..part.start].matches('\n').count();
    Snippet::source(with_line_feeds(source, part.clone()))
        .line_start(line)
        .annotations(here)
}

/// A piece of a text with a blank for each carriage return that ends a line with its line
/// feed, so that all places stay and no sign is shown for it.
fn with_line_feeds(source: &str, part: Range<usize>) -> Cow<'_, str> {
    let text = &source[part.start..part.end];
    let followed = source[part.end..].starts_with('\n');
    match text.contains('\r') {
        false => Cow::Borrowed(text),
        true => {
            let inside = text.replace("\r\n", " \n");
            match inside.strip_suffix('\r').filter(|_| followed) {
                Some(rest) => Cow::Owned(format!("{rest} ")),
                None => Cow::Owned(inside),
            }
        }
    }
}

/// The bytes that a label covers, as far as the text has them.
fn covered(label: &Label, source: &str) -> Range<usize> {
    let range = label.span.range();
    let end = floor_char_boundary(source, range.end);
    floor_char_boundary(source, range.start.min(end))..end
}

/// The lines that some labels stand in, without what is far from all of them in long ones: a
/// text of many megabytes takes no longer to show than its lines do.
fn surroundings<'a>(
    labels: impl Iterator<Item = &'a Range<usize>> + Clone,
    source: &str,
) -> Range<usize> {
    let first = labels.clone().map(|range| range.start).min().unwrap_or(0);
    let last = labels.map(|range| range.end).max().unwrap_or(0);
    let begin = source[..first].rfind('\n').map_or(0, |newline| newline + 1);
    let end = source[last..]
        .find('\n')
        .map_or(source.len(), |length| last + length);
    let begin = begin.max(floor_char_boundary(source, first.saturating_sub(BESIDE)));
    begin..end.min(floor_char_boundary(source, last + BESIDE))
}

/// The last boundary between characters at or before a byte of the text.
fn floor_char_boundary(source: &str, byte: usize) -> usize {
    let last = byte.min(source.len());
    let boundary = (0..=last).rev().find(|&byte| source.is_char_boundary(byte));
    boundary.unwrap_or(0)
}
