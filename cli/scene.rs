//! What a mechanism draws, as flat shapes.
//!
//! In:  the frames of a [`Scene`].
//! Out: [`Shape`]s on paper.

use crate::plot::Shape;
use bricard_driver::{Drawn, Scene};

/// How far a metre of depth moves a point to the right and up (m).
const DEPTH: [f64; 2] = [0.35, 0.25];
/// Numbers of a point.
const AXES: usize = 3;

/// Whether something is drawn outside the plane of x and y.
pub fn is_spatial(scene: &Scene) -> bool {
    let outside = |(_, points, _): (Drawn, &[f64], f64)| {
        let mut heights = points.iter().skip(2).step_by(AXES);
        heights.any(|z| *z != 0.0)
    };
    let mut frames = scene.frames.iter();
    frames.any(|frame| parts(&scene.shapes, frame).any(outside))
}

/// The shapes of a frame. A plane mechanism is seen as it is; in space x is to the right, z
/// upwards, and y goes into the depth.
pub fn shapes(scene: &Scene, frame: &[f64], spatial: bool) -> Vec<Shape> {
    let seen = |point: &[f64]| match (point, spatial) {
        ([x, y, z], true) => [x + DEPTH[0] * y, z + DEPTH[1] * y],
        ([x, y, _], false) => [*x, *y],
        _ => [f64::NAN; 2],
    };
    let shape = |(drawn, points, radius): (Drawn, &[f64], f64)| {
        let points: Vec<[f64; 2]> = points.chunks(AXES).map(seen).collect();
        let first = points.first().copied().unwrap_or([f64::NAN; 2]);
        match drawn {
            Drawn::Line(_) => Shape::Line(points),
            Drawn::Polygon(_) => Shape::Polygon(points),
            Drawn::Circle => Shape::Circle(first, radius),
            Drawn::Trace => Shape::Trace(first),
        }
    };
    parts(&scene.shapes, frame).map(shape).collect()
}

/// The shapes of a frame with their points and the radius of a circle.
fn parts<'a>(
    shapes: &'a [Drawn],
    frame: &'a [f64],
) -> impl Iterator<Item = (Drawn, &'a [f64], f64)> {
    let mut rest = frame;
    shapes.iter().map(move |shape| {
        let points = match shape {
            Drawn::Line(points) | Drawn::Polygon(points) => *points,
            Drawn::Circle | Drawn::Trace => 1,
        };
        let (places, mut after) = rest.split_at(rest.len().min(AXES * points));
        let mut radius = 0.0;
        if *shape == Drawn::Circle
            && let Some((first, others)) = after.split_first()
        {
            (radius, after) = (*first, others);
        }
        rest = after;
        (*shape, places, radius)
    })
}

#[cfg(test)]
mod tests {
    use super::{is_spatial, shapes};
    use crate::plot::Shape;
    use bricard_driver::{Drawn, Scene};

    fn scene(last: f64) -> Scene {
        Scene {
            parameters: Vec::new(),
            shapes: vec![Drawn::Circle, Drawn::Line(2)],
            frames: vec![vec![1.0, 2.0, 0.0, 5.0, 1.0, 2.0, 0.0, 1.0, 4.0, last]],
        }
    }

    #[test]
    fn a_radius_is_no_height() {
        assert!(!is_spatial(&scene(0.0)));
        assert!(is_spatial(&scene(0.5)));
    }

    #[test]
    fn shapes_have_the_places_of_their_frame() {
        let plane = scene(0.0);
        let circle = Shape::Circle([1.0, 2.0], 5.0);
        let line = Shape::Line(vec![[1.0, 2.0], [1.0, 4.0]]);
        assert_eq!(shapes(&plane, &plane.frames[0], false), [circle, line]);
        let space = scene(0.5);
        let drawn = shapes(&space, &space.frames[0], true);
        assert_eq!(drawn[1], Shape::Line(vec![[1.7, 0.5], [2.4, 1.5]]));
    }
}
