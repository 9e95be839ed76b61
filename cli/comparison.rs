//! Several runs to panels: a panel for each quantity, a curve for each run.
//!
//! In:  rows of runs of one mechanism, which may end at different times.
//! Out: a [`Comparison`] over the times of all of them.

use crate::column::Column;
use crate::figure::{named, scale};
use crate::plot::{Panel, Series};
use bricard_runtime::Structure;

/// The rows of a run, and what it is called.
#[derive(Clone, Debug, PartialEq)]
pub struct Called {
    /// What tells it from the others: `L1 = 0.4`.
    pub name: String,
    /// Its rows.
    pub rows: Vec<Vec<f64>>,
}

impl Called {
    /// The rows of the only run.
    pub fn alone(rows: Vec<Vec<f64>>) -> Self {
        let name = String::new();
        Self { name, rows }
    }
}

/// Quantities of several runs over the same times.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The times of all runs (s).
    pub times: Vec<f64>,
    /// A panel for each quantity.
    pub panels: Vec<Panel>,
}

/// Compares runs in some of their columns, by their places in the rows. Beyond the end of a
/// run its values are not a number.
pub fn compared(
    structure: &Structure,
    columns: &[Column],
    runs: &[Called],
    places: &[usize],
) -> Comparison {
    let rows = runs.iter().flat_map(|run| &run.rows);
    let mut times: Vec<f64> = rows.filter_map(|row| row.first().copied()).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let panel = |place: &usize| Panel {
        axis: named(structure, columns, &[], *place).name,
        scale: scale(structure, columns, *place),
        series: runs
            .iter()
            .map(|run| Series {
                name: run.name.clone(),
                values: times.iter().map(|t| at(&run.rows, *t, *place)).collect(),
            })
            .collect(),
    };
    let panels = places.iter().map(panel).collect();
    Comparison { times, panels }
}

impl Comparison {
    /// The rows of all curves side by side, with the time before them.
    pub fn rows(&self) -> Vec<Vec<f64>> {
        let all = || self.panels.iter().flat_map(|panel| &panel.series);
        let row = |(i, t): (usize, &f64)| {
            let values = all().map(|series| series.values[i]);
            std::iter::once(*t).chain(values).collect()
        };
        self.times.iter().enumerate().map(row).collect()
    }

    /// This comparison at some of its times, by their places.
    pub fn thinned(&self, places: &[usize]) -> Self {
        let some = |values: &[f64]| places.iter().map(|i| values[*i]).collect();
        let series = |series: &Series| Series {
            name: series.name.clone(),
            values: some(&series.values),
        };
        let panel = |panel: &Panel| Panel {
            series: panel.series.iter().map(series).collect(),
            ..panel.clone()
        };
        Self {
            times: some(&self.times),
            panels: self.panels.iter().map(panel).collect(),
        }
    }
}

/// The value of a column at a time, on the line between the rows around it: runs need not
/// have rows at the same times.
fn at(rows: &[Vec<f64>], t: f64, place: usize) -> f64 {
    let value = |row: &[f64]| row.get(place).copied().unwrap_or(f64::NAN);
    let after = rows.partition_point(|row| row[0] < t);
    match (after.checked_sub(1).map(|i| &rows[i]), rows.get(after)) {
        (_, Some(row)) if row[0] == t => value(row),
        (Some(before), Some(behind)) => {
            let part = (t - before[0]) / (behind[0] - before[0]);
            (1.0 - part) * value(before) + part * value(behind)
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::at;

    #[test]
    fn a_run_has_values_from_its_first_row_to_its_last() {
        let rows = [[0.0, 2.0], [1.0, 4.0], [1.5, 4.0]].map(Vec::from);
        assert_eq!(at(&rows, 0.0, 1), 2.0);
        assert_eq!(at(&rows, 0.25, 1), 2.5);
        assert_eq!(at(&rows, 1.0, 1), 4.0);
        assert!(at(&rows, 1.6, 1).is_nan() && at(&rows, -0.1, 1).is_nan());
        assert!(at(&[], 0.0, 1).is_nan());
    }
}
