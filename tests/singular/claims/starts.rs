//! Starts in singular configurations and beside them are as exact as elsewhere.

use bricard_runtime::{Initial, Interface, Options, Whole, assemble, simulate};
use bricard_singular::descriptions::driven_crank::DrivenCrank;
use bricard_singular::descriptions::equal_slider_crank::EqualSliderCrank;
use bricard_singular::descriptions::parallelogram_pendulum::ParallelogramPendulum;
use bricard_singular::descriptions::sarrus::Sarrus;
use bricard_singular::descriptions::two_loops_apart::TwoLoopsApart;
use bricard_singular::descriptions::two_loops_one_crank::TwoLoopsOneCrank;
use core::f64::consts::{FRAC_PI_2, PI};

/// How far from the singular configuration motions begin (rad).
const DISTANCES: [f64; 13] = [
    3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 3.3e-6, 1e-6, 4e-7, 3e-7, 2.3e-7, 2e-7, 1e-7, 5e-8,
];

/// The position that the constraints admit to round-off has half of the digits there, and the
/// velocity few.
#[test]
fn a_slider_crank_beside_its_dead_centre_begins_on_its_sheet() {
    for distance in DISTANCES.into_iter().flat_map(|d| [d, -d]) {
        let mut mechanism = EqualSliderCrank::<f64>::default();
        mechanism.parameters.p0 = FRAC_PI_2 - distance;
        let (p0, w0) = (mechanism.parameters.p0, mechanism.parameters.w0);
        let mechanism: &dyn Whole<f64, 2, 1> = &mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        assert_eq!((start.q[0], start.v[0]), (p0, w0), "{distance:e}");
        let off = [start.q[1] + p0, (start.v[1] + w0) / w0];
        assert!(
            off.iter().all(|off| off.abs() < 1e-12),
            "{distance:e}: off by {off:?}"
        );
    }
}

#[test]
fn a_parallelogram_with_a_pendulum_beside_its_singular_configuration_begins_on_its_sheet() {
    for distance in DISTANCES.into_iter().flat_map(|d| [d, -d]) {
        let mut mechanism = ParallelogramPendulum::<f64>::default();
        mechanism.parameters.a0 = PI + distance;
        let mechanism: &dyn Whole<f64, 4, 2> = &mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
        let off = [
            start.q[0] - start.q[2],
            start.q[1],
            start.v[0] - start.v[2],
            start.v[1],
        ];
        assert!(
            off.iter().all(|off| off.abs() < 1e-11),
            "{distance:e}: off by {off:?}"
        );
    }
}

/// Length of the cranks of the parallelogram, in those of the coupler.
const RATIO: f64 = 0.4 / 0.7;

/// A parallelogram beside its stretched position, at exact guesses of the crossed branch.
fn crossed(distance: f64, speed: f64) -> (ParallelogramPendulum<f64>, [Initial<f64>; 4]) {
    let mut mechanism = ParallelogramPendulum::<f64>::default();
    (mechanism.parameters.a0, mechanism.parameters.w0) = (distance, speed);
    // The first equation says that r x² + L z² = r y², the second that r x + L z = r y.
    let other = -distance * (1.0 + RATIO) / (1.0 - RATIO);
    let coupler = RATIO * (other - distance);
    let mut values = mechanism.start().q;
    (values[1].value, values[2].value) = (coupler, other);
    (mechanism, values)
}

