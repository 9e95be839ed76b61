//! The methods, with fixed steps or with steps that follow a tolerance.
//!
//! In:  a [`Tolerance`], if the steps follow one.
//! Out: [`Dp5`], [`Dop853`], [`Radau5`], [`Radau9`].

use super::collocation::{FIVE, THREE};
use super::explicit::Explicit;
use super::radau::Radau;
use super::step::Step;
use super::step_control::Controlled;
use super::tableau::{DOP853, DP5, RADAU5, RADAU9};
use super::{IntegrateError, Integrator, Tolerance};
use crate::stack::{MaybeBoxed, maybe_boxed, with_room};
use crate::{Real, State, System};

macro_rules! method {
    ($(#[$docs:meta])* $name:ident, $make:ident, $method:ident, $tableau:ident, $new:expr) => {
        $(#[$docs])*
        #[derive(Debug)]
        pub struct $name<T, const N: usize>(MaybeBoxed<Controlled<$method<T, N>, T, N>>);

        /// The method by itself, wherever it will live.
        pub(crate) fn $make<T: Real, const N: usize>(
            tolerance: Option<Tolerance<T, N>>,
        ) -> Controlled<$method<T, N>, T, N> {
            Controlled::new($new(tolerance), &$tableau, tolerance)
        }

        impl<T: Clone, const N: usize> Clone for $name<T, N> {
            fn clone(&self) -> Self {
                with_room::<T, _, N, N>(|| Self(self.0.clone()))
            }

            /// Without allocating.
            fn clone_from(&mut self, other: &Self) {
                with_room::<T, _, N, N>(|| self.0.clone_from(&other.0));
            }
        }

        impl<T: Real, const N: usize> $name<T, N> {
            /// The method with fixed steps: each goes to its bound at once.
            pub fn fixed() -> Self {
                Self::with(None)
            }

            /// The method with steps that follow a tolerance.
            pub fn adaptive(tolerance: Tolerance<T, N>) -> Self {
                Self::with(Some(tolerance))
            }

            fn with(tolerance: Option<Tolerance<T, N>>) -> Self {
                with_room::<T, _, N, N>(|| Self(maybe_boxed(|| $make(tolerance))))
            }

            /// Forgets the derivative at the last step's end, because the system has
            /// changed since; adaptive step control keeps its step size.
            pub fn forget(&mut self) {
                self.0.forget();
            }
        }

        impl<T: Real, const N: usize> Integrator<T, N> for $name<T, N> {
            fn step<Y: System<T, N> + ?Sized>(
                &mut self,
                system: &mut Y,
                state: &State<T, N>,
                bound: T,
            ) -> Result<&Step<T, N>, IntegrateError<T>> {
                self.0.step(system, state, bound)
            }
        }
    };
}

method!(
    /// The pair of orders 5 and 4 of Dormand and Prince: six accelerations a
    /// step, interpolant of order 4.
    Dp5, dp5, Explicit, DP5, |_| Explicit::new(&DP5)
);
method!(
    /// The method of order 8 of Dormand and Prince with Hairer's error estimate:
    /// twelve accelerations a step, three more for the interpolant of order 7.
    Dop853, dop853, Explicit, DOP853, |_| Explicit::new(&DOP853)
);
method!(
    /// The implicit method Radau IIA of order 5, L-stable: for stiff mechanisms,
    /// such as those with hard springs and strong dampers. Each step solves for
    /// three stages at once.
    ///
    /// Between the ends, the cubic polynomials through the stages.
    Radau5, radau5, Radau, RADAU5, |tolerance| Radau::new(&THREE, tolerance)
);
method!(
    /// The implicit method Radau IIA of order 9, L-stable: for stiff mechanisms whose
    /// motion is wanted to many digits. Each step solves for five stages at once.
    ///
    /// Between the ends, the quintic polynomials through the stages.
    Radau9, radau9, Radau, RADAU9, |tolerance| Radau::new(&FIVE, tolerance)
);
