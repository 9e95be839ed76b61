//! Factorisations against what they factorise, on random matrices.

use super::*;
use crate::tolerance::{passes, window};
use bricard_testkit::Random;
use nalgebra::{SMatrix, SVector};

/// Seed of the random matrices; a failing test names its own.
const SEED: u64 = 0x5DEE_CE66_D1CE_5EED;

/// Random matrices.
struct Matrices(Random);

impl Matrices {
    fn seeded(seed: u64) -> Self {
        Self(Random::seeded(seed))
    }

    fn number(&mut self) -> f64 {
        self.0.within(1.0)
    }

    fn matrix<const A: usize, const B: usize>(&mut self) -> SMatrix<f64, A, B> {
        SMatrix::from_fn(|_, _| self.number())
    }

    fn definite<const N: usize>(&mut self) -> SMatrix<f64, N, N> {
        let half: SMatrix<f64, N, N> = self.matrix();
        half * half.transpose() + SMatrix::identity() * 0.1
    }
}

/// Rotates the columns of both.
fn orthogonalised<const N: usize, const K: usize>(
    g: &mut SMatrix<f64, N, K>,
    v: &mut SMatrix<f64, K, K>,
) -> Result<(), Breakdown> {
    let squares = &mut [0.0; K];
    orthogonalise((g.as_mut_slice(), N), (v.as_mut_slice(), K), squares)
}

#[test]
fn cholesky_gives_the_matrix_back() {
    for round in 0..50 {
        let mut random = Matrices::seeded(SEED + round);
        let matrix: SMatrix<f64, 6, 6> = random.definite();
        let mut cholesky = Cholesky::default();
        cholesky.factorise(&matrix).unwrap();
        let x: SVector<f64, 6> = random.matrix();
        let mut lifted = [0.0; 6];
        multiply_upper_transposed(cholesky.as_slice(), x.as_slice(), &mut lifted);
        let mut image = SVector::from(lifted);
        multiply_upper(cholesky.as_slice(), image.as_mut_slice());
        assert!((image - matrix * x).amax() < 1e-13, "seed {SEED} + {round}");
        let mut back = image.data.0[0];
        cholesky.forward(&mut back);
        cholesky.backward(&mut back);
        assert!(
            (SVector::from(back) - x).amax() < 1e-11,
            "seed {SEED} + {round}"
        );
        let length = cholesky.length(&x.data.0[0]);
        assert!((length * length - x.dot(&image)).abs() < 1e-12);
    }
}

#[test]
fn cholesky_names_the_row_that_is_not_definite() {
    let mut cholesky = Cholesky::default();
    let mut check = |matrix: SMatrix<f64, 3, 3>, row: usize| {
        assert_eq!(cholesky.factorise(&matrix), Err(NotDefinite { row }));
    };
    check(SMatrix::zeros(), 2);
    check(SMatrix::from_diagonal(&[1.0, 2.0, -1.0].into()), 2);
    check(SMatrix::repeat(1.0), 1);
    check(SMatrix::from_diagonal(&[1.0, f64::NAN, 1.0].into()), 1);
    check(SMatrix::from_diagonal(&[f64::INFINITY, 1.0, 1.0].into()), 0);
}

#[test]
fn definiteness_does_not_depend_on_units() {
    for scale in [1e-150, 1e-8, 1.0, 1e8, 1e150] {
        let matrix = SMatrix::<f64, 2, 2>::from_diagonal(&[scale, 1.0 / scale].into());
        assert_eq!(Cholesky::default().factorise(&matrix), Ok(()));
    }
}

#[test]
fn gram_solves_and_shows_the_sine_of_the_weakest_row() {
    let mut vectors = SMatrix::<f64, 4, 3>::zeros();
    let (sine, cosine) = 0.01_f64.sin_cos();
    vectors.set_column(0, &[2.0, 0.0, 0.0, 0.0].into());
    vectors.set_column(1, &[3.0 * cosine, 3.0 * sine, 0.0, 0.0].into());
    vectors.set_column(2, &[0.0, 0.0, 0.0, 5.0].into());
    let mut gram = Gram::default();
    let square = gram.factorise(&vectors, 3, |k| vectors.column(k).norm_squared());
    assert!((square.sqrt() - sine).abs() < 1e-12);
    let x = SVector::from([1.0, -2.0, 0.5]);
    let mut back = (vectors.transpose() * vectors * x).data.0[0];
    gram.solve(&mut back);
    assert!((SVector::from(back) - x).amax() < 1e-10);
}

