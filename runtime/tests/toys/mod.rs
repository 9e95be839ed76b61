//! Systems with closed forms, and mechanisms written by hand.

use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{DynamicsError, State, System};

/// A system given by a function of the state, without constraints.
pub struct Free<F>(pub F);

impl<F, const N: usize> System<f64, N> for Free<F>
where
    F: FnMut(&State<f64, N>) -> SVector<f64, N>,
{
    fn acceleration(
        &mut self,
        state: &State<f64, N>,
    ) -> Result<SVector<f64, N>, DynamicsError<f64>> {
        let a = (self.0)(state);
        match a.iter().all(|x| x.is_finite()) {
            true => Ok(a),
            false => Err(DynamicsError::NotFinite { t: state.t }),
        }
    }

    fn project(&mut self, _state: &mut State<f64, N>) -> Result<(), DynamicsError<f64>> {
        Ok(())
    }
}

/// Kepler's problem, eccentricity `e`, gravitational parameter 1, semi-major
/// axis 1: the start at the pericentre.
pub fn kepler_start(e: f64) -> State<f64, 2> {
    let speed = ((1.0 + e) / (1.0 - e)).sqrt();
    State::new(
        0.0,
        SVector::from([1.0 - e, 0.0]),
        SVector::from([0.0, speed]),
    )
}

/// The acceleration of Kepler's problem.
pub fn kepler(state: &State<f64, 2>) -> SVector<f64, 2> {
    let r = state.q.norm();
    -state.q / (r * r * r)
}

/// The exact state of Kepler's problem, from Kepler's equation.
pub fn kepler_exact(e: f64, t: f64) -> State<f64, 2> {
    let mut anomaly = t + e * t.sin();
    for _ in 0..50 {
        anomaly -= (anomaly - e * anomaly.sin() - t) / (1.0 - e * anomaly.cos());
    }
    let (s, c) = anomaly.sin_cos();
    let (b, rate) = ((1.0 - e * e).sqrt(), 1.0 / (1.0 - e * c));
    State::new(
        t,
        SVector::from([c - e, b * s]),
        SVector::from([-s * rate, b * c * rate]),
    )
}

/// The largest difference between two states, in any component.
pub fn distance<const N: usize>(a: &State<f64, N>, b: &State<f64, N>) -> f64 {
    (a.q - b.q).amax().max((a.v - b.v).amax())
}
