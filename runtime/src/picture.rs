//! The picture of a mechanism, as numbers.
//!
//! In:  the shapes that a mechanism draws.
//! Out: for each shape its kind, how many points follow, and their coordinates, three each;
//!      a circle has its radius behind its centre.

use crate::model::Canvas;

/// An open polygon.
const LINE: f64 = 0.0;
/// A circle.
const CIRCLE: f64 = 1.0;
/// A closed polygon.
const POLYGON: f64 = 2.0;
/// A point whose path is wanted.
const TRACE: f64 = 3.0;

/// Shapes in an array.
#[derive(Debug)]
pub struct Picture<'a> {
    numbers: &'a mut [f64],
    length: usize,
}

impl<'a> Picture<'a> {
    /// An empty picture.
    pub fn new(numbers: &'a mut [f64]) -> Self {
        Self { numbers, length: 0 }
    }

    /// How many numbers all shapes have, whether there was room for them or not.
    pub fn length(&self) -> usize {
        self.length
    }

    fn write(&mut self, number: f64) {
        if let Some(place) = self.numbers.get_mut(self.length) {
            *place = number;
        }
        self.length += 1;
    }

    fn shape(&mut self, kind: f64, points: &[[f64; 3]]) {
        self.write(kind);
        self.write(points.len() as f64);
        for number in points.as_flattened() {
            self.write(*number);
        }
    }
}

impl Canvas<f64> for Picture<'_> {
    fn line(&mut self, points: &[[f64; 3]]) {
        self.shape(LINE, points);
    }

    fn circle(&mut self, centre: [f64; 3], radius: f64) {
        self.shape(CIRCLE, &[centre]);
        self.write(radius);
    }

    fn polygon(&mut self, points: &[[f64; 3]]) {
        self.shape(POLYGON, points);
    }

    fn trace(&mut self, point: [f64; 3]) {
        self.shape(TRACE, &[point]);
    }
}

#[cfg(test)]
mod tests {
    use super::Picture;
    use crate::model::Canvas;

    #[test]
    fn shapes_are_kinds_counts_and_points_and_what_has_no_room_is_counted() {
        let mut numbers = [9.0; 12];
        let mut picture = Picture::new(&mut numbers);
        picture.circle([1.0, 2.0, 3.0], 4.0);
        picture.line(&[[5.0, 6.0, 7.0], [8.0, 8.5, 8.75]]);
        assert_eq!(picture.length(), 14);
        let circle = [1.0, 1.0, 1.0, 2.0, 3.0, 4.0];
        assert_eq!(numbers[..6], circle);
        assert_eq!(numbers[6..], [0.0, 2.0, 5.0, 6.0, 7.0, 8.0]);
    }
}