#[test]
fn gram_of_dependent_or_infinite_rows_passes_nowhere() {
    let mut gram = Gram::<f64, 2>::default();
    for entry in [1.0, f64::NAN, f64::INFINITY] {
        let vectors = SMatrix::<f64, 3, 2>::repeat(entry);
        let square = gram.factorise(&vectors, 2, |_| 3.0);
        assert!(!passes(square, window()), "{entry}: {square}");
    }
}

/// Rotates the columns of `matrix` and checks that nothing was lost.
fn check_rotations<const K: usize, const N: usize>(matrix: SMatrix<f64, K, N>) -> Vec<f64> {
    let mut images = matrix;
    let mut basis = SMatrix::<f64, N, N>::identity();
    orthogonalised(&mut images, &mut basis).unwrap();
    let identity = SMatrix::<f64, N, N>::identity();
    assert!((basis.transpose() * basis - identity).amax() < 1e-13);
    assert!((matrix * basis - images).amax() <= 1e-13 * matrix.norm());
    let gram = images.transpose() * images;
    let largest = gram.amax();
    for i in 0..N {
        for j in 0..i {
            assert!(gram[(i, j)].abs() <= 1e-14 * largest, "columns {i}, {j}");
        }
    }
    images.data.0.iter().map(|column| norm(column)).collect()
}

#[test]
fn rotations_find_an_orthogonal_basis_of_any_shape() {
    for round in 0..20 {
        let mut random = Matrices::seeded(SEED + round);
        check_rotations::<3, 5>(random.matrix());
        check_rotations::<5, 3>(random.matrix());
        check_rotations::<4, 4>(random.matrix());
        check_rotations::<1, 6>(random.matrix());
    }
    check_rotations::<0, 3>(SMatrix::zeros());
    check_rotations::<3, 4>(SMatrix::zeros());
}

#[test]
fn small_singular_values_keep_their_digits() {
    for round in 0..20 {
        let mut random = Matrices::seeded(SEED + round);
        let left = orthonormal::<5>(&mut random);
        let right = orthonormal::<5>(&mut random);
        let wanted = [1.0, 0.5, 1e-3, 1e-6, 1e-9];
        let matrix = left * SMatrix::<f64, 5, 5>::from_diagonal(&wanted.into()) * right;
        let found = check_rotations(matrix);
        for (value, wanted) in found.iter().zip(wanted) {
            assert!((value - wanted).abs() < 4e-15, "{found:?}");
        }
    }
}

fn orthonormal<const N: usize>(random: &mut Matrices) -> SMatrix<f64, N, N> {
    let mut images: SMatrix<f64, N, N> = random.matrix();
    let mut basis = SMatrix::identity();
    orthogonalised(&mut images, &mut basis).unwrap();
    basis
}

#[test]
fn the_null_space_is_annihilated() {
    let mut random = Matrices::seeded(SEED);
    let factor: SMatrix<f64, 4, 2> = random.matrix();
    let other: SMatrix<f64, 2, 6> = random.matrix();
    let values = check_rotations::<4, 6>(factor * other);
    assert!(values[1] > 1e-3);
    assert!(values[2..].iter().all(|value| *value < 1e-15), "{values:?}");
}

#[test]
fn columns_that_are_not_finite_break_off_at_once() {
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let mut images = SMatrix::<f64, 3, 3>::repeat(bad);
        let mut basis = SMatrix::<f64, 3, 3>::identity();
        assert_eq!(orthogonalised(&mut images, &mut basis), Err(Breakdown));
    }
}

#[test]
fn independent_rows_span_what_all_span() {
    let mut random = Matrices::seeded(SEED);
    let half: SMatrix<f64, 5, 3> = random.matrix();
    let mix: SMatrix<f64, 3, 6> = random.matrix();
    let mut chosen = [0; 6];
    let mut columns = half * mix;
    let first = |column| column == 4;
    let found = independent_columns(columns.as_mut_slice(), 5, &first, 1e-9, &mut chosen);
    assert_eq!(found, 3);
    assert_eq!(chosen[0], 4, "the row that was to come first did not");
    let mut distinct = chosen[..3].to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), 3);
}

