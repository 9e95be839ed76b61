//! The methods, at a fixed pace or at one that follows a tolerance.
//!
//! In:  nothing, or a [`Tolerance`].
//! Out: [`Dp5`], [`Dop853`], [`Radau5`], [`Radau9`].

use super::explicit::Explicit;
use super::pace::{Inside, Paced, Trial};
use super::radau::Radau;
use super::step::Step;
use super::tableau::{DOP853, DP5, RADAU5, RADAU9};
use super::{IntegrateError, Integrator, Tolerance};
use crate::{Real, State, System};

/// Slots of DP5: six stages and the slope at the end.
const SLOTS_DP5: usize = 7;
/// Slots of DOP853: twelve stages, the slope at the end, three extra stages.
const SLOTS_DOP853: usize = 16;

macro_rules! method {
    ($(#[$docs:meta])* $name:ident, $method:ty) => {
        $(#[$docs])*
        #[derive(Clone, Debug)]
        pub struct $name<T, const N: usize>(Paced<$method, T, N>);

        impl<T: Real, const N: usize> $name<T, N> {
            /// Forgets the slope at the last step's end, because the system has
            /// changed since; an adaptive pace keeps its step size.
            pub fn forget(&mut self) {
                self.0.method.forget();
            }

            pub(crate) fn keep(&mut self, inside: Inside) {
                self.0.method.keep(inside);
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

macro_rules! adaptive {
    ($name:ident, $method:expr) => {
        impl<T: Real, const N: usize> $name<T, N> {
            /// The method at a fixed pace: each step goes to its bound at once.
            pub fn fixed() -> Self {
                Self(Paced::fixed($method))
            }

            /// The method at a pace that follows a tolerance.
            pub fn adaptive(tolerance: Tolerance<T, N>) -> Self {
                Self(Paced::adaptive($method, tolerance))
            }
        }
    };
}

method!(
    /// The pair of orders 5 and 4 of Dormand and Prince: six accelerations a
    /// step, interpolant of order 4.
    Dp5, Explicit<T, N, SLOTS_DP5>
);
method!(
    /// The method of order 8 of Dormand and Prince with Hairer's error estimate:
    /// twelve accelerations a step, three more for the interpolant of order 7.
    Dop853, Explicit<T, N, SLOTS_DOP853>
);

adaptive!(Dp5, Explicit::new(&DP5));
adaptive!(Dop853, Explicit::new(&DOP853));

method!(
    /// The implicit method Radau IIA of order 5, L-stable: for stiff mechanisms,
    /// such as those with hard springs and strong dampers. Each step solves for
    /// three stages at once.
    ///
    /// Between the ends, the cubic polynomials through the stages.
    Radau5, Radau<T, N, 3>
);
method!(
    /// The implicit method Radau IIA of order 9, L-stable: for stiff mechanisms whose
    /// motion is wanted to many digits. Each step solves for five stages at once.
    ///
    /// Between the ends, the quintic polynomials through the stages.
    Radau9, Radau<T, N, 5>
);

macro_rules! implicit {
    ($name:ident, $tableau:ident) => {
        impl<T: Real, const N: usize> $name<T, N> {
            /// The method at a fixed pace: each step goes to its bound at once.
            pub fn fixed() -> Self {
                Self(Paced::fixed(Radau::new(&$tableau, None)))
            }

            /// The method at a pace that follows a tolerance.
            pub fn adaptive(tolerance: Tolerance<T, N>) -> Self {
                let method = Radau::new(&$tableau, Some(tolerance));
                Self(Paced::adaptive(method, tolerance))
            }
        }
    };
}

implicit!(Radau5, RADAU5);
implicit!(Radau9, RADAU9);
