//! What is regular is not taken to be singular.

use bricard_runtime::Whole;
use bricard_runtime::{Options, assemble, simulate};
use bricard_singular::descriptions::car_axis::CarAxis;

/// The car axis at 3 s: coordinates and velocities, from the Test Set for IVP Solvers
/// (Mazzia & Magherini, 2008), computed there with PSIDE at 1e-16.
const CAR_AXIS: [f64; 8] = [
    0.4934557842755629e-1,
    0.4969894602303324,
    1.04174252488540,
    0.3739110272652214,
    -0.7705836840321485e-1,
    0.7446866596327776e-2,
    0.1755681574942899e-1,
    0.770341043779403,
];

#[test]
fn the_car_axis_ends_where_the_test_set_says() {
    let axis: &dyn Whole<f64, 4, 2> = &CarAxis::<f64>::default();
    let start = assemble(axis, &axis.start(), 0.0).expect("it can be assembled");
    let options = Options::dop853(3.0, 1e-11);
    let summary = simulate(axis, &start, &options, &mut []).expect("it runs to its end");
    let found = summary.end.q.iter().chain(summary.end.v.iter());
    for (found, wanted) in found.zip(CAR_AXIS) {
        assert!((found - wanted).abs() < 1e-7, "{found} is not {wanted}");
    }
}
