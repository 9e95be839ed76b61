//! A mechanism as an engineer would draw it, moving: links with joints, hatched ground.
//!
//! In:  its shapes at equal distances in time.
//! Out: an SVG that moves wherever it is shown, without a script.

use super::frames::{Shape, bounds_of};
use super::style::colour;
use plotters::style::RGBColor;

/// Size of the picture (pixels).
const SIZE: [f64; 2] = [480.0, 360.0];
/// Pixels that a point may move and still be fixed.
const FIXED: f64 = 1e-3;
/// The least radius of a circle (pixels).
const LEAST: f64 = 2.5;
/// Pixels of the path of a point that are not worth a corner.
const CORNER: f64 = 0.4;

/// How lines are drawn; the picture is dark where the page around it is.
const STYLE: &str = "<style>\
.e{stroke:#222a33;stroke-width:9}.g{stroke:#222a33;stroke-width:1.6}\
.e,.b,.g,.t{fill:none;stroke-linecap:round;stroke-linejoin:round}.b{stroke-width:6.4}\
.t{stroke:#c2582c;stroke-width:1.3;stroke-opacity:.75}.o{fill:#c2582c}\
.p{stroke:#222a33;stroke-width:1.6;stroke-linejoin:round}\
.r{fill:none;stroke:#222a33;stroke-width:2.2}.j{fill:#fff;stroke:#222a33;stroke-width:1.5}\
@media (prefers-color-scheme:dark){.e,.g,.p,.r,.j{stroke:#dfe4ea}.j{fill:#14171b}}\
</style>\
<defs><marker id=\"j\" markerUnits=\"userSpaceOnUse\" markerWidth=\"9\" markerHeight=\"9\" \
refX=\"4.5\" refY=\"4.5\"><circle class=\"j\" cx=\"4.5\" cy=\"4.5\" r=\"3\"/></marker></defs>";

/// A link between two joints, a plate, a circle or the path of a point at each time.
enum Part {
    Link(Vec<[[f64; 2]; 2]>),
    Plate(Vec<Vec<[f64; 2]>>),
    Circle(Vec<([f64; 2], f64)>),
    Path(Vec<[f64; 2]>),
}

/// Draws a mechanism that moves for a time (s), over and over.
pub fn moving_svg(title: &str, frames: &[Vec<Shape>], seconds: f64) -> String {
    let (low, high) = bounds_of(frames.iter().flatten());
    let scale = (SIZE[0] / (high[0] - low[0])).min(SIZE[1] / (high[1] - low[1]));
    let middle = [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0);
    let pixel = |[x, y]: [f64; 2]| {
        let (right, up) = ((x - middle[0]) * scale, (y - middle[1]) * scale);
        [SIZE[0] / 2.0 + right, SIZE[1] / 2.0 - up]
    };
    let parts = parts(frames, pixel, scale);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0}\" height=\"{1:.0}\" \
         viewBox=\"0 0 {0:.0} {1:.0}\" role=\"img\" aria-label=\"{title}\">{STYLE}\n",
        SIZE[0], SIZE[1]
    );
    let moves = Moves(seconds);
    let paths = parts.iter().filter(|part| matches!(part, Part::Path(_)));
    paths.for_each(|part| text += &path(part, &moves));
    pivots(&parts).iter().for_each(|at| text += &hatched(*at));
    let bodies = parts.iter().enumerate();
    bodies.for_each(|(place, part)| text += &body(part, place, &moves));
    text + "</svg>\n"
}

/// The shapes by part instead of by time, in pixels.
fn parts(frames: &[Vec<Shape>], pixel: impl Fn([f64; 2]) -> [f64; 2], scale: f64) -> Vec<Part> {
    let count = frames.iter().map(Vec::len).min().unwrap_or(0);
    let mut parts = Vec::new();
    for place in 0..count {
        let all = || frames.iter().map(|frame| &frame[place]);
        let points = |shape: &Shape| -> Vec<[f64; 2]> {
            let points = shape.points().iter();
            points.map(|point| pixel(*point)).collect()
        };
        let moved: Vec<Vec<[f64; 2]>> = all().map(points).collect();
        let first = |points: &Vec<[f64; 2]>| points.first().copied().unwrap_or_default();
        match all().next() {
            Some(Shape::Line(corners)) => {
                for i in 1..corners.len() {
                    let link = moved.iter().map(|points| [points[i - 1], points[i]]);
                    parts.push(Part::Link(link.collect()));
                }
            }
            Some(Shape::Polygon(_)) => parts.push(Part::Plate(moved)),
            Some(Shape::Circle(..)) => {
                let radii = all().map(|shape| shape.radius() * scale);
                let circles = moved.iter().map(first).zip(radii);
                parts.push(Part::Circle(circles.collect()));
            }
            Some(Shape::Trace(_)) => parts.push(Part::Path(moved.iter().map(first).collect())),
            None => {}
        }
    }
    parts
}

/// How attributes change with time, of a motion that takes so long (s).
struct Moves(f64);

impl Moves {
    /// The value of an attribute at each time; nothing if it stays the same.
    fn attribute(&self, name: &str, values: &[String]) -> String {
        match values.windows(2).any(|pair| pair[0] != pair[1]) {
            true => format!(
                "<animate attributeName=\"{name}\" dur=\"{}s\" repeatCount=\"indefinite\" \
                 values=\"{}\"/>",
                self.0,
                values.join(";")
            ),
            false => String::new(),
        }
    }

    /// An element with an attribute that changes.
    fn element(&self, head: &str, name: &str, values: &[String]) -> String {
        let first = values.first().map_or("", String::as_str);
        let kind = head.split(' ').next().unwrap_or_default();
        let change = self.attribute(name, values);
        format!("<{head} {name}=\"{first}\">{change}</{kind}>")
    }

