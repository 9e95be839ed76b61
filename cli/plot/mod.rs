//! Pictures: curves over time in panels, configurations of a mechanism, time over
//! error.
//!
//! In:  series of numbers with names and units, shapes.
//! Out: SVG files.
//!
//! Not here: what is worth drawing ([`crate::figure`]).

mod axis;
mod curve;
mod frames;
mod legend;
mod moving;
mod panel;
mod phase;
mod sheet;
mod style;
mod work;

pub use curve::ends;
pub use frames::{Frame, Shape, film_as_svg, frames_as_svg};
pub use moving::moving_svg;
pub use panel::{Marks, Times, panels_as_svg};
pub use phase::{Portrait, phase_as_svg};
pub use sheet::Sheet;
pub use work::{Cloud, Mark, work_diagram};

/// One diagram over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What the vertical axis shows, with its unit.
    pub axis: String,
    /// How it is divided.
    pub scale: Scale,
    /// The curves.
    pub series: Vec<Series>,
}

/// How a vertical axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly, over the range of the values.
    Linear,
    /// Evenly, by whole numbers: for what is counted.
    Whole,
    /// By powers of ten, from `10^low` to `10^high` or further up if values lie
    /// there. Smaller values, zero among them, are drawn at the lower edge. Values
    /// are drawn as points: round-off has no path from one to the next.
    Logarithmic {
        /// Exponent at the lower edge.
        low: i32,
        /// Exponent at the upper edge, unless values are larger.
        high: i32,
    },
}

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its values, one for each time.
    pub values: Vec<f64>,
}
