//! Draws the kinds of singular configurations for the theory chapter.
//!
//! In:  a folder, `docs/figures` if none is given.
//! Out: a picture of each kind: a mechanism, its constraint set near the singular
//!      configuration, and the size of the constraint gradient along the motion.

mod curve;
mod drawing;
mod four_bar;
mod kinds;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    let folder = folder.unwrap_or_else(|| PathBuf::from("docs/figures"));
    for (name, picture) in kinds::all() {
        let path = folder.join(name);
        std::fs::write(&path, drawing::draw(&picture)?)?;
        println!("{}", path.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figures_of_the_theory_chapter_are_what_this_program_draws() {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/figures");
        for (name, picture) in kinds::all() {
            let path = folder.join(name);
            let drawn = drawing::draw(&picture).expect("it can be drawn");
            if std::env::var_os("BRICARD_BLESS").is_some() {
                std::fs::write(&path, &drawn).expect("the folder is there");
            }
            let kept = std::fs::read_to_string(&path).unwrap_or_default();
            assert!(
                kept == drawn,
                "{} is not what `cargo run -p kinds` draws; write it with BRICARD_BLESS=1",
                path.display()
            );
        }
    }
}
