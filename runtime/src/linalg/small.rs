//! Small sizes as constants of the compiler.
//!
//! In:  a size that is data.
//! Out: a call of a function that is generic over the size where it is small: its loops are
//!      unrolled, and no index is checked.

/// `with_size!(n, |N| f::<N>(), g())` calls `f` with the constant `N = n` if `1 ≤ n ≤ 8`, else `g`.
macro_rules! with_size {
    ($size:expr, |$N:ident| $work:expr, $otherwise:expr) => {
        match $size {
            1 => $crate::linalg::small::with_size!(@ $N, 1, $work),
            2 => $crate::linalg::small::with_size!(@ $N, 2, $work),
            3 => $crate::linalg::small::with_size!(@ $N, 3, $work),
            4 => $crate::linalg::small::with_size!(@ $N, 4, $work),
            5 => $crate::linalg::small::with_size!(@ $N, 5, $work),
            6 => $crate::linalg::small::with_size!(@ $N, 6, $work),
            7 => $crate::linalg::small::with_size!(@ $N, 7, $work),
            8 => $crate::linalg::small::with_size!(@ $N, 8, $work),
            _ => $otherwise,
        }
    };
    (@ $N:ident, $number:expr, $work:expr) => {{
        const $N: usize = $number;
        $work
    }};
}
pub(crate) use with_size;
