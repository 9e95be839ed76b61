//! The same mechanisms, written by hand: what the generated code is measured against.
//!
//! In:  states.
//! Out: terms, accelerations and projected steps of two mechanisms with constant
//!      parameters.
//!
//! Everything a careful programmer would do: sines inlined and in batches, only entries
//! that vary, factorisations without zeros, no rank decisions. At a singular position
//! this code divides by zero.

mod double_four_bar;
mod sine;
mod slider_crank;
mod solve;
mod step;

pub use double_four_bar::DoubleFourBar;
pub use slider_crank::SliderCrank;
pub use step::step;

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{State, Terms};

/// What is written by hand for one mechanism.
pub trait ByHand<const N: usize, const R: usize> {
    /// `M`, `p₁`, `A`, `p₂`.
    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>);
    /// `g`.
    fn residual(&self, state: &State<f64, N>) -> SVector<f64, R>;
    /// `q̈`.
    fn acceleration(&self, state: &State<f64, N>) -> SVector<f64, N>;
    /// The least `Δq` and `Δq̇` in the kinetic metric that close the constraints, to
    /// first order.
    fn correction(&self, state: &State<f64, N>) -> (SVector<f64, N>, SVector<f64, N>);
}

#[cfg(test)]
mod tests {
    use super::{ByHand, DoubleFourBar, SliderCrank, step};
    use crate::mechanism::{double_four_bar_folded, slider_crank_folded};
    use bricard_runtime::{
        Acceleration, Correction, Interface, Mechanism, Method, Settings, State, StepControl,
        Stepper, Terms, assemble,
    };

    /// What round-off may come to.
    const SAME: f64 = 1e-12;

    fn check<H, M, const N: usize, const R: usize>(by_hand: &H, generated: &M)
    where
        H: ByHand<N, R>,
        M: Mechanism<f64, N, R> + Interface<f64, N>,
    {
        let step_control = StepControl::Fixed { step: 0.01 };
        let mut stepper =
            Stepper::<f64, N, R>::new(Method::Rk4, step_control, Settings::default()).unwrap();
        let start = assemble(generated, &generated.start(), 0.0).unwrap();
        let (mut state, mut same) = (start, start);
        for _ in 0..30 {
            compare(by_hand, generated, &state);
            stepper.step(generated, &mut state, 0.01).unwrap();
            same = step(by_hand, &same, 0.01);
            assert!((state.q - same.q).amax() < SAME);
            assert!((state.v - same.v).amax() < SAME);
        }
    }

    fn compare<H, M, const N: usize, const R: usize>(
        by_hand: &H,
        generated: &M,
        state: &State<f64, N>,
    ) where
        H: ByHand<N, R>,
        M: Mechanism<f64, N, R>,
    {
        let (mut ours, mut theirs) = (Terms::<f64, N, R>::default(), Terms::<f64, N, R>::default());
        by_hand.terms(state, &mut ours);
        generated.terms(state, &mut theirs);
        assert!((ours.mass - theirs.mass).amax() < SAME);
        assert!((ours.force - theirs.force).amax() < SAME);
        assert!((ours.jacobian - theirs.jacobian).amax() < SAME);
        assert!((ours.bias - theirs.bias).amax() < SAME);
        let mut regular = Acceleration::<f64, N, R>::default();
        assert!(generated.acceleration(state, &mut regular));
        assert!((by_hand.acceleration(state) - regular.acceleration).amax() < 1e3 * SAME);
        let mut off = *state;
        off.q[0] += 1e-3;
        let mut correction = Correction::<f64, N, R>::default();
        assert!(generated.correction(&off, &mut correction));
        assert!((by_hand.residual(&off) - correction.residual).amax() < SAME);
        let (position, _) = by_hand.correction(&off);
        assert!((position - correction.position).amax() < SAME);
        // The generated code corrects the velocity as it is needed after that.
        let mut fast = *state;
        fast.v[0] += 1e-3;
        assert!(generated.correction(&fast, &mut correction));
        let (_, velocity) = by_hand.correction(&fast);
        assert!((velocity - correction.velocity).amax() < SAME);
    }

    #[test]
    fn the_slider_crank_by_hand_is_the_generated_one() {
        let generated = slider_crank_folded::slider_crank::SliderCrank::default();
        check::<_, _, 3, 2>(&SliderCrank, &generated);
    }

    #[test]
    fn the_double_four_bar_by_hand_is_the_generated_one() {
        let generated = double_four_bar_folded::double_four_bar::DoubleFourBar::default();
        check::<_, _, 5, 4>(&DoubleFourBar, &generated);
    }
}
