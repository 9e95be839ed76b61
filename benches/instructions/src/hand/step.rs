//! A projected step.

use super::ByHand;
use bricard_runtime::State;
use bricard_runtime::nalgebra::SVector;

/// Where a correction of the position is below this, the velocity is corrected as well:
/// what the constraints make of it then changes by round-off only.
const LAST: f64 = 1e-13;
/// Corrections at most.
const MOST: usize = 10;

/// Classical Runge–Kutta, then positions and velocities back onto the constraints.
pub fn step<H: ByHand<N, R>, const N: usize, const R: usize>(
    mechanism: &H,
    start: &State<f64, N>,
    h: f64,
) -> State<f64, N> {
    let at = |t: f64, v: &SVector<f64, N>, a: &SVector<f64, N>| State {
        t: start.t + t,
        q: start.q + v * t,
        v: start.v + a * t,
    };
    let a1 = mechanism.acceleration(start);
    let second = at(0.5 * h, &start.v, &a1);
    let a2 = mechanism.acceleration(&second);
    let third = at(0.5 * h, &second.v, &a2);
    let a3 = mechanism.acceleration(&third);
    let fourth = at(h, &third.v, &a3);
    let a4 = mechanism.acceleration(&fourth);
    let sixth = h / 6.0;
    let mut end = State {
        t: start.t + h,
        q: start.q + (start.v + (second.v + third.v) * 2.0 + fourth.v) * sixth,
        v: start.v + (a1 + (a2 + a3) * 2.0 + a4) * sixth,
    };
    for _ in 0..MOST {
        let (position, velocity) = mechanism.correction(&end);
        let size = position.amax();
        end.q += position;
        if size < LAST {
            end.v += velocity;
            break;
        }
    }
    end
}
