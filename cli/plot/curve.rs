//! Series to curves: what coincides is one curve, and no more points than the
//! paper can show.

use super::{Scale, Series};

/// Curves that differ by less than this fraction of the panel's range look the
/// same.
const SAME: f64 = 2e-3;
/// The margin above and below the values, as a fraction of their range.
const MARGIN: f64 = 0.06;
/// The least range shown, as a fraction of the values: what is nearly constant
/// should look so.
const FLAT: f64 = 1e-3;
/// The least range shown of what is constant altogether, as a fraction of its value.
const CONSTANT: f64 = 0.1;
/// Values larger than this have no place on an axis, whose length would be infinite.
const LARGEST: f64 = 1e300;
/// A range smaller than this is as good as none.
const SMALLEST: f64 = 1e-290;
/// Points of a curve before it is thinned: about two for each pixel.
const POINTS: usize = 1600;

/// A curve ready to be drawn.
#[derive(Debug)]
pub struct Curve {
    /// The names of all series that it shows.
    pub name: String,
    /// The place of the first of them, which decides the colour: a run has the same one in
    /// all panels.
    pub place: usize,
    /// Time and value.
    pub points: Vec<(f64, f64)>,
}

/// The curves of series on a scale, and the range of their values.
pub fn curves(times: &[f64], series: &[Series], scale: Scale) -> (Vec<Curve>, (f64, f64)) {
    let scaled: Vec<Vec<f64>> = series
        .iter()
        .map(|s| s.values.iter().map(|y| place(*y, scale)).collect())
        .collect();
    let range = range(&scaled, scale);
    let mut kept: Vec<(usize, Vec<&str>)> = Vec::new();
    for (i, values) in scaled.iter().enumerate() {
        let same = kept
            .iter_mut()
            .find(|(j, _)| coincide(values, &scaled[*j], range, scale));
        match same {
            Some((_, names)) => names.push(&series[i].name),
            None => kept.push((i, vec![&series[i].name])),
        }
    }
    let curve = |(i, names): (usize, Vec<&str>)| {
        let points = times.iter().copied().zip(scaled[i].iter().copied());
        let points = points
            .filter(|(t, y)| has_place(*t) && y.is_finite())
            .collect();
        Curve {
            name: names.join(", "),
            place: i,
            points: thinned(points),
        }
    };
    (kept.into_iter().map(curve).collect(), range)
}

/// The least and the greatest of numbers; the first is above the other if there are none.
pub fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
        (low.min(y), high.max(y))
    })
}

/// Whether a number can be drawn.
pub fn has_place(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Where a value lies on the axis; NaN if it has no place there.
fn place(value: f64, scale: Scale) -> f64 {
    match scale {
        _ if !has_place(value) => f64::NAN,
        Scale::Linear | Scale::Whole => value,
        Scale::Logarithmic { low, .. } => value.abs().log10().max(f64::from(low)),
    }
}

/// The range that an axis should show: with a margin if it is linear, whole
/// powers of ten if not.
fn range(scaled: &[Vec<f64>], scale: Scale) -> (f64, f64) {
    let values = scaled.iter().flatten().copied();
    let (low, high) = ends(values.filter(|y| y.is_finite()));
    match scale {
        Scale::Linear | Scale::Whole if low > high => (0.0, 1.0),
        Scale::Whole => (low.floor() - 1.0, high.ceil() + 1.0),
        Scale::Linear => {
            let size = low.abs().max(high.abs());
            let flat = if low == high { CONSTANT } else { FLAT };
            let least = if size < SMALLEST { 1.0 } else { flat * size };
            let margin = (MARGIN * (high - low)).max(0.5 * (least - (high - low)));
            (low - margin, high + margin)
        }
        Scale::Logarithmic {
            low: bottom,
            high: top,
        } => (
            f64::from(bottom),
            f64::from(top).max(high.min(300.0).ceil()),
        ),
    }
}

fn coincide(a: &[f64], b: &[f64], range: (f64, f64), scale: Scale) -> bool {
    let near = SAME * (range.1 - range.0);
    matches!(scale, Scale::Linear | Scale::Whole)
        && a.iter().zip(b).all(|(x, y)| (x - y).abs() <= near)
}

/// Keeps the lowest and the highest of neighbouring points, so that no peak is
/// lost.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    if points.len() <= POINTS {
        return points;
    }
    let group = points.len().div_ceil(POINTS / 2);
    let mut kept = Vec::with_capacity(POINTS + 2);
    for chunk in points.chunks(group) {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (low, high) = (chunk.iter().min_by(by), chunk.iter().max_by(by));
        let mut ends: Vec<_> = low.into_iter().chain(high).copied().collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        kept.extend(ends);
    }
    kept.extend(points.last());
    kept
}

#[cfg(test)]
mod tests {
    use super::{curves, thinned};
    use crate::figure::ERRORS;
    use crate::plot::{Scale, Series};

    #[test]
    fn curves_that_look_the_same_are_drawn_once() {
        let series = |name: &str, slope: f64| Series {
            name: name.to_string(),
            values: (0..10).map(|i| slope * f64::from(i)).collect(),
        };
        let times: Vec<f64> = (0..10).map(f64::from).collect();
        let all = [series("a", 1.0), series("b", -1.0), series("c", 1.0001)];
        let (curves, _) = curves(&times, &all, Scale::Linear);
        let names: Vec<_> = curves.iter().map(|curve| curve.name.as_str()).collect();
        assert_eq!(names, ["a, c", "b"]);
    }

    #[test]
    fn what_is_no_number_or_too_large_for_an_axis_is_left_out() {
        let odd = [f64::NAN, f64::INFINITY, -f64::MAX, 1.0, -1e300, 5e-324];
        let times = [0.0, 1.0, 2.0, f64::NAN, 4.0, 5.0];
        for (scale, drawn) in [
            (Scale::Linear, [(4.0, -1e300), (5.0, 5e-324)]),
            (ERRORS, [(4.0, 300.0), (5.0, -18.0)]),
        ] {
            let series = Series {
                name: "odd".to_string(),
                values: odd.to_vec(),
            };
            let (curves, (low, high)) = curves(&times, &[series], scale);
            assert_eq!(curves[0].points, drawn);
            assert!((high - low).is_finite() && high > low);
        }
    }

    #[test]
    fn what_is_counted_lies_between_whole_numbers() {
        let rank = Series {
            name: "rank".to_string(),
            values: vec![9.0; 4],
        };
        let (_, range) = curves(&[0.0, 1.0, 2.0, 3.0], &[rank], Scale::Whole);
        assert_eq!(range, (8.0, 10.0));
    }

    #[test]
    fn a_thinned_curve_keeps_its_peak() {
        let mut points: Vec<_> = (0..100_000).map(|i| (f64::from(i), 0.0)).collect();
        points[54_321].1 = 7.0;
        let thinned = thinned(points);
        assert!(thinned.len() < 2000);
        assert!(thinned.contains(&(54_321.0, 7.0)));
    }
}
