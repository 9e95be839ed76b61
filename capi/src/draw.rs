//! The picture of a mechanism, as numbers.
//!
//! In:  shapes.
//! Out: for each its kind, how many points it has, their coordinates, and the radius of a
//!      circle.

use bricard_runtime::Canvas;

/// Kinds of shapes.
const LINE: f64 = 0.0;
const CIRCLE: f64 = 1.0;
const POLYGON: f64 = 2.0;
const TRACE: f64 = 3.0;

/// Writes shapes into a place, as many numbers as there is room for, and counts all.
#[derive(Debug)]
pub(crate) struct Pencil<'a> {
    out: &'a mut [f64],
    /// Numbers so far, also those there was no room for.
    pub(crate) count: usize,
}

impl<'a> Pencil<'a> {
    pub(crate) fn new(out: &'a mut [f64]) -> Self {
        Self { out, count: 0 }
    }

    fn add(&mut self, numbers: &[f64]) {
        for number in numbers {
            if let Some(place) = self.out.get_mut(self.count) {
                *place = *number;
            }
            self.count += 1;
        }
    }

    fn shape(&mut self, kind: f64, points: &[[f64; 3]]) {
        self.add(&[kind, points.len() as f64]);
        for point in points {
            self.add(point);
        }
    }
}

impl Canvas<f64> for Pencil<'_> {
    fn line(&mut self, points: &[[f64; 3]]) {
        self.shape(LINE, points);
    }

    fn circle(&mut self, centre: [f64; 3], radius: f64) {
        self.shape(CIRCLE, &[centre]);
        self.add(&[radius]);
    }

    fn polygon(&mut self, points: &[[f64; 3]]) {
        self.shape(POLYGON, points);
    }

    fn trace(&mut self, point: [f64; 3]) {
        self.shape(TRACE, &[point]);
    }
}
