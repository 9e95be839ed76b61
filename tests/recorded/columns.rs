//! Accelerations, inputs, and the reactions of constraints that have names.

use crate::rows::{methods, record};
use bricard_driver::Column;
use bricard_recorded::doubled::Doubled;
use bricard_recorded::hinged::Hinged;
use bricard_recorded::stuck::Stuck;
use bricard_runtime::{DynamicsError, Mechanism, Options, Solver, State, nalgebra::SVector};

const M: f64 = 3.0;
const L: f64 = 0.8;
const G: f64 = 9.81;

#[test]
fn a_pin_carries_what_moves_the_rod() {
    let columns = [
        Column::Output(0),
        Column::Output(1),
        Column::Output(2),
        Column::Multiplier(0),
        Column::Multiplier(1),
        Column::Acceleration(2),
    ];
    for options in methods(1.0) {
        let rows = record::<_, 3, 2>(Hinged::default(), options, &columns);
        let names = [
            "q",
            "der(q)",
            "a[0]",
            "a[1]",
            "spin",
            "reaction(pin).x",
            "reaction(pin).y",
            "der(der(q))",
        ];
        for [q, w, a_x, a_y, spin, pin_x, pin_y, column] in rows.each(names) {
            let near = |found: f64, wanted: f64| {
                let method = options.method;
                assert!(
                    (found - wanted).abs() < 1e-9,
                    "{method}: {found}, not {wanted}"
                );
            };
            let exact = -1.5 * G / L * q.cos();
            near(spin, exact);
            near(column, exact);
            near(a_x, L / 2.0 * (-exact * q.sin() - w * w * q.cos()));
            near(a_y, L / 2.0 * (exact * q.cos() - w * w * q.sin()));
            // What the rod exerts on the pin.
            near(pin_x, -M * a_x);
            near(pin_y, -M * (a_y + G));
        }
    }
}

#[test]
fn multipliers_are_named_after_their_constraints_with_units() {
    let structure = Mechanism::<f64, 3, 2>::structure(&Hinged::<f64>::default());
    let named: Vec<_> = structure
        .multipliers
        .iter()
        .map(|m| (m.quantity.name, m.quantity.unit, m.row))
        .collect();
    assert_eq!(
        named,
        [("reaction(pin).x", "N", 0), ("reaction(pin).y", "N", 1)]
    );
}

#[test]
fn how_redundant_constraints_share_a_reaction_is_not_told() {
    let mechanism = Doubled::default();
    let start = State::new(0.0, SVector::zeros(), SVector::from([1.0, 0.0, 0.0]));
    let mut solver = Solver::<f64, 3, 3>::new(Default::default());
    let shared = solver
        .on(&mechanism)
        .multipliers(&start)
        .expect("a multiplier");
    assert_eq!(shared[..2], [None, None]);
    let floor = shared[2].expect("that of the floor is determined");
    assert!((floor + 2.0 * G).abs() < 1e-13, "{floor}");

    let options = Options::dp5(1.0, 1e-9);
    let rows = record::<_, 3, 3>(mechanism, options, &[Column::Multiplier(2)]);
    assert!(rows.reached.error.is_none());
    let failure = std::panic::catch_unwind(|| {
        record::<_, 3, 3>(Doubled::default(), options, &[Column::Multiplier(0)])
    });
    let rows = failure.expect("it ends with an error that is told");
    let error = rows.reached.error.expect("the reaction is not determined");
    assert!(error.contains("`once: y = 0` (line 10)"), "{error}");
    assert!(error.contains("how they share their reactions"), "{error}");
    let kind = DynamicsError::SharedReaction {
        t: 0.5,
        row: 0,
        structure: Mechanism::<f64, 3, 3>::structure(&Doubled::<f64>::default()),
    };
    assert_eq!(kind.time(), 0.5);
}

#[test]
fn a_block_that_friction_holds_is_not_accelerated() {
    let columns = [Column::Acceleration(0), Column::Input(0)];
    let rows = record::<_, 1, 0>(Stuck::default(), Options::dp5(2.0, 1e-9), &columns);
    for [t, a, draw] in rows.each(["t", "der(der(x))", "draw"]).into_iter().skip(1) {
        let wanted = if t <= 1.0 { 0.0 } else { (t - 1.0) / 2.0 };
        assert!((a - wanted).abs() < 1e-12, "{a} at {t}");
        assert!((draw - t).abs() < 1e-15);
    }
    assert_eq!(rows.names().len(), 5);
}
