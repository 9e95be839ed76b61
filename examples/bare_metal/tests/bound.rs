//! The work of a tick is bounded, at whatever speed singular positions are passed.

use bare_metal::{Loop, MOST_EVALUATIONS};
use bricard_runtime::Real;

/// Ticks at each speed: two seconds.
const TICKS: u32 = 2000;

/// The most evaluations of a tick at many speeds, and how many ticks were next to a
/// singular position.
fn most<T: Real>() -> (u32, u64) {
    let (mut most, mut beside) = (0, 0);
    for tenths in (-300..=300).step_by(7) {
        let speed = f64::from(tenths) / 10.0;
        let mut control = Loop::<T>::new(speed).expect("the engine can be assembled");
        for tick in 0..TICKS {
            let before = control.beside();
            match control.tick() {
                Ok(evaluations) => most = most.max(evaluations),
                Err(error) => panic!("tick {tick} at {speed} rad/s: {error}"),
            }
            beside += u64::from(control.beside() > before);
        }
        let [crank, rod, slider, ..] = control.state();
        let open = (crank.cos() / 2.0 + rod.cos() / 2.0 - slider).abs();
        let round_off = T::EPSILON.to_f64() * (1.0 + crank.abs()) * 8.0;
        assert!(
            open < round_off,
            "the loop is open by {open:e} m at {speed} rad/s"
        );
    }
    (most, beside)
}

#[test]
fn no_tick_takes_more_than_is_granted_at_any_speed_in_either_precision() {
    for (most, beside) in [most::<f64>(), most::<f32>()] {
        assert!(
            beside > 1000,
            "only {beside} ticks next to singular positions"
        );
        assert!(2 * most < MOST_EVALUATIONS, "{most} evaluations in a tick");
    }
}
