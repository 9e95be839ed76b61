//! A run as one page: the mechanism moving, its curves, its description.
//!
//! In:  a mechanism, rows, what is known of the run.
//! Out: the text of an HTML file that needs nothing else, no network either.
//!
//! Not here: how it looks and what it does when it is open (`assets/`). All that a
//! description says reaches the page as one JSON text, which its script takes apart: no
//! name and no comment ever becomes markup.

mod data;
mod equations;
mod live;
mod sliders;
mod template;
mod thin;

pub use data::Run;
pub use live::Live;
pub use sliders::Sliders;

use crate::column::{Column, header};
use crate::error::CommandError;
use crate::files::is_of;
use crate::output::replace;
use bricard_driver::WORDS;
use bricard_runtime::Structure;
use std::path::Path;
use template::page;

/// Whether a file of this name is a page.
pub fn is_page(path: &Path) -> bool {
    is_of(path, &["html"])
}

/// The columns that a page shows: those that are wanted, and what every run has that costs
/// little to tell, but for what is called like another curve.
pub fn columns(wanted: &[Column], structure: &Structure) -> Vec<Column> {
    let mut all = wanted.to_vec();
    let of_all = |column: &Column| match column {
        Column::Energy | Column::Kinetic | Column::Potential => true,
        Column::ConstraintError => !structure.constraints.is_empty(),
        _ => false,
    };
    let outputs = (0..structure.outputs.len()).map(Column::Output);
    let words = WORDS.iter().map(|(_, column)| *column).filter(of_all);
    let mut names = header(structure, wanted);
    for column in outputs.chain(words) {
        let name = column.name(structure);
        if !names.contains(&name) {
            all.push(column);
            names.push(name);
        }
    }
    all
}

/// Writes the page of a run, whole or not at all.
///
/// # Errors
///
/// [`CommandError::Write`]; [`CommandError::Draw`] if the mechanism does not answer.
pub fn write(path: &Path, run: &Run) -> Result<(), CommandError> {
    let failed = |reason| CommandError::Draw(path.to_path_buf(), reason);
    let data = data::data(run).map_err(failed)?;
    replace(path, page(run.mechanism.structure().name, &data).as_bytes())?;
    run.live.map_or(Ok(()), Live::renew)
}
