//! Rows of a run to those that a page has room for.
//!
//! In:  rows.
//! Out: the places of those that are kept.

/// The places of at most about `most` rows: half of them evenly, half of them the lowest
/// and the highest of each column in each of some spans of the run, so that no curve loses
/// a peak. All if they are few.
pub fn kept(rows: &[Vec<f64>], most: usize) -> Vec<usize> {
    let count = rows.len();
    if count <= most {
        return (0..count).collect();
    }
    let mut kept = evenly(count, most / 2);
    let width = rows.first().map_or(0, Vec::len);
    let spans = (most / (4 * width.max(1))).max(1);
    let length = count.div_ceil(spans);
    for (span, part) in rows.chunks(length).enumerate() {
        for column in 1..width {
            let value = |row: &Vec<f64>| row.get(column).copied().unwrap_or(f64::NAN);
            let finite = part.iter().map(value).enumerate();
            let finite = finite.filter(|(_, value)| value.is_finite());
            let by = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
            let (low, high) = (finite.clone().min_by(by), finite.max_by(by));
            let ends = low.into_iter().chain(high);
            kept.extend(ends.map(|(place, _)| span * length + place));
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// At most `most` of a number of places, but two: the first, the last, and others at equal
/// distances.
pub fn evenly(count: usize, most: usize) -> Vec<usize> {
    let most = most.max(2);
    match count {
        0 => Vec::new(),
        _ if count <= most => (0..count).collect(),
        _ => (0..most).map(|i| i * (count - 1) / (most - 1)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{evenly, kept};

    #[test]
    fn thinned_rows_keep_the_peaks_of_all_columns_and_both_ends() {
        let row = |i: u32| vec![f64::from(i), 0.0, 1.0];
        let mut rows: Vec<_> = (0..200_000).map(row).collect();
        rows[54_321][1] = 7.0;
        rows[123_457][2] = -3.0;
        rows[9][2] = f64::NAN;
        let kept = kept(&rows, 1000);
        assert!(kept.len() <= 1000, "{}", kept.len());
        for place in [0, 54_321, 123_457, 199_999] {
            assert!(kept.contains(&place), "{place}");
        }
        assert!(kept.is_sorted());
        let gap = kept.windows(2).map(|pair| pair[1] - pair[0]).max();
        assert!(gap <= Some(401), "{gap:?}");
    }

    #[test]
    fn few_rows_are_all_kept() {
        let rows = vec![vec![0.0], vec![1.0]];
        assert_eq!(kept(&rows, 2), [0, 1]);
        assert_eq!(kept(&[], 5), [0_usize; 0]);
        assert_eq!(evenly(5, 3), [0, 2, 4]);
    }
}
