//! Bounds of what an exchange of columns gains, against all exchanges.

use super::{Matrices, SEED, orthogonalised};
use crate::linalg::{Workspace, exchange_bound};
use nalgebra::SMatrix;

/// The volume that some columns span, by their singular values.
fn volume<const N: usize, const K: usize>(columns: &SMatrix<f64, N, K>) -> f64 {
    let mut vectors = *columns;
    orthogonalised(&mut vectors, &mut SMatrix::identity()).unwrap();
    vectors.column_iter().map(|vector| vector.norm()).product()
}

#[test]
fn no_exchange_of_columns_gains_more_than_its_bound() {
    let mut random = Matrices::seeded(SEED);
    let (mut numbers, mut indices) = (vec![0.0; 256], vec![0; 8]);
    let (mut strict, mut close) = (0, 0);
    for case in 0..400 {
        // Two columns beside three, almost in their span, which is almost a plane.
        let mut columns: SMatrix<f64, 6, 5> = random.matrix();
        let [near, far] = [0.1f64.powi(case % 5), 0.1f64.powi(case % 7)];
        let plane = columns.column(0) + columns.column(1) + columns.column(2) * near;
        columns.set_column(2, &plane);
        for other in [3, 4] {
            let shares: SMatrix<f64, 3, 1> = random.matrix();
            let column = columns.fixed_columns::<3>(0) * shares + columns.column(other) * far;
            columns.set_column(other, &column);
        }
        let of = |chosen: [usize; 3]| {
            volume(&SMatrix::<f64, 6, 3>::from_columns(
                &chosen.map(|i| columns.column(i)),
            ))
        };
        let triples = (0..5).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| [i, j, k])));
        let largest = triples.map(of).fold(0.0, f64::max) / of([0, 1, 2]);
        let mut x = columns;
        let workspace = Workspace::new(&mut numbers, &mut [], &mut indices);
        let bound = exchange_bound(x.as_mut_slice(), 6, 3, &workspace);
        assert!(
            bound >= largest * (1.0 - 1e-6),
            "{case}: {largest} is above {bound}"
        );
        strict += usize::from(bound > 1.0);
        close += usize::from(bound < 4.0 * largest);
    }
    assert!(
        strict > 200 && close > 200,
        "{strict} bounds above one, {close} are close"
    );
}
