//! Aligned text.
//!
//! In:  rows of cells.
//! Out: lines whose columns stand below one another.

/// How the cells of a column are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// At the left: words.
    Left,
    /// At the right: numbers.
    Right,
}

/// Rows with two blanks between the columns, and none at the end of a line.
/// Missing cells are empty.
pub fn aligned(rows: &[Vec<String>], align: &[Align]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..align.len()).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for ((cell, align), width) in row.iter().zip(align).zip(&widths) {
            let blanks = " ".repeat(width.saturating_sub(cell.chars().count()));
            match align {
                Align::Left => line.extend([cell, blanks.as_str(), "  "]),
                Align::Right => line.extend([blanks.as_str(), cell, "  "]),
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// A table with a heading and a rule below it.
pub fn headed(heading: &[&str], rows: &[Vec<String>], align: &[Align]) -> String {
    let mut all = vec![heading.iter().map(|cell| cell.to_string()).collect()];
    all.extend_from_slice(rows);
    let text = aligned(&all, align);
    let width = text
        .lines()
        .map(|line| line.chars().count())
        .max()
        .unwrap_or(0);
    match text.split_once('\n') {
        Some((first, rest)) => format!("{first}\n{}\n{rest}", "─".repeat(width)),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::{Align, aligned};

    #[test]
    fn columns_stand_below_one_another() {
        let rows = [["a", "10"], ["bcd", "9"]].map(|row| row.map(String::from).to_vec());
        assert_eq!(
            aligned(&rows, &[Align::Left, Align::Right]),
            "a    10\nbcd   9\n"
        );
    }
}
