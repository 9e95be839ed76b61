//! Drawings to files of any kind: SVG as it is, PNG by pixels, PDF with its text.
//!
//! In:  the text of an SVG.
//! Out: a file, or pixels.
//!
//! Letters are those of DejaVu Sans, which the command carries along, so that a picture is
//! the same on every machine.

use crate::error::CommandError;
use crate::output::replace;
use resvg::tiny_skia::{Pixmap, Transform};
use std::path::Path;
use std::sync::{Arc, OnceLock};
use svg2pdf::usvg::{Options, Tree, fontdb::Database};
use svg2pdf::{ConversionOptions, PageOptions};

/// Pixels of a PNG for each of the drawing: enough for print in the column of a journal.
const SHARP: f32 = 3.0;
/// What the letters are called.
const FAMILY: &str = "DejaVu Sans";

/// Writes a drawing to a file of the kind that its name ends in, whole or not at all.
///
/// # Errors
///
/// [`CommandError::Write`], [`CommandError::Draw`].
pub fn write(path: &Path, svg: &str) -> Result<(), CommandError> {
    let failed = |reason: String| CommandError::Draw(path.to_path_buf(), reason);
    let kind = path.extension().map(|kind| kind.to_ascii_lowercase());
    match kind.as_deref().and_then(|kind| kind.to_str()) {
        Some("png") => {
            let pixels = pixels(svg, SHARP).map_err(failed)?;
            let bytes = pixels.encode_png().map_err(|e| failed(e.to_string()))?;
            replace(path, &bytes)
        }
        Some("pdf") => {
            let tree = tree(svg).map_err(failed)?;
            let pdf = svg2pdf::to_pdf(&tree, ConversionOptions::default(), PageOptions::default());
            replace(path, &pdf.map_err(|error| failed(error.to_string()))?)
        }
        _ => replace(path, svg.as_bytes()),
    }
}

/// The pixels of a drawing, so many for each of its own in both directions.
///
/// # Errors
///
/// Why there are none, in words.
pub fn pixels(svg: &str, detail: f32) -> Result<Pixmap, String> {
    let tree = tree(svg)?;
    let size = tree.size().to_int_size();
    let side = |length: u32| (length as f32 * detail).round() as u32;
    let mut pixels = Pixmap::new(side(size.width()), side(size.height()))
        .ok_or("a picture of this size has no room in memory")?;
    let scale = Transform::from_scale(detail, detail);
    resvg::render(&tree, scale, &mut pixels.as_mut());
    Ok(pixels)
}

fn tree(svg: &str) -> Result<Tree, String> {
    static LETTERS: OnceLock<Arc<Database>> = OnceLock::new();
    let letters = LETTERS.get_or_init(|| {
        let mut all = Database::new();
        all.load_font_data(dejavu::sans::regular().to_vec());
        all.set_sans_serif_family(FAMILY);
        Arc::new(all)
    });
    let options = Options {
        fontdb: Arc::clone(letters),
        font_family: FAMILY.to_string(),
        ..Options::default()
    };
    Tree::from_str(svg, &options).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::pixels;

    #[test]
    fn letters_are_drawn_without_fonts_of_the_system() {
        let ink = |text: &str| {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="80" height="30"><text x="5" y="20" font-family="sans-serif" font-size="14">{text}</text></svg>"#
            );
            let pixels = pixels(&svg, 1.0).expect("it is a drawing");
            pixels.pixels().iter().filter(|p| p.alpha() > 0).count()
        };
        assert_eq!(ink(""), 0);
        assert!(ink("q₁ [rad]") > 50);
    }
}
