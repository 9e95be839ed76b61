//! States of the first order move as their closed forms, with every method.

use crate::rows::{methods, record};
use bricard_driver::Column;
use bricard_recorded::driven::{Driven, Parameters};
use bricard_recorded::lag::Lag;
use bricard_recorded::servo::Servo;
use bricard_runtime::{Mechanism, Options};

/// Methods are asked for ten digits.
const TOLERANCE: f64 = 1e-8;

#[test]
fn a_lag_goes_to_its_goal_and_pushes() {
    let (m, time, goal, begin): (f64, f64, f64, f64) = (2.0, 0.5, 3.0, 1.0);
    let columns = [
        Column::Output(0),
        Column::Output(1),
        Column::Output(2),
        Column::Acceleration(0),
        Column::Acceleration(1),
    ];
    for options in methods(2.0) {
        let rows = record::<_, 2, 0>(Lag::default(), options, &columns);
        let names = [
            "t",
            "x",
            "der(x)",
            "f",
            "a",
            "rise",
            "der(der(x))",
            "der(f)",
        ];
        for [t, x, v, f, a, rise, column, rate] in rows.each(names) {
            let fading = (begin - goal) * (-t / time).exp();
            let near = |found: f64, wanted: f64| {
                let method = options.method;
                assert!(
                    (found - wanted).abs() < TOLERANCE,
                    "{method} at {t}: {found}"
                );
            };
            near(f, goal + fading);
            near(v, (goal * t + time * ((begin - goal) - fading)) / m);
            let twice =
                goal * t * t / 2.0 + time * ((begin - goal) * t - time * (begin - goal - fading));
            near(x, twice / m);
            near(a, f / m);
            near(rise, (goal - f) / time);
            assert_eq!(
                [a, rise].map(f64::to_bits),
                [column, rate].map(f64::to_bits)
            );
        }
    }
}

#[test]
fn the_energy_of_a_mechanism_with_states_is_that_of_its_coordinates() {
    let columns = [Column::Kinetic, Column::Energy];
    let options = Options::dp5(2.0, 1e-10);
    let rows = record::<_, 2, 0>(Lag::default(), options, &columns);
    for [v, kinetic, energy] in rows.each(["der(x)", "kinetic", "energy"]) {
        assert!((kinetic - v * v).abs() < 1e-14);
        assert!((energy - v * v).abs() < 1e-14);
    }
    // What the state does is in the balance.
    assert!(rows.reached.energy_error < TOLERANCE);
    assert!(!Mechanism::<f64, 2, 0>::structure(&Lag::<f64>::default()).conservative);
}

#[test]
fn a_controller_that_integrates_has_the_roots_of_its_closed_loop() {
    for options in methods(3.0) {
        let rows = record::<_, 2, 0>(Servo::default(), options, &[Column::Input(0)]);
        for [t, x, wound, u] in rows.each(["t", "x", "wound", "u"]) {
            // e''' + 6 e'' + 11 e' + 6 e = 0 with e(0) = 1/2, e'(0) = 0 and, since the
            // force at the beginning is 11/2, e''(0) = -11/2.
            let [a, b, c] = [-1.25, 4.0, -2.25].map(|x: f64| x);
            let parts = [a * (-t).exp(), b * (-2.0 * t).exp(), c * (-3.0 * t).exp()];
            let error: f64 = parts.iter().sum();
            let method = options.method;
            assert!((0.5 - x - error).abs() < TOLERANCE, "{method} at {t}: {x}");
            let integral = a * (1.0 - (-t).exp())
                + b / 2.0 * (1.0 - (-2.0 * t).exp())
                + c / 3.0 * (1.0 - (-3.0 * t).exp());
            assert!(
                (wound - integral).abs() < TOLERANCE,
                "{method} at {t}: {wound}"
            );
            let force = -parts[0] - 4.0 * parts[1] - 9.0 * parts[2];
            assert!((u - force).abs() < 20.0 * TOLERANCE, "{method} at {t}: {u}");
        }
    }
}

#[test]
fn a_state_goes_through_singular_configurations_with_its_mechanism() {
    let free = Driven {
        parameters: Parameters {
            k: 0.0,
            ..Parameters::default()
        },
    };
    for options in methods(2.0) {
        let driven = record::<_, 4, 2>(Driven::default(), options, &[Column::Rank]);
        let alone = record::<_, 4, 2>(free, options, &[Column::Rank]);
        assert!(driven.reached.error.is_none(), "{:?}", driven.reached.error);
        assert!(!driven.reached.passages.is_empty());
        let names = ["t", "q[0]", "der(q[0])", "i"];
        for ([t, q, v, i], [_, q_free, v_free, _]) in
            driven.each(names).into_iter().zip(alone.each(names))
        {
            let method = options.method;
            let current = 4.0 * (1.0 - (-t / 0.3).exp());
            assert!((i - current).abs() < TOLERANCE, "{method} at {t}: {i}");
            assert!(
                (q - q_free).abs() < 1e-6,
                "{method} at {t}: {q} and {q_free}"
            );
            assert!(
                (v - v_free).abs() < 1e-6,
                "{method} at {t}: {v} and {v_free}"
            );
        }
    }
}
