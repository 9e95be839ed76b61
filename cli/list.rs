//! `bricard list`: the mechanisms of the library.

use crate::error::CommandError;
use crate::mechanism::find;
use crate::output::print;
use crate::table::{Align, headed};

/// Prints name, sizes and first doc line of each mechanism.
pub fn list() -> Result<(), CommandError> {
    let row = |name: &&str| {
        let structure = find(name)?.structure();
        Ok(vec![
            name.to_string(),
            structure.coordinates.len().to_string(),
            structure.constraints.len().to_string(),
            first_line(structure.docs).to_string(),
        ])
    };
    let rows: Vec<_> = bricard::NAMES
        .iter()
        .map(row)
        .collect::<Result<_, CommandError>>()?;
    let heading = ["name", "coordinates", "constraint rows", "what it is"];
    let align = [Align::Left, Align::Right, Align::Right, Align::Left];
    print(&headed(&heading, &rows, &align))
}

/// The first line that says something.
pub fn first_line(docs: &str) -> &str {
    docs.lines()
        .map(str::trim)
        .find(|line| !line.is_empty())
        .unwrap_or("")
}
