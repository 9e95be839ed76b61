//! Curves, and how far one is along them.

/// A point of the plane.
pub type Point = [f64; 2];

/// Points of a curve given by a parameter.
pub fn sampled(from: f64, to: f64, at: impl Fn(f64) -> Point) -> Vec<Point> {
    const INTERVALS: u32 = 300;
    let place = |k| from + (to - from) * f64::from(k) / f64::from(INTERVALS);
    (0..=INTERVALS).map(|k| at(place(k))).collect()
}

/// A quantity along a curve, over the length of arc that is passed where it is smallest.
pub fn along(curve: &[Point], quantity: impl Fn(Point) -> f64) -> Vec<Point> {
    let mut length = 0.0;
    let mut last = curve[0];
    let mut values = Vec::new();
    for point in curve {
        length += (point[0] - last[0]).hypot(point[1] - last[1]);
        last = *point;
        values.push([length, quantity(*point)]);
    }
    let smallest = values.iter().min_by(|a, b| a[1].total_cmp(&b[1]));
    let centre = smallest.map_or(0.0, |place| place[0]);
    values
        .iter()
        .map(|[s, value]| [s - centre, *value])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_is_shown_over_the_length_of_arc() {
        let line = sampled(-1.0, 1.0, |s| [s, s]);
        let values = along(&line, |[x, _]| x * x);
        let [first, value] = values[0];
        assert!((first + 2f64.sqrt()).abs() < 1e-9 && (value - 1.0).abs() < 1e-9);
    }
}