/// A velocity that nobody gives is no guess: the position tells the branch, as long as it is off
/// the other one.
#[test]
fn a_parallelogram_begins_on_the_crossed_branch_if_its_position_is_on_that() {
    let nearer = [1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
    for distance in DISTANCES[2..].iter().copied().chain(nearer) {
        for (distance, speed) in [(distance, 7.0), (-distance, 7.0), (distance, -3.0)] {
            let (mechanism, positions) = crossed(distance, speed);
            let mechanism: &dyn Whole<f64, 4, 2> = &mechanism;
            let mut start = mechanism.start();
            start.q = positions;
            let start = assemble(mechanism, &start, 0.0).expect("it can be assembled");
            let rates = [
                1.0,
                -2.0 * RATIO / (1.0 - RATIO),
                -(1.0 + RATIO) / (1.0 - RATIO),
            ];
            for (v, rate) in start.v.iter().zip(rates) {
                let off = v / speed - rate;
                let most = 100.0 * distance * distance + 1e-10;
                assert!(off.abs() < most, "{distance:e}: off by {off:e}");
            }
            let options = Options::dop853(0.01, 1e-10);
            let ran = simulate(mechanism, &start, &options, &mut []);
            let end = ran
                .unwrap_or_else(|failure| panic!("{distance:e}: {failure}"))
                .end;
            assert!(
                end.q[1] * end.q[0] < 0.0 && end.q[1].abs() > 0.01,
                "{distance:e}: {}",
                end.q
            );
        }
    }
}

/// Both chains of Sarrus' linkage could fold there, each by itself.
#[test]
fn two_chains_beside_the_position_where_both_could_fold_begin_unfolded() {
    for distance in uneven_distances().chain([1e-8, 1e-9, 1e-10]) {
        if distance.abs() > 1e-3 {
            continue;
        }
        let mut mechanism = Sarrus::<f64>::default();
        mechanism.parameters.a0 = distance;
        let other = (0.4 * distance.sin() / 0.55).asin();
        let mechanism: &dyn Whole<f64, 6, 5> = &mechanism;
        let mut start = mechanism.start();
        for (q, value) in start.q[3..]
            .iter_mut()
            .zip([other, PI - 2.0 * other, other - PI])
        {
            q.value = value;
        }
        let start = assemble(mechanism, &start, 0.0)
            .unwrap_or_else(|error| panic!("{distance:e}: {error}"));
        let [w, da, _, db, ..] = start.v.data.0[0];
        let off = [da / w + 2.0, db / w - 0.4 / 0.55];
        let most = distance * distance + 1e-8;
        assert!(
            off.iter().all(|off| off.abs() < most),
            "{distance:e}: off by {off:?}"
        );
    }
}

/// Distances with all digits, at which guesses are no accidents of rounding.
fn uneven_distances() -> impl Iterator<Item = f64> {
    let uneven = [1.0, 1.140_492_387_502_268_9, 0.820_717_525_347_348];
    let scaled = uneven.map(|factor| DISTANCES.map(|distance| factor * distance));
    scaled.into_iter().flatten().flat_map(|d| [d, -d])
}

#[test]
fn two_loops_on_one_crank_beside_their_singular_configuration_begin_on_their_sheet() {
    for distance in uneven_distances() {
        let mut mechanism = TwoLoopsOneCrank::<f64>::default();
        mechanism.parameters.q0 = distance;
        let w = mechanism.parameters.w0;
        let mechanism: &dyn Whole<f64, 5, 4> = &mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0)
            .unwrap_or_else(|error| panic!("{distance:e}: {error}"));
        let [q, a, f, b, x] = start.q.data.0[0];
        let [v, da, df, db, dx] = start.v.data.0[0];
        assert_eq!((q, v), (distance, w));
        let off = [a, f - q, b + q - PI, x - 1.4 * q.sin()];
        let off_rate = [da, df - v, db + v, dx - 1.4 * v * q.cos()];
        assert!(
            off.iter().chain(&off_rate).all(|off| off.abs() < 1e-11),
            "{distance:e}: off by {off:?} and {off_rate:?}"
        );
    }
}

#[test]
fn of_loops_that_know_nothing_of_one_another_each_begins_on_its_sheet() {
    for distance in uneven_distances() {
        for (q0, s0) in [
            (distance, 1.0),
            (1.0, distance),
            (distance, -0.7 * distance),
        ] {
            let mut mechanism = TwoLoopsApart::<f64>::default();
            (mechanism.parameters.q0, mechanism.parameters.s0) = (q0, s0);
            let (w, ws) = (mechanism.parameters.w0, mechanism.parameters.ws0);
            let mechanism: &dyn Whole<f64, 8, 5> = &mechanism;
            let start = assemble(mechanism, &mechanism.start(), 0.0)
                .unwrap_or_else(|error| panic!("{q0:e}, {s0:e}: {error}"));
            let [q, a, f, s, b, ..] = start.q.data.0[0];
            let [v, da, df, vs, db, ..] = start.v.data.0[0];
            assert_eq!((q, v, s, vs), (q0, w, s0, ws));
            let off = [a, f - q, b + s - PI, da, df - v, db + vs];
            assert!(
                off.iter().all(|off| off.abs() < 1e-11),
                "{q0:e}, {s0:e}: off by {off:?}"
            );
        }
    }
}

/// Where only the time leads away, the velocity tells where to.
#[test]
fn a_driven_crank_begins_in_its_dead_centre_with_either_velocity() {
    for speed in [-3.0, 3.0] {
        let mut mechanism = DrivenCrank::<f64>::default();
        mechanism.parameters.p0 = FRAC_PI_2;
        let mechanism: &dyn Whole<f64, 4, 3> = &mechanism;
        let mut start = mechanism.start();
        start.v[1] = Initial {
            value: speed,
            held: true,
        };
        let start = assemble(mechanism, &start, 0.0).expect("it can be assembled");
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let options = Options::dop853(0.5, tolerance);
            let ran = simulate(mechanism, &start, &options, &mut []);
            let end = ran
                .unwrap_or_else(|failure| panic!("{speed}: {failure}"))
                .end;
            let exact = [FRAC_PI_2 + 1.5, -FRAC_PI_2 + speed / 2.0];
            let off = [end.q[0] - exact[0], end.q[1] - exact[1]];
            assert!(
                off.iter().all(|off| off.abs() < 1e-11),
                "{speed}: off by {off:?}"
            );
        }
    }
}