    /// A circle whose centre changes.
    fn circle(&self, class: &str, radius: f64, centres: &[[f64; 2]]) -> String {
        let along = |axis: usize| -> Vec<String> {
            centres.iter().map(|point| short(point[axis])).collect()
        };
        let (x, y) = (along(0), along(1));
        let first = |values: &[String]| values.first().cloned().unwrap_or_default();
        format!(
            "<circle class=\"{class}\" r=\"{}\" cx=\"{}\" cy=\"{}\">{}{}</circle>\n",
            short(radius),
            first(&x),
            first(&y),
            self.attribute("cx", &x),
            self.attribute("cy", &y)
        )
    }
}

/// A number in as few digits as a pixel has use for.
fn short(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0" } else { text }.to_string()
}

fn written(points: &[[f64; 2]]) -> String {
    let point = |[x, y]: &[f64; 2]| format!("{},{}", short(*x), short(*y));
    points.iter().map(point).collect::<Vec<_>>().join(" ")
}

fn path(part: &Part, moves: &Moves) -> String {
    let Part::Path(points) = part else {
        return String::new();
    };
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for point in points {
        let away = |last: &[f64; 2]| (point[0] - last[0]).hypot(point[1] - last[1]);
        if kept.last().is_none_or(|last| away(last) > CORNER) {
            kept.push(*point);
        }
    }
    let line = format!("<polyline class=\"t\" points=\"{}\"/>", written(&kept));
    line + &moves.circle("o", 3.0, points)
}

/// A link, plate or circle; `place` tells links from each other.
fn body(part: &Part, place: usize, moves: &Moves) -> String {
    let RGBColor(r, g, b) = colour(place);
    let ink = format!("#{r:02x}{g:02x}{b:02x}");
    match part {
        // What does not move at all is ground.
        Part::Link(link) if [0, 1].iter().all(|end| stays(link, *end)) => {
            let points = link.first().map(|ends| written(ends)).unwrap_or_default();
            format!("<polyline class=\"g\" points=\"{points}\"/>\n")
        }
        Part::Link(link) => {
            let values: Vec<String> = link.iter().map(|ends| written(ends)).collect();
            let line = moves.element(&format!("polyline id=\"l{place}\""), "points", &values);
            let used = format!("<use href=\"#l{place}\" class");
            format!(
                "<defs>{line}</defs>{used}=\"e\"/>{used}=\"b\" stroke=\"{ink}\" \
                 marker-start=\"url(#j)\" marker-end=\"url(#j)\"/>\n"
            )
        }
        Part::Plate(plates) => {
            let values: Vec<String> = plates.iter().map(|points| written(points)).collect();
            let head = format!("polygon class=\"p\" fill=\"{ink}\" fill-opacity=\".55\"");
            moves.element(&head, "points", &values) + "\n"
        }
        Part::Circle(circles) => {
            let centres: Vec<[f64; 2]> = circles.iter().map(|circle| circle.0).collect();
            let radius = circles.first().map_or(0.0, |circle| circle.1);
            moves.circle("r", radius.max(LEAST), &centres)
        }
        Part::Path(_) => String::new(),
    }
}

/// Whether an end of a link stays where it is.
fn stays(link: &[[[f64; 2]; 2]], end: usize) -> bool {
    let away = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let first = link.first().map(|ends| ends[end]);
    let mut all = link.iter();
    all.all(|ends| first.is_some_and(|first| away(ends[end], first) < FIXED))
}

/// The pivots of links that turn about a fixed point, each once.
fn pivots(parts: &[Part]) -> Vec<[f64; 2]> {
    let mut found: Vec<[f64; 2]> = Vec::new();
    for part in parts {
        let Part::Link(link) = part else { continue };
        let fixed = [0, 1].map(|end| stays(link, end));
        for end in [0, 1] {
            let at = link.first().map(|ends| ends[end]);
            let is_pivot = fixed[end] && !fixed[1 - end];
            found.extend(at.filter(|at| is_pivot && !found.contains(at)));
        }
    }
    found
}

/// The sign of a fixed pivot: a triangle on hatched ground.
fn hatched([x, y]: [f64; 2]) -> String {
    let at = |dx: f64, dy: f64| format!("{},{}", short(x + dx), short(y + dy));
    let strokes = [-9.0, -4.5, 0.0, 4.5, 9.0];
    let strokes = strokes.map(|dx| format!("M{}L{}", at(dx, 14.0), at(dx - 4.0, 19.0)));
    format!(
        "<path class=\"g\" d=\"M{}L{}L{}ZM{}L{}{}\"/>\n",
        at(0.0, 0.0),
        at(-8.0, 14.0),
        at(8.0, 14.0),
        at(-13.0, 14.0),
        at(13.0, 14.0),
        strokes.concat()
    )
}

#[cfg(test)]
mod tests {
    use super::moving_svg;
    use crate::plot::Shape;

    #[test]
    fn a_crank_turns_about_ground_and_a_rail_stands_still() {
        let frame = |x: f64| {
            let crank = Shape::Line(vec![[0.0, 0.0], [x, 1.0]]);
            vec![crank, Shape::Line(vec![[-1.0, 0.0], [1.0, 0.0]])]
        };
        let svg = moving_svg("crank", &[frame(0.0), frame(1.0)], 2.0);
        assert_eq!(svg.matches("<animate ").count(), 1, "{svg}");
        assert_eq!(svg.matches("<path class=\"g\"").count(), 1, "{svg}");
        assert_eq!(svg.matches("<polyline class=\"g\"").count(), 1, "{svg}");
    }
}
