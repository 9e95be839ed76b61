//! The methods, with fixed steps or with steps that follow a tolerance.
//!
//! In:  a [`Tolerance`], if the steps follow one.
//! Out: [`Dp5`], [`Dop853`], [`Radau5`], [`Radau9`].

use super::explicit::Explicit;
use super::radau::Radau;
use super::step::Step;
use super::step_control::{Controlled, Inside, Trial};
use super::tableau::{DOP853, DP5, RADAU5, RADAU9};
use super::{IntegrateError, Integrator, Tolerance};
use crate::{Real, State, System};

/// Slots of DP5: six stages and the derivative at the end.
const SLOTS_DP5: usize = 7;
/// Slots of DOP853: twelve stages, the derivative at the end, three extra stages.
const SLOTS_DOP853: usize = 16;

macro_rules! method {
    ($(#[$docs:meta])* $name:ident, $method:ty) => {
        $(#[$docs])*
        #[derive(Clone, Debug)]
        pub struct $name<T, const N: usize>(Controlled<$method, T, N>);

        impl<T: Real, const N: usize> $name<T, N> {
            /// Forgets the derivative at the last step's end, because the system has
            /// changed since; adaptive step control keeps its step size.
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
            /// The method with fixed steps: each goes to its bound at once.
            pub fn fixed() -> Self {
                Self(Controlled::fixed($method))
            }

            /// The method with steps that follow a tolerance.
            pub fn adaptive(tolerance: Tolerance<T, N>) -> Self {
                Self(Controlled::adaptive($method, tolerance))
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
            /// The method with fixed steps: each goes to its bound at once.
            pub fn fixed() -> Self {
                Self(Controlled::fixed(Radau::new(&$tableau, None)))
            }

            /// The method with steps that follow a tolerance.
            pub fn adaptive(tolerance: Tolerance<T, N>) -> Self {
                let method = Radau::new(&$tableau, Some(tolerance));
                Self(Controlled::adaptive(method, tolerance))
            }
        }
    };
}

implicit!(Radau5, RADAU5);
implicit!(Radau9, RADAU9);