#[test]
fn row_by_row_least_squares_solves_the_normal_equations() {
    let mut random = Matrices::seeded(SEED);
    let left: SMatrix<f64, 9, 3> = random.matrix();
    let right: SMatrix<f64, 9, 3> = random.matrix();
    let values: SVector<f64, 9> = random.matrix();
    let mut numbers = [0.0; 3 * 9 + 2 * 3];
    let mut triangle = Triangle::new(3, &Workspace::new(&mut numbers, &mut [], &mut []));
    for i in 0..9 {
        let row = |m: &SMatrix<f64, 9, 3>| [m[(i, 0)], m[(i, 1)], m[(i, 2)]];
        triangle.insert(&mut row(&left), &mut row(&right), values[i]);
    }
    let (x, y) = triangle.solve();
    let [x, y] = [x, y].map(SVector::<f64, 3>::from_column_slice);
    let rest = left * x + right * y - values;
    assert!((left.transpose() * rest).amax() < 1e-13);
    assert!((right.transpose() * rest).amax() < 1e-13);
}

#[test]
fn elimination_gives_coordinates_that_satisfy_the_rows() {
    let mut random = Matrices::seeded(SEED);
    let matrix: SMatrix<f64, 3, 5> = random.matrix();
    let right: SVector<f64, 3> = random.matrix();
    let (mut table, mut offset, mut dependent) = (matrix, right, [0; 3]);
    let found = Elimination::new(
        table.as_mut_slice(),
        offset.as_mut_slice(),
        &[1.0; 5],
        &Workspace::new(&mut [], &mut [], &mut dependent),
    );
    assert_eq!(found.dependent.len(), 3);
    let mut x: SVector<f64, 5> = random.matrix();
    for (k, &dependent) in found.dependent.iter().enumerate() {
        let others = (0..5).filter(|j| !found.dependent.contains(j));
        let sum: f64 = others.map(|j| found.table[3 * j + k] * x[j]).sum();
        x[dependent] = found.offset[k] - sum;
    }
    assert!((matrix * x - right).amax() < 1e-12);
}

/// A matrix as a block.
fn block<'a, const K: usize>(
    matrix: &SMatrix<f64, K, K>,
    workspace: &Workspace<'a, f64>,
) -> Block<'a, f64> {
    let mut block = Block::zeros(K, workspace);
    for i in 0..K {
        let row = matrix.row(i).transpose();
        block.row_mut(i).copy_from_slice(row.as_slice());
    }
    block
}

#[test]
fn the_smallest_pivot_of_a_block_is_that_of_complete_pivoting() {
    const K: usize = 7;
    let mut random = Matrices::seeded(SEED);
    for round in 0..20 {
        // Loops in a row: each row has entries with its neighbours only.
        let chain = SMatrix::<f64, K, K>::from_fn(|i, j| match i.abs_diff(j) {
            0 | 1 => random.number(),
            _ => 0.0,
        });
        let (mut numbers, mut indices) = ([0.0; 2 * K * K], [0; 2 * K]);
        let workspace = Workspace::new(&mut numbers, &mut [], &mut indices);
        let mut block = block(&chain, &workspace);
        let pivots = chain.full_piv_lu().u().diagonal().abs();
        let (found, exact) = (block.smallest(&workspace), pivots.min());
        assert!(
            (found - exact).abs() < 1e-12,
            "{round}: {found} is not {exact}"
        );
    }
}

#[test]
fn changes_of_sign_of_long_blocks_are_counted() {
    const K: usize = 24;
    const TURNED: usize = 9;
    let mut random = Matrices::seeded(SEED);
    for round in 0..20 {
        // Two chains of loops, each closed by a row with entries everywhere in it.
        let is_in = |i: usize, j: usize| (i < TURNED) == (j < TURNED);
        let chain = SMatrix::<f64, K, K>::from_fn(|i, j| match i + 1 == TURNED || i + 1 == K {
            true if is_in(i, j) => random.number(),
            false if is_in(i, j) && (i == j || i + 1 == j) => 1.0 + 0.3 * random.number(),
            _ => 0.0,
        });
        // The first is passed through, and all of it is a little different behind it.
        let behind = SMatrix::<f64, K, K>::from_fn(|i, j| {
            let factor = if i < TURNED { -0.6 } else { 0.8 };
            chain[(i, j)] * factor * (1.0 + 1e-3 * random.number())
        });
        let (mut numbers, mut indices) = ([0.0; 5 * K * K], [0; 2 * K]);
        let workspace = Workspace::new(&mut numbers, &mut [], &mut indices);
        let [before, after] = [chain, behind].map(|matrix| block(&matrix, &workspace));
        let changes = after.sign_changes_from(&before, &workspace);
        assert_eq!(changes, TURNED, "round {round}");
        assert_eq!(before.sign_changes_from(&before, &workspace), 0, "{round}");
    }
}

