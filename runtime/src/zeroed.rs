//! Buffers that begin as zeros, and know which mechanism filled them last.
//!
//! In:  the fields of a buffer.
//! Out: its beginning, and what becomes of it when another mechanism fills it.

use crate::Real;

/// Makes everything NaN that isn't zero.
pub(crate) fn spoil<'a, T: Real>(entries: impl IntoIterator<Item = &'a mut T>) {
    for entry in entries {
        if *entry != T::zero() {
            *entry = T::from_f64(f64::NAN);
        }
    }
}

macro_rules! zeroed {
    ($name:ident { $($field:ident),* } $($sides:ident)?) => {
        impl<T: Real, const N: usize, const R: usize> Default for $name<T, N, R> {
            fn default() -> Self {
                Self {
                    $($field: SMatrix::zeros(),)*
                    $($sides: Sides::FREE,)?
                    filled: None,
                }
            }
        }

        impl<T: Real, const N: usize, const R: usize> $name<T, N, R> {
            /// Whether the mechanism of a structure filled it last.
            #[inline(always)]
            pub fn is_filled_by(&self, structure: &'static Structure) -> bool {
                self.filled.is_some_and(|known| ptr::eq(known, structure))
            }

            /// Becomes zeros that the mechanism of a structure is about to fill.
            #[cold]
            #[inline(never)]
            pub fn clear(&mut self, structure: &'static Structure) {
                $(self.$field.fill(T::zero());)*
                self.filled = Some(structure);
            }

            /// Becomes NaN wherever it is not zero. Whoever fills it next fills all of it, what
            /// is constant included.
            #[cold]
            #[inline(never)]
            pub(crate) fn spoil(&mut self) {
                $(spoil(&mut self.$field);)*
                self.filled = None;
            }
        }
    };
}
pub(crate) use zeroed;
