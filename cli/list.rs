//! `bricard list`: the mechanisms of the library and of the benchmark problems.

use crate::captions::first_sentence;
use crate::error::CommandError;
use crate::mechanism::find;
use crate::output::print;
use crate::table::{Align, headed};

/// Prints name, sizes and the first sentence about each mechanism; those of the
/// benchmark problems in a table of their own.
pub fn list() -> Result<(), CommandError> {
    print(&table(bricard::NAMES)?)?;
    print("\nbenchmark problems\n\n")?;
    print(&table(bricard_benchmarks::NAMES)?)
}

fn table(names: &[&str]) -> Result<String, CommandError> {
    let row = |name: &&str| {
        let structure = find(name)?.structure();
        Ok(vec![
            name.to_string(),
            structure.freedoms().len().to_string(),
            structure.constraints.len().to_string(),
            first_sentence(structure.docs),
        ])
    };
    let rows = names.iter().map(row);
    let rows: Vec<_> = rows.collect::<Result<_, CommandError>>()?;
    let heading = ["name", "coordinates", "constraint rows", "what it is"];
    let align = [Align::Left, Align::Right, Align::Right, Align::Left];
    Ok(headed(&heading, &rows, &align))
}