/// Counts the changes of sign between blocks of `K` rows at random distances of many orders of
/// magnitude from the sheets that they cross.
fn check_signs_at_unlike_distances<const K: usize>(random: &mut Matrices) {
    for round in 0..200 {
        let before: SMatrix<f64, K, K> = random.matrix();
        let basis: SMatrix<f64, K, K> = random.matrix();
        let eigenvalues = SVector::<f64, K>::from_fn(|_, _| {
            random.number().signum() * 10.0_f64.powf(-3.0 * random.number().abs())
        });
        let Some(inverse) = basis.try_inverse().filter(|it| it.amax() < 10.0) else {
            continue;
        };
        let after = before * basis * SMatrix::from_diagonal(&eigenvalues) * inverse;
        let (mut numbers, mut indices) = ([0.0; 64], [0; 8]);
        let workspace = Workspace::new(&mut numbers, &mut [], &mut indices);
        let [before, after] = [before, after].map(|matrix| block(&matrix, &workspace));
        let negative = eigenvalues.iter().filter(|it| **it < 0.0).count();
        let changes = after.sign_changes_from(&before, &workspace);
        assert_eq!(changes, negative, "round {round} of {K} rows");
    }
}

#[test]
fn changes_of_sign_are_counted_at_unlike_distances() {
    let mut random = Matrices::seeded(SEED);
    check_signs_at_unlike_distances::<2>(&mut random);
    check_signs_at_unlike_distances::<3>(&mut random);
}

/// Rows that are far from dependence beside those of three loops that fold one after the other:
/// how far each is from its fold depends on the loops before it.
#[test]
fn changes_of_sign_are_counted_among_rows_far_from_dependence() {
    const K: usize = 6;
    const LOOPS: usize = 3;
    let mut random = Matrices::seeded(SEED);
    for round in 0..200 {
        let before: SMatrix<f64, K, K> = random.matrix();
        let change: SMatrix<f64, K, K> = random.matrix();
        let distance = 10.0_f64.powf(-2.0 - 4.0 * random.number().abs());
        let folded = random.number() < 0.0;
        let mut factor = SMatrix::<f64, K, K>::identity() + change * 1e-4;
        for i in 0..LOOPS {
            for j in 0..K {
                factor[(i, j)] *= if folded { -distance } else { distance };
            }
            for j in 0..i {
                factor[(i, j)] = 4.0 * distance * random.number();
            }
        }
        let (mut numbers, mut indices) = ([0.0; 8 * K * K], [0; 4 * K]);
        let workspace = Workspace::new(&mut numbers, &mut [], &mut indices);
        let [before, after] = [before, before * factor].map(|matrix| block(&matrix, &workspace));
        let changes = after.sign_changes_from(&before, &workspace);
        assert_eq!(changes, if folded { LOOPS } else { 0 }, "round {round}");
    }
}

