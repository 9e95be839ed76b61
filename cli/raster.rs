//! Drawings to files of any kind: SVG as it is, PNG by pixels, PDF with its text.
//!
//! In:  the text of an SVG.
//! Out: a file, or pixels.
//!
//! Letters are those of DejaVu Sans, which the command carries along, so that a picture is
//! the same on every machine. PDF and PNG have them in the file; so does an SVG for print,
//! where they are outlines.

use crate::error::CommandError;
use crate::output::replace;
use resvg::tiny_skia::{Pixmap, Transform};
use std::path::Path;
use std::sync::{Arc, OnceLock};
use svg2pdf::usvg::{Options, Tree, WriteOptions, fontdb::Database};
use svg2pdf::{ConversionOptions, PageOptions};

/// Pixels of a PNG for each of the drawing: enough for print in the column of a journal.
const SHARP: f32 = 3.0;
/// Pixels of a PNG for print for each of the drawing, whose pixels are 1/96 inch: 600 dots per
/// inch.
const PRINTED: f32 = 6.25;
/// Pixels of the drawing in an inch.
const PER_INCH: f32 = 96.0;
/// What the letters are called.
const FAMILY: &str = "DejaVu Sans";

/// Writes a drawing to a file of the kind that its name ends in, whole or not at all. One for
/// print has its size in millimetres.
///
/// # Errors
///
/// [`CommandError::Write`], [`CommandError::Draw`].
pub fn write(path: &Path, svg: &str, print: bool) -> Result<(), CommandError> {
    let failed = |reason: String| CommandError::Draw(path.to_path_buf(), reason);
    let kind = path.extension().map(|kind| kind.to_ascii_lowercase());
    match kind.as_deref().and_then(|kind| kind.to_str()) {
        Some("png") => {
            let pixels = pixels(svg, if print { PRINTED } else { SHARP }).map_err(failed)?;
            let bytes = pixels.encode_png().map_err(|e| failed(e.to_string()))?;
            replace(path, &bytes)
        }
        Some("pdf") => {
            let tree = tree(svg).map_err(failed)?;
            let page = match print {
                true => PageOptions { dpi: PER_INCH },
                false => PageOptions::default(),
            };
            let pdf = svg2pdf::to_pdf(&tree, ConversionOptions::default(), page);
            replace(path, &pdf.map_err(|error| failed(error.to_string()))?)
        }
        _ if print => {
            let tree = tree(svg).map_err(failed)?;
            replace(path, outlined(&tree).as_bytes())
        }
        _ => replace(path, svg.as_bytes()),
    }
}

/// A drawing whose letters are outlines, with its size in millimetres.
fn outlined(tree: &Tree) -> String {
    let text = tree.to_string(&WriteOptions::default());
    let body = text.split_once('>').map_or("", |(_, body)| body);
    let (width, height) = (tree.size().width(), tree.size().height());
    let printed = |pixels: f32| pixels / PER_INCH * 25.4;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.2}mm\" height=\"{:.2}mm\" \
         viewBox=\"0 0 {width} {height}\">{body}",
        printed(width),
        printed(height),
    )
}

/// The pixels of a drawing, so many for each of its own in both directions.
///
/// # Errors
///
/// In words, why the picture can't be drawn.
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
    use super::{outlined, pixels, tree};

    #[test]
    fn a_drawing_for_print_has_outlines_and_its_width() {
        let svg = r#"<svg width="88mm" height="44mm" viewBox="0 0 500 250" xmlns="http://www.w3.org/2000/svg"><text x="5" y="20" font-size="14">q</text></svg>"#;
        let tree = tree(svg).expect("it is a drawing");
        let outlined = outlined(&tree);
        assert!(
            outlined.contains(r#"width="88.00mm" height="44.00mm""#),
            "{outlined}"
        );
        assert!(
            outlined.contains("<path") && !outlined.contains("<text"),
            "{outlined}"
        );
        let again = super::tree(&outlined).expect("it is one again");
        assert_eq!(again.size(), tree.size());
    }

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
