//! Findings as text: the place in the first line, the source underlined, help.
//!
//! In:  findings, the name of the file and its text.
//! Out: plain text without colour, one block for each finding:
//!
//! ```text
//! four_bar.mech:7:14: error: `L9` is not declared
//!   |
//! 7 |     kinetic 1/2*L9*der(q1)^2;
//!   |                 ^^
//!   = help: did you mean `L1`?
//! ```

use super::{Diagnostic, Label, Severity};

/// More findings than this are counted, not shown: the first ones usually cause
/// the rest.
const SHOWN: usize = 40;

/// The width of a tabulator.
const TAB: usize = 4;

/// A label on its line: columns of the underline, sign, text.
struct Mark<'a> {
    line: u32,
    from: usize,
    to: usize,
    sign: char,
    text: &'a str,
}

/// Renders findings in the order given.
pub fn render(diagnostics: &[&Diagnostic], file: &str, source: &str) -> String {
    let lines: Vec<&str> = source
        .split('\n')
        .map(|line| line.trim_end_matches('\r'))
        .collect();
    let shown = diagnostics.iter().take(SHOWN);
    let blocks: Vec<String> = shown
        .map(|diagnostic| block(diagnostic, file, &lines))
        .collect();
    let mut text = blocks.join("\n");
    if diagnostics.len() > SHOWN {
        text.push_str(&format!("\n… and {} more\n", diagnostics.len() - SHOWN));
    }
    text
}

fn block(diagnostic: &Diagnostic, file: &str, lines: &[&str]) -> String {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let place = diagnostic.primary.span;
    let mut text = format!("{file}:{place}: {severity}: {}\n", diagnostic.message);
    let mut marks = vec![mark(&diagnostic.primary, '^', lines)];
    marks.extend(
        diagnostic
            .secondary
            .iter()
            .map(|label| mark(label, '-', lines)),
    );
    marks.sort_by_key(|mark| (mark.line, mark.from));
    let last = marks.last().map_or(1, |mark| mark.line);
    let margin = " ".repeat(last.to_string().len());
    text.push_str(&format!("{margin} |\n"));
    text.push_str(&snippet(&marks, &margin, lines));
    if let Some(help) = &diagnostic.help {
        text.push_str(&format!("{margin} = help: {help}\n"));
    }
    text.lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

/// The marked lines with their underlines.
fn snippet(marks: &[Mark], margin: &str, lines: &[&str]) -> String {
    let mut text = String::new();
    let mut before = None;
    for group in marks.chunk_by(|a, b| a.line == b.line) {
        let line = group[0].line;
        if before.is_some_and(|before| line > before + 1) {
            text.push_str("...\n");
        }
        before = Some(line);
        let source = untabbed(lines.get(line as usize - 1).unwrap_or(&""));
        text.push_str(&format!(
            "{line:>width$} | {source}\n",
            width = margin.len()
        ));
        for row in underlines(group) {
            text.push_str(&format!("{margin} | {row}\n"));
        }
    }
    text
}

/// Where a label is drawn: on its first line, one character at least.
fn mark<'a>(label: &'a Label, sign: char, lines: &[&str]) -> Mark<'a> {
    let (start, end) = (label.span.start, label.span.end);
    let line = lines
        .get((start.line as usize).saturating_sub(1))
        .unwrap_or(&"");
    let column = |column: u32| width(line, (column as usize).saturating_sub(1));
    let from = column(start.column);
    let to = if end.line == start.line {
        column(end.column)
    } else {
        width(line, usize::MAX)
    };
    Mark {
        line: start.line.max(1),
        from,
        to: to.max(from + 1),
        sign,
        text: &label.text,
    }
}

/// The width of the first characters of a line.
fn width(line: &str, characters: usize) -> usize {
    line.chars()
        .take(characters)
        .map(|c| if c == '\t' { TAB } else { 1 })
        .sum()
}

fn untabbed(line: &str) -> String {
    line.replace('\t', &" ".repeat(TAB))
}

/// The rows below a source line: the underlines with the text of the last, then
/// the other texts from right to left, hung on lines.
fn underlines(marks: &[Mark]) -> Vec<String> {
    let mut row: Vec<char> = Vec::new();
    for mark in marks {
        row.resize(row.len().max(mark.to), ' ');
        row[mark.from..mark.to].fill(mark.sign);
    }
    // The place itself stays visible where another label lies over it.
    for mark in marks.iter().filter(|mark| mark.sign == '^') {
        row[mark.from..mark.to].fill('^');
    }
    let mut rows: Vec<String> = vec![row.into_iter().collect()];
    let mut hanging: Vec<&Mark> = marks.iter().filter(|mark| !mark.text.is_empty()).collect();
    let clear = |mark: &Mark| marks.iter().all(|other| other.to <= mark.to);
    if let Some(mark) = hanging.pop_if(|mark| clear(mark)) {
        rows[0].push_str(&format!(" {}", mark.text));
    }
    while let Some(mark) = hanging.pop() {
        let mut row = hooks(&hanging, mark.from);
        rows.push(format!("{row}|"));
        row.push_str(mark.text);
        rows.push(row);
    }
    rows
}

/// Vertical lines at the labels that still have to be written, up to a column.
fn hooks(marks: &[&Mark], column: usize) -> String {
    let mut row = vec![' '; column];
    for mark in marks {
        if let Some(place) = row.get_mut(mark.from) {
            *place = '|';
        }
    }
    row.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Diagnostic, Position, Span};
    use super::*;

    fn span(line: u32, from: u32, to: u32) -> Span {
        let at = |column| Position {
            line,
            column,
            offset: 0,
        };
        Span {
            start: at(from),
            end: at(to),
        }
    }

    #[test]
    fn labels_on_one_line_hang_below_it_from_right_to_left() {
        let error = Diagnostic::error(span(1, 6, 7), "no")
            .labelled("right")
            .also(span(1, 1, 4), "left");
        let expected = "f:1:6: error: no\n  |\n1 | abc + d\n  | ---  ^ right\n  | |\n  | left\n";
        assert_eq!(render(&[&error], "f", "abc + d"), expected);
    }

    #[test]
    fn a_place_behind_the_end_of_the_file_is_shown() {
        let error = Diagnostic::error(span(9, 1, 1), "no").help("yes");
        assert_eq!(
            render(&[&error], "f", "a"),
            "f:9:1: error: no\n  |\n9 |\n  | ^\n  = help: yes\n"
        );
    }
}
