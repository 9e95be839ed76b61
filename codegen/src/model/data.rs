//! Files of numbers beside a description.
//!
//! In:  the text of a file: rows of numbers, parted by commas, semicolons or blanks; above
//!      them, if there is one, a row of names. Empty lines and what follows `#` are left out.
//! Out: pairs of two columns, or what is wrong, with line and column.

use super::messages::not_rising;
use crate::diagnostic::{Position, nearest};
use crate::read::{NotUtf8, read_text};
use crate::syntax::messages::{NUMBERS, did_you_mean};
use std::io::ErrorKind;
use std::path::Path;

/// The most pairs of a table, all of which the compiler of the code has to read.
const MOST: usize = 100_000;

/// What is wrong with a file, behind its name.
pub struct Fault {
    pub message: String,
    pub help: String,
}

fn fault<T>(message: String, help: &str) -> Result<T, Fault> {
    let help = help.to_string();
    Err(Fault { message, help })
}

/// The text of a file.
pub fn read(path: &Path) -> Result<String, Fault> {
    const PLACE: &str = "files are looked for in the folder of the description";
    read_text(path).map_err(|error| {
        let utf8 = error.get_ref().and_then(|fault| fault.downcast_ref());
        let (said, help) = match (utf8, error.kind()) {
            (Some(NotUtf8 { place }), _) => {
                let Position { line, column, .. } = place;
                let said = format!("line {line} is not UTF-8 at column {column}");
                (said, NotUtf8::HELP)
            }
            (None, ErrorKind::NotFound) => ("there is no such file".to_string(), PLACE),
            _ => (error.to_string(), PLACE),
        };
        Fault {
            message: format!(" can't be read: {said}"),
            help: help.to_string(),
        }
    })
}

/// Pairs of the columns of some names: the first two columns, the first one and one that is
/// named, or two that are named.
pub fn pairs(text: &str, names: &[&str]) -> Result<Vec<[f64; 2]>, Fault> {
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let lines = lines.map(|(i, line)| (i + 1, line.split('#').next().unwrap_or("").trim()));
    let mut rows = lines.filter(|(_, line)| !line.is_empty()).peekable();
    let Some((_, first)) = rows.peek().copied() else {
        return fault(" is empty".to_string(), ROWS);
    };
    let sign = [',', ';', '\t']
        .into_iter()
        .find(|sign| first.contains(*sign));
    let header: Option<Vec<&str>> = match fields(first, sign).iter().all(|x| number(x).is_some()) {
        true => None,
        false => rows.next().map(|(_, line)| fields(line, sign)),
    };
    let [x, y] = columns(header.as_deref(), names)?;
    let mut pairs: Vec<[f64; 2]> = Vec::new();
    for (line, row) in rows {
        let row = fields(row, sign);
        let pair = [entry(&row, line, x)?, entry(&row, line, y)?];
        if let Some(before) = pairs.last().filter(|before| before[0] >= pair[0]) {
            let (before, here) = (before[0], pair[0]);
            let message = format!(", line {line}: {}", not_rising(before, here));
            return fault(message, "put the rows in rising order, each place once");
        }
        pairs.push(pair);
    }
    match pairs.len() {
        0 | 1 => fault(" has fewer than two rows of numbers".to_string(), ROWS),
        n if n > MOST => {
            let message = format!(" has {n} rows, and there is room for {MOST}");
            fault(
                message,
                "leave out rows between which the function is nearly straight",
            )
        }
        _ => Ok(pairs),
    }
}

const ROWS: &str = "write a row for each point, `0.5, 20`, if you like below a row of names";

fn fields(line: &str, sign: Option<char>) -> Vec<&str> {
    fn bare(field: &str) -> &str {
        field.trim().trim_matches('"')
    }
    match sign {
        Some(sign) => line.split(sign).map(bare).collect(),
        None => line.split_whitespace().map(bare).collect(),
    }
}

fn number(field: &str) -> Option<f64> {
    field.parse().ok().filter(|x: &f64| x.is_finite())
}

/// The places of the two columns that are meant.
fn columns(header: Option<&[&str]>, names: &[&str]) -> Result<[usize; 2], Fault> {
    let place = |name: &str| {
        let Some(header) = header else {
            let message = format!(" has no row of names, in which `{name}` could be");
            return fault(message, "without names the first two columns are taken");
        };
        let mut found = (1..).zip(header).filter(|(_, known)| **known == name);
        match (found.next(), found.next()) {
            (Some((column, _)), None) => Ok(column - 1),
            (Some((one, _)), Some((other, _))) => Err(Fault {
                message: format!(" has `{name}` in its columns {one} and {other}"),
                help: "give each column a name of its own".to_string(),
            }),
            (None, _) => Err(Fault {
                message: format!(" has no column `{name}`"),
                help: match nearest(name, header.iter().copied()) {
                    Some(near) => did_you_mean(near),
                    None => format!("its columns are {}", header.join(", ")),
                },
            }),
        }
    };
    match names {
        [] => Ok([0, 1]),
        [value] => Ok([0, place(value)?]),
        [at, value, ..] => Ok([place(at)?, place(value)?]),
    }
}

fn entry(row: &[&str], line: usize, column: usize) -> Result<f64, Fault> {
    let Some(field) = row.get(column) else {
        let message = format!(", line {line}, has no column {}", column + 1);
        return fault(message, ROWS);
    };
    number(field).map_or_else(
        || {
            let message = format!(
                ", line {line}, column {}: `{field}` is not a number",
                column + 1
            );
            fault(message, NUMBERS)
        },
        Ok,
    )
}
