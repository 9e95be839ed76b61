//! Drawings to the text of SVG files.

use super::style::DETAIL;
use crate::error::CommandError;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

/// What drawing on the SVG backend can come to.
pub type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
/// A part of a picture.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws a picture of a size (pixels); `path` is where it will go, for messages.
///
/// # Errors
///
/// [`CommandError::Draw`].
pub fn text(
    path: &Path,
    (width, height): (u32, u32),
    draw: impl FnOnce(&Area) -> Drawn,
) -> Result<String, CommandError> {
    let mut text = String::new();
    let drawn = {
        let root = SVGBackend::with_string(&mut text, (width * DETAIL, height * DETAIL))
            .into_drawing_area();
        root.fill(&WHITE)
            .and_then(|()| draw(&root))
            .and_then(|()| root.present())
    };
    drawn.map_err(|error| CommandError::Draw(path.to_path_buf(), error.to_string()))?;
    let drawn_size = format!(
        "width=\"{}\" height=\"{}\"",
        width * DETAIL,
        height * DETAIL
    );
    let shown_size = format!("width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(&drawn_size, &shown_size, 1))
}
