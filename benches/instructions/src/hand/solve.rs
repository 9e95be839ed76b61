//! Small symmetric systems.

/// Solves `S x = b` for each right-hand side by `S = L D Lᵀ`; the lower triangle of `S`
/// is overwritten.
#[inline(always)]
pub fn solve<const K: usize, const B: usize>(s: &mut [[f64; K]; K], b: &mut [[f64; K]; B]) {
    for j in 0..K {
        let inverse = 1.0 / s[j][j];
        for i in j + 1..K {
            let l = s[i][j] * inverse;
            for k in j + 1..=i {
                s[i][k] -= l * s[k][j];
            }
            for right in b.iter_mut() {
                right[i] -= l * right[j];
            }
        }
    }
    for right in b.iter_mut() {
        for j in (0..K).rev() {
            for i in j + 1..K {
                right[j] -= s[i][j] * right[i];
            }
            right[j] /= s[j][j];
        }
    }
}
