//! What a picture is drawn on: a screen, or the column of a journal.

use super::style::{DETAIL, HEADING, letters};
use crate::error::CommandError;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

/// What drawing on the SVG backend can come to.
pub type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;
/// A part of a picture.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A place in pixels of the picture as it is shown.
pub fn px(x: u32, y: u32) -> (i32, i32) {
    let scaled = |v: u32| i32::try_from(v * DETAIL).unwrap_or(i32::MAX);
    (scaled(x), scaled(y))
}

/// Letters are 15 pixels high, and 8 points (2.82 mm) in print.
const PER_MILLIMETRE: f64 = 15.0 / 2.82;
/// What is narrower has its legend above the curves instead of beside them (pixels).
const NARROW: u32 = 700;
/// Height of a title (pixels).
const TITLE: u32 = 36;

/// Where a picture goes, and how wide it is.
#[derive(Clone, Copy, Debug)]
pub struct Sheet<'a> {
    /// The file, for messages.
    pub path: &'a Path,
    /// What stands above the picture, unless it is for print, where captions stand below.
    pub title: &'a str,
    /// The width in print (mm).
    pub width: Option<f64>,
}

impl<'a> Sheet<'a> {
    /// A picture for the screen.
    pub fn screen(path: &'a Path, title: &'a str) -> Self {
        Self {
            path,
            title,
            width: None,
        }
    }

    /// The width in pixels of the drawing, if it is given.
    pub fn pixels(&self) -> Option<u32> {
        self.width.map(|width| (width * PER_MILLIMETRE) as u32)
    }

    /// Whether there is no room beside the curves.
    pub fn is_narrow(&self) -> bool {
        self.pixels().is_some_and(|pixels| pixels < NARROW)
    }

    /// The height of the title (pixels).
    pub fn head(&self) -> u32 {
        match self.width {
            Some(_) => 0,
            None => TITLE,
        }
    }

    /// Draws the title, if there is one, at a distance from the left (pixels).
    ///
    /// # Errors
    ///
    /// As drawing has them.
    pub fn heading(&self, area: &Area, left: u32) -> Drawn {
        match self.width {
            Some(_) => Ok(()),
            None => {
                let title = self.title.to_string();
                area.draw(&Text::new(title, px(left, 10), letters(HEADING)))
            }
        }
    }

    /// Draws a picture of a size (pixels) to the text of an SVG file.
    ///
    /// # Errors
    ///
    /// [`CommandError::Draw`].
    pub fn draw(
        &self,
        (width, height): (u32, u32),
        draw: impl FnOnce(&Area) -> Drawn,
    ) -> Result<String, CommandError> {
        let (across, up) = (width * DETAIL, height * DETAIL);
        let mut text = String::new();
        let root = SVGBackend::with_string(&mut text, (across, up)).into_drawing_area();
        let drawn = root
            .fill(&WHITE)
            .and_then(|()| draw(&root))
            .and_then(|()| root.present());
        drop(root);
        drawn.map_err(|error| CommandError::Draw(self.path.to_path_buf(), error.to_string()))?;
        let shown = match self.width {
            Some(printed) => {
                let height = printed * f64::from(height) / f64::from(width);
                format!("width=\"{printed}mm\" height=\"{height:.3}mm\"")
            }
            None => format!("width=\"{width}\" height=\"{height}\""),
        };
        let drawn = format!("width=\"{across}\" height=\"{up}\"");
        Ok(text.replacen(&drawn, &shown, 1))
    }
}
