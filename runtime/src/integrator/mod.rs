//! Steps through time.
//!
//! In:  a [`System`], a state.
//! Out: [`Step`]: the state one accepted step later, and the motion between.
//!
//! | method | order | interpolant | step |
//! |---|---|---|---|
//! | [`Rk4`] | 4 | Hermite | fixed |
//! | [`Dp5`] | 5(4) | order 4 | fixed or adaptive |
//! | [`Dop853`] | 8(5,3) | order 7 | fixed or adaptive |
//! | [`Radau5`] | 5(3), L-stable | order 3 | fixed or adaptive |
//! | [`Radau9`] | 9(5), L-stable | order 5 | fixed or adaptive |
//!
//! Not here: what is done with the steps ([`crate::simulate`]).

mod classical;
mod collocation;
mod control;
mod dop853;
mod error;
mod explicit;
mod factors;
mod interpolant;
mod jacobian;
mod lu;
mod method;
mod methods;
mod newton;
mod radau;
mod rule;
mod stages;
mod step;
mod step_control;
mod tableau;

pub use classical::Rk4;
pub(crate) use control::SMALLEST_STEP;
pub use control::Tolerance;
pub use error::IntegrateError;
pub(crate) use explicit::Explicit;
pub use method::Method;
pub use methods::{Dop853, Dp5, Radau5, Radau9};
pub(crate) use methods::{dop853, dp5, radau5, radau9};
pub(crate) use radau::Radau;
pub use step::Step;
pub(crate) use step_control::{Controlled, Inside};

use crate::{Real, State, System};

/// A method that makes steps.
pub trait Integrator<T: Real, const N: usize> {
    /// Makes one accepted step from `state` towards the time `bound` (s), and
    /// never beyond it. Methods of fixed step go there at once, adaptive ones as
    /// far as their tolerance allows. The end of the step is projected.
    ///
    /// If `state` is the end of the previous step, the acceleration there is
    /// taken from it; a system whose inputs or parameters changed in between
    /// needs a `forget` first.
    ///
    /// # Errors
    ///
    /// An [`IntegrateError`] that carries the time; the integrator may be used
    /// again from any state.
    fn step<Y: System<T, N> + ?Sized>(
        &mut self,
        system: &mut Y,
        state: &State<T, N>,
        bound: T,
    ) -> Result<&Step<T, N>, IntegrateError<T>>;
}
