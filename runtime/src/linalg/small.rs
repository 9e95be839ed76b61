//! Small sizes, which the compiler is told.
//!
//! In:  a size that is data.
//! Out: something that is done with a constant in its place where it is small: loops are
//!      written out, and no index that is in sight is checked.

/// Does something with a constant if a size is small, of which there is a copy for each, and
/// something else if not.
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
