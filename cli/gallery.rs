//! `bricard gallery DIR`: pictures of all mechanisms of the library, and a page for each.
//!
//! In:  the library.
//! Out: `DIR/NAME.svg` and `DIR/NAME.md` for each mechanism, `DIR.md` with all pictures.
//!
//! The command is not in the help: it writes the gallery of the documentation.

use crate::arguments::Gallery;
use crate::captions::{counted, first_sentence};
use crate::error::CommandError;
use crate::mechanism::find;
use crate::output::{say, write};
use crate::plot::{Shape, moving_svg};
use crate::run::{Plan, run};
use crate::scene::{is_spatial, shapes};
use bricard_driver::AnyMechanism;
use bricard_runtime::{Options, Structure};
use std::fs;

/// What a picture shows (s), in so many poses.
const SECONDS: f64 = 6.0;
const POSES: usize = 180;
/// Relative and absolute tolerance.
const TOLERANCE: f64 = 1e-9;
/// Pictures side by side.
const COLUMNS: usize = 3;

/// Writes the gallery.
///
/// # Errors
///
/// [`CommandError::Write`]; a run that fails.
pub fn gallery(arguments: &Gallery) -> Result<(), CommandError> {
    let folder = &arguments.folder;
    fs::create_dir_all(folder).map_err(|error| CommandError::write(folder, error))?;
    let called = folder.file_name().unwrap_or_default().to_string_lossy();
    let mut index = Vec::new();
    for name in bricard::NAMES {
        let mechanism = find(name)?;
        let picture = picture(name, mechanism.as_ref())?;
        write(&folder.join(format!("{name}.svg")), &picture)?;
        let structure = mechanism.structure();
        write(&folder.join(format!("{name}.md")), &page(name, structure))?;
        index.push(entry(&called, name, structure));
        say(&format!("{name}: {} kB", picture.len() / 1000));
    }
    write(&folder.with_extension("md"), &contents(&index))
}

/// The mechanism moving from its start.
fn picture(name: &str, mechanism: &dyn AnyMechanism) -> Result<String, CommandError> {
    let options = Options::dop853(SECONDS, TOLERANCE);
    let plan = Plan::new(options, Some(SECONDS / POSES as f64), Vec::new());
    let mut rows = Vec::new();
    run(mechanism, &plan, &mut rows).map_err(|stopped| stopped.error)?;
    let scene = mechanism.scene(&rows);
    let scene = scene.map_err(|reason| CommandError::Draw(name.into(), reason))?;
    let spatial = is_spatial(&scene);
    let frames = scene.frames.iter();
    let frames: Vec<Vec<Shape>> = frames.map(|frame| shapes(&scene, frame, spatial)).collect();
    Ok(moving_svg(name, &frames, SECONDS))
}

/// The page of a mechanism.
fn page(name: &str, structure: &Structure) -> String {
    let lines: Vec<&str> = structure.docs.lines().map(str::trim).collect();
    let (title, docs) = (structure.name, lines.join("\n"));
    let coordinates = counted(structure.freedoms().len(), "coordinate");
    let equations = counted(structure.constraints.len(), "constraint equation");
    format!(
        "# {title}\n\n{}\n\n![{name}, moving for six seconds from its start]({name}.svg)\n\n\
         {coordinates}, {equations}: [the description](../../mechanisms/{name}.mech).\n\n\
         ```sh\nbricard simulate {name} --plot {name}.html\nbricard show {name}\n```\n\n\
         The first command makes a page on which it moves, the second prints its equations of \
         motion.\nAll mechanisms: [gallery](../gallery.md).\n",
        docs.trim()
    )
}

/// The place of a mechanism on the page with all pictures.
fn entry(folder: &str, name: &str, structure: &Structure) -> [String; 2] {
    let picture = format!("[![{name}]({folder}/{name}.svg)]({folder}/{name}.md)");
    let docs = first_sentence(structure.docs);
    [picture, format!("[`{name}`]({folder}/{name}.md): {docs}")]
}

/// The page with all pictures.
fn contents(entries: &[[String; 2]]) -> String {
    let mut text = "# Gallery\n\n\
        The mechanisms of the library, each moving for six seconds from its start.\n\
        `bricard gallery docs/gallery` draws them from the `draw` statements of their \
        descriptions.\n\n"
        .to_string();
    text += &format!(
        "{}\n{}\n",
        "| ".repeat(COLUMNS) + "|",
        "|---".repeat(COLUMNS) + "|"
    );
    for row in entries.chunks(COLUMNS) {
        for cells in [0, 1] {
            let cells = row.iter().map(|entry| format!("| {} ", entry[cells]));
            text += &format!("{}|\n", cells.collect::<String>());
        }
    }
    text
}
