//! Sections of pages that tests write: what was found, as rows of tables.
//!
//! In:  a page, the heading of a section, the text that belongs below it.
//! Out: with `BRICARD_BLESS=1` the page with that text, else a complaint if it differs.

use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Tests of one program write sections of the same page, each a part of what it read.
static WRITING: Mutex<()> = Mutex::new(());

/// Holds a section of a page, from its heading to the next of the same rank, against a
/// text, or writes it there with `BRICARD_BLESS=1`.
///
/// # Panics
///
/// If the page lacks the section, or has another one.
pub fn hold_section(page: &Path, heading: &str, found: &str) {
    let _alone = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let name = page.display();
    let text = fs::read_to_string(page).unwrap_or_else(|error| panic!("{name}: {error}"));
    let begin = format!("## {heading}\n");
    let (before, rest) = text
        .split_once(&begin)
        .unwrap_or_else(|| panic!("{name} has no section `{heading}`"));
    let end = rest.find("\n## ").map_or(rest.len(), |end| end + 1);
    let (written, after) = rest.split_at(end);
    let gap = if after.is_empty() { "" } else { "\n" };
    let found = format!("\n{}\n{gap}", found.trim());
    if std::env::var_os("BRICARD_BLESS").is_some() {
        let blessed = format!("{before}{begin}{found}{after}");
        fs::write(page, blessed).unwrap_or_else(|error| panic!("{name}: {error}"));
        return;
    }
    let lines = |text: &str| -> Vec<String> { text.lines().map(String::from).collect() };
    let (written, found) = (lines(written), lines(&found));
    let lacks = |all: &[String], line: &&String| !all.contains(line);
    let new: Vec<_> = found.iter().filter(|line| lacks(&written, line)).collect();
    let old: Vec<_> = written.iter().filter(|line| lacks(&found, line)).collect();
    assert!(
        written == found,
        "`{heading}` in {name} lacks {new:#?}\nand should not have {old:#?}\n\
         BRICARD_BLESS=1 rewrites it"
    );
}

/// A row of a table.
pub fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// A text as code in a cell of a table. The end of a line is `⏎`, and what can't be seen is
/// its number.
pub fn code(text: &str) -> String {
    let text: String = text.chars().map(visible).collect();
    let fence = "`".repeat(usize::from(text.contains('`')) + 1);
    let gap = if text.contains('`') { " " } else { "" };
    format!("{fence}{gap}{}{gap}{fence}", text.replace('|', "\\|"))
}

fn visible(sign: char) -> String {
    if sign == '\n' {
        return " ⏎ ".to_string();
    }
    let is_plain = sign == ' ' || !sign.is_whitespace() && !sign.is_control();
    match is_plain && sign != '\u{200b}' {
        true => sign.to_string(),
        false => format!("⟨U+{:04X}⟩", u32::from(sign)),
    }
}

/// A message in a cell of a table: what it has between backticks is code, and no other
/// sign of it has a meaning to Markdown.
pub fn prose(text: &str) -> String {
    let mut prose = String::new();
    for (place, part) in text.split('`').enumerate() {
        if place % 2 == 1 {
            prose += &code(part);
            continue;
        }
        for sign in part.chars() {
            if "|*_<>[]\\~".contains(sign) {
                prose.push('\\');
            }
            prose += &visible(sign);
        }
    }
    prose
}

#[cfg(test)]
mod tests {
    use super::{code, prose};

    #[test]
    fn cells_end_where_they_end() {
        assert_eq!(code("q || w"), "`q \\|\\| w`");
        assert_eq!(code("a\rb"), "`a⟨U+000D⟩b`");
        assert_eq!(code("a ` b"), "`` a ` b ``");
        assert_eq!(prose("`a*b` has <2> | 3"), "`a*b` has \\<2\\> \\| 3");
    }
}
