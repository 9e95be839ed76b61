//! A four-bar linkage: two cranks of one length and a coupler.
//!
//! In:  the lengths.
//! Out: the constraint that closes its loop as one function of the two crank angles, its
//!      gradient, and its zero set.

use crate::curve::Point;
use std::f64::consts::{PI, TAU};

/// Samples of a full turn.
const SAMPLES: i32 = 3000;
/// Distance of neighbouring points that are drawn (rad).
const NEAREST: f64 = 0.02;

/// A four-bar linkage with equal cranks.
#[derive(Clone, Copy, Debug)]
pub struct FourBar {
    /// Length of both cranks.
    pub crank: f64,
    /// Distance of the bearings.
    pub ground: f64,
    /// Length of the coupler.
    pub coupler: f64,
}

impl FourBar {
    /// The ends of the cranks.
    pub fn joints(&self, [q1, q3]: Point) -> [Point; 2] {
        let (crank, ground) = (self.crank, self.ground);
        [
            [crank * q1.cos(), crank * q1.sin()],
            [ground + crank * q3.cos(), crank * q3.sin()],
        ]
    }

    /// The squared distance of the cranks' ends, less that of the coupler.
    #[cfg(test)]
    pub fn gap(&self, angles: Point) -> f64 {
        let [a, b] = self.joints(angles);
        (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2) - self.coupler * self.coupler
    }

    /// The length of its gradient.
    pub fn gradient(&self, angles: Point) -> f64 {
        let [q1, q3] = angles;
        let [a, b] = self.joints(angles);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let first = 2.0 * self.crank * (x * q1.sin() - y * q1.cos());
        let third = 2.0 * self.crank * (y * q3.cos() - x * q3.sin());
        first.hypot(third)
    }

    /// The two angles of the second crank at an angle of the first, if the loop closes.
    fn closings(&self, q1: f64) -> Option<[f64; 2]> {
        let (x, y) = (self.crank * q1.cos() - self.ground, self.crank * q1.sin());
        let distance = x.hypot(y);
        let squares = self.crank.powi(2) + distance.powi(2) - self.coupler.powi(2);
        let cosine = squares / (2.0 * self.crank * distance);
        (cosine.abs() <= 1.0).then(|| {
            let (axis, angle) = (y.atan2(x), cosine.acos());
            [axis + angle, axis - angle]
        })
    }

    /// The other way to close a loop whose coupler is as long as the ground: the mirror
    /// image of the parallelogram in its diagonal.
    pub fn crossed(&self, q1: f64) -> f64 {
        let (x, y) = (self.crank * q1.cos() - self.ground, self.crank * q1.sin());
        wrapped(2.0 * y.atan2(x) - q1)
    }

    /// The zero set, as curves that don't leave the square of angles within half a turn.
    pub fn zero_set(&self) -> Vec<Vec<Point>> {
        let mut curves = Vec::new();
        let mut open: [Vec<Point>; 2] = [Vec::new(), Vec::new()];
        let mut turns = false;
        for k in -SAMPLES..=SAMPLES + 1 {
            let q1 = PI * f64::from(k) / f64::from(SAMPLES);
            let closings = self.closings(q1).filter(|_| k <= SAMPLES);
            if let Some(closings) = closings {
                for (curve, q3) in open.iter_mut().zip(closings) {
                    curve.push([q1, wrapped(q3)]);
                }
            } else {
                let [first, mut second] = std::mem::take(&mut open);
                // Both meet where the loop can just be closed: at the beginning or the end.
                second.reverse();
                curves.push(match turns {
                    true => [second, first].concat(),
                    false => [first, second].concat(),
                });
                turns = true;
            }
        }
        let pieces = curves.iter().flat_map(|curve| {
            let jumps =
                |a: &Point, b: &Point| (a[1] - b[1]).abs() > 1.0 || (a[0] - b[0]).abs() > 1.0;
            curve
                .chunk_by(move |a, b| !jumps(a, b))
                .map(<[Point]>::to_vec)
        });
        let pieces = pieces.map(thinned);
        pieces.filter(|piece| piece.len() > 1).collect()
    }
}

/// The points of a curve that are not too near to each other to be told apart.
fn thinned(curve: Vec<Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for point in curve {
        let is_new = |last: &Point| (point[0] - last[0]).hypot(point[1] - last[1]) > NEAREST;
        if kept.last().is_none_or(is_new) {
            kept.push(point);
        }
    }
    kept
}

/// An angle within half a turn.
fn wrapped(angle: f64) -> f64 {
    let turned = (angle + PI).rem_euclid(TAU) - PI;
    if turned < -PI { turned + TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_zero_set_closes_the_loop() {
        for coupler in [0.69, 0.7, 0.72] {
            let linkage = FourBar {
                crank: 0.4,
                ground: 0.7,
                coupler,
            };
            let points = linkage.zero_set().concat();
            assert!(points.len() > 400);
            for point in points {
                assert!(linkage.gap(point).abs() < 1e-9, "{point:?}");
            }
        }
    }

    #[test]
    fn a_parallelogram_closes_in_two_ways() {
        let linkage = FourBar {
            crank: 0.4,
            ground: 0.7,
            coupler: 0.7,
        };
        for q1 in [-2.0, -0.3, 0.0, 1.0, 3.0] {
            assert!(linkage.gap([q1, q1]).abs() < 1e-12);
            assert!(linkage.gap([q1, linkage.crossed(q1)]).abs() < 1e-12);
        }
        assert!(linkage.gradient([0.0, 0.0]) < 1e-12);
    }
}
