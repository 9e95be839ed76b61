//! Plain dense linear algebra for the tests: short, slow, and none of the runtime's.

/// A basis of the null space of a matrix with `n` columns, by elimination with full
/// pivoting. A pivot below `1e-10` of the largest entry counts as zero.
pub fn null_space(rows: &[Vec<f64>], n: usize) -> Vec<Vec<f64>> {
    let mut a = rows.to_vec();
    let largest = a
        .iter()
        .flatten()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut pivots: Vec<usize> = Vec::new();
    for step in 0..a.len().min(n) {
        let places = (step..a.len()).flat_map(|i| (0..n).map(move |j| (i, j)));
        let best = places.max_by(|&(i, j), &(k, l)| a[i][j].abs().total_cmp(&a[k][l].abs()));
        let Some((row, column)) = best else { break };
        if a[row][column].abs() <= 1e-10 * largest {
            break;
        }
        a.swap(step, row);
        let pivot = a[step]
            .iter()
            .map(|x| x / a[step][column])
            .collect::<Vec<f64>>();
        for (i, other) in a.iter_mut().enumerate() {
            let factor = other[column];
            if i != step {
                other
                    .iter_mut()
                    .zip(&pivot)
                    .for_each(|(x, p)| *x -= factor * p);
            }
        }
        a[step] = pivot;
        pivots.push(column);
    }
    let free = (0..n).filter(|column| !pivots.contains(column));
    free.map(|column| {
        let mut direction = vec![0.0; n];
        direction[column] = 1.0;
        for (row, &pivot) in pivots.iter().enumerate() {
            direction[pivot] = -a[row][column];
        }
        direction
    })
    .collect()
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The sum of the sizes of the products that [`dot`] adds up.
pub fn size(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum()
}

pub fn times(rows: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| dot(row, x)).collect()
}
