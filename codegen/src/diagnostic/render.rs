//! Findings as text: the place in the first line, the source underlined, help.
//!
//! In:  findings, the name of the file and its text.
//! Out: plain text without colour, one block for each finding.

use super::{Diagnostic, Severity, Span};
use ariadne::{CharSet, Config, IndexType, Label, Report, ReportKind, Source};
use std::ops::Range;

/// More findings than this are counted, not shown: the first ones usually cause
/// the rest.
const SHOWN: usize = 40;

type Place<'a> = (&'a str, Range<usize>);

/// Renders findings in the order given.
pub fn render(diagnostics: &[&Diagnostic], file: &str, source: &str) -> String {
    let mut cache = (file, Source::from(source));
    let mut text = String::new();
    for diagnostic in diagnostics.iter().take(SHOWN) {
        let mut bytes = Vec::new();
        let kind = kind(diagnostic, file);
        let written = report(diagnostic, &kind, file, source).write(&mut cache, &mut bytes);
        let block = match written {
            Ok(()) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(_) => format!("{kind}: {}", diagnostic.message),
        };
        let lines: Vec<_> = block.lines().map(str::trim_end).collect();
        text.push_str(lines.join("\n").trim_end());
        text.push_str("\n\n");
    }
    if diagnostics.len() > SHOWN {
        text.push_str(&format!("… and {} more\n", diagnostics.len() - SHOWN));
    }
    text.truncate(text.trim_end().len());
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

/// `file:line:column: error`, which editors turn into a link.
fn kind(diagnostic: &Diagnostic, file: &str) -> String {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    format!("{file}:{}: {severity}", diagnostic.primary.span)
}

fn report<'k, 'a>(
    diagnostic: &Diagnostic,
    kind: &'k str,
    file: &'a str,
    source: &str,
) -> Report<'k, Place<'a>> {
    let place = |span: Span| (file, visible(span, source));
    let config = Config::new()
        .with_color(false)
        .with_char_set(CharSet::Unicode)
        .with_index_type(IndexType::Byte);
    let kind = ReportKind::Custom(kind, ariadne::Color::Primary);
    let mut builder = Report::build(kind, place(diagnostic.primary.span))
        .with_config(config)
        .with_message(&diagnostic.message);
    let labels = std::iter::once(&diagnostic.primary).chain(&diagnostic.secondary);
    for label in labels {
        let mut drawn = Label::new(place(label.span));
        if !label.text.is_empty() {
            drawn = drawn.with_message(&label.text);
        }
        builder = builder.with_label(drawn);
    }
    if let Some(help) = &diagnostic.help {
        builder = builder.with_help(help);
    }
    builder.finish()
}

/// The bytes to underline: at least one character, inside the text, and not
/// behind the end of its first line.
fn visible(span: Span, source: &str) -> Range<usize> {
    let start = span.range().start.min(source.len());
    let rest = &source[start..];
    let line = rest.find('\n').unwrap_or(rest.len());
    let end = span.range().end.clamp(start, start + line);
    if end > start {
        return start..end;
    }
    let step = |text: &str| text.chars().next().map_or(0, char::len_utf8);
    start..start + step(rest)
}
