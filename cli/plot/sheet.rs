//! What a picture is drawn on: a screen, or the column of a journal.

use super::svg::{self, Area, Drawn};
use crate::error::CommandError;
use std::path::Path;

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

    /// Draws a picture of a size (pixels).
    ///
    /// # Errors
    ///
    /// As [`svg::text`].
    pub fn draw(
        &self,
        size: (u32, u32),
        draw: impl FnOnce(&Area) -> Drawn,
    ) -> Result<String, CommandError> {
        let text = svg::text(self.path, size, draw)?;
        Ok(match self.width {
            Some(width) => {
                let height = width * f64::from(size.1) / f64::from(size.0);
                let shown = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
                let printed = format!("width=\"{width}mm\" height=\"{height:.3}mm\"");
                text.replacen(&shown, &printed, 1)
            }
            None => text,
        })
    }
}