/// Eliminates a random system of `N` rows, the last constraint row of which is nearly a
/// combination of the others, and checks what is told of it.
fn check_frame<const N: usize>(
    random: &mut Matrices,
    weak: f64,
    determinant: fn(&SMatrix<f64, N, N>) -> f64,
) {
    let constraints = N - 1;
    let mut matrix: SMatrix<f64, N, N> = random.matrix();
    let mut last = matrix.row(constraints - 1) * weak;
    for row in 0..constraints - 1 {
        last += matrix.row(row) * random.number();
    }
    matrix.set_row(constraints - 1, &last);
    let (places, rows): ([usize; N], [usize; N]) = (column(|i| i), column(|i| i));
    let (mut numbers, mut indices) = ([[0.0; N]; 16], [[0; N]; 16]);
    let (numbers, indices) = (numbers.as_flattened_mut(), indices.as_flattened_mut());
    let mut more = vec![0.0; 8 * N * N];
    let workspace = Workspace::new(numbers, &mut more, indices);
    let mut frame = Frame::new(&places, constraints, &workspace);
    let parts = Matrix {
        entries: matrix.as_slice(),
        rows: &rows[..constraints],
        factors: &[1.0; N],
    };
    let column: [f64; N] = column(|j| matrix[(constraints, j)]);
    let mut x = [0.0; N];
    let right: SVector<f64, N> = random.matrix();
    let mut orders = None;
    for _ in 0..2 {
        frame.set_rows(parts, &column, &[1.0; N]);
        match &orders {
            None => frame.factorise(constraints, 1e-3).unwrap(),
            Some(like) => frame.factorise_like(like).unwrap(),
        }
        assert_eq!(
            frame.block().size(),
            usize::from(weak < 1e-3),
            "{N}, {weak}"
        );
        frame.solve(Right::Given(right.as_slice()), &[1.0; N], &mut x);
        let rest = matrix * SVector::from(x) - right;
        assert!(rest.amax() < 1e-9 / weak, "{N}, {weak}: {rest}");
        let determinant = determinant(&matrix);
        assert!((frame.determinant() - determinant).abs() < 1e-12);
        assert_eq!(frame.is_negative(), determinant < 0.0);
        frame.solve_independent(Right::Given(right.as_slice()), &[1.0; N], &mut x);
        let rest = matrix * SVector::from(x) - right;
        assert!(rest.fixed_rows::<1>(0).amax() < 1e-9);
        orders = Some(frame.eliminated(&workspace));
    }
}

#[test]
fn frames_of_any_size_solve_and_tell_the_determinant() {
    let mut random = Matrices::seeded(SEED);
    for weak in [1.0, 1e-5] {
        check_frame::<3>(&mut random, weak, SMatrix::determinant);
        check_frame::<5>(&mut random, weak, SMatrix::determinant);
        check_frame::<8>(&mut random, weak, SMatrix::determinant);
        check_frame::<9>(&mut random, weak, SMatrix::determinant);
    }
}

/// Completes `K` rows, each with entries in the columns next to its place, half of which are
/// nearly combinations of the others, and checks what is told of them.
fn check_completion<const N: usize, const K: usize>(random: &mut Matrices, weak: f64) {
    let mut rows: SMatrix<f64, N, K> = random.matrix();
    for (row, mut entries) in rows.column_iter_mut().enumerate() {
        let near = row..=row + N - K + 1;
        let far = entries.iter_mut().enumerate();
        let far = far.filter(|(column, _)| !near.contains(column));
        far.for_each(|(_, entry)| *entry = 0.0);
    }
    for row in (1..K).step_by(2) {
        let near = rows.column(row - 1) * random.number() + rows.column(row) * weak;
        rows.set_column(row, &near);
    }
    let mut vectors = rows;
    orthogonalised(&mut vectors, &mut SMatrix::identity()).unwrap();
    let least = vectors.column(K - 1).norm();

    let (mut numbers, mut indices) = (vec![0.0; 4 * N * N], vec![0; 7 * N]);
    let mut more = vec![0.0; 4 * N];
    let workspace = Workspace::new(&mut numbers, &mut more, &mut indices);
    let (places, ones): ([usize; N], [f64; N]) = (column(|i| i), [1.0; N]);
    let mut frame = Frame::new(&places, N, &workspace);
    frame.clear();
    for row in 0..K {
        frame.set_row(row, rows.column(row).as_slice());
    }
    frame.complete(K, 0.1).unwrap();
    let mut x = [0.0; N];
    let bound = frame.least_singular_value(K, &ones, &mut x);
    assert!(
        bound <= least * (1.0 + 1e-9) && bound > least * 1e-2,
        "{N}, {K}, {weak}: {bound} is no bound of {least}"
    );
    for row in 0..N {
        frame.solve(Right::Unit(row), &ones, &mut x);
        let mut image = rows.transpose() * SVector::from(x);
        if row < K {
            image[row] -= 1.0;
        }
        let size = SVector::from(x).norm();
        assert!(
            size > 0.5 && image.amax() < 1e-13 * size.max(1.0),
            "{N}, {K}, {weak}, {row}: {image}"
        );
    }
}

#[test]
fn completed_rows_bound_their_singular_values_and_leave_the_null_space() {
    let mut random = Matrices::seeded(SEED);
    for weak in [1.0, 1e-3, 1e-8] {
        check_completion::<4, 3>(&mut random, weak);
        check_completion::<8, 5>(&mut random, weak);
        check_completion::<12, 11>(&mut random, weak);
        check_completion::<24, 20>(&mut random, weak);
        check_completion::<40, 40>(&mut random, weak);
    }
}
