//! `bricard list`: the mechanisms of the library and of the benchmark problems.

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

/// The first sentence, on one line.
pub fn first_sentence(docs: &str) -> String {
    let lines = docs
        .lines()
        .map(str::trim)
        .skip_while(|line| line.is_empty());
    let paragraph: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    let paragraph = paragraph.join(" ");
    match paragraph.split_once(". ") {
        Some((first, _)) => format!("{first}."),
        None => paragraph,
    }
}

#[cfg(test)]
mod tests {
    use super::first_sentence;

    #[test]
    fn the_first_sentence_ends_at_its_full_stop() {
        assert_eq!(
            first_sentence("\n a linkage\n of bars. It moves.\n\nMore."),
            "a linkage of bars."
        );
        assert_eq!(first_sentence("a linkage"), "a linkage");
        assert_eq!(first_sentence(""), "");
    }
}
