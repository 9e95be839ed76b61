//! Ratios of masses and of lengths.

use crate::case::{Case, Wanted};

const MASSES: Case = Case {
    kind: "Ratios of masses",
    ..Case::USUAL
};
const LENGTHS: Case = Case {
    kind: "Ratios of lengths",
    ..Case::USUAL
};
const DOUBLE: Case = Case {
    mechanism: "double_pendulum",
    ..MASSES
};
const CRANK: Case = Case {
    mechanism: "slider_crank",
    ..MASSES
};
const LOOP: Case = Case {
    mechanism: "four_bar",
    ..MASSES
};

/// The cases.
pub const CASES: &[Case] = &[
    DOUBLE.with("lower arm of 1e-8 kg", &[("m2", 1e-8), ("J2", 1e-9)]),
    DOUBLE.with("lower arm of 1e8 kg", &[("m2", 1e8), ("J2", 1e7)]),
    DOUBLE.with("upper arm of 1e-8 kg", &[("m1", 1e-8), ("J1", 1e-9)]),
    DOUBLE.with("upper arm of 1e8 kg", &[("m1", 1e8), ("J1", 1e7)]),
    CRANK.with("slider of 1e-8 kg", &[("m3", 1e-8)]),
    CRANK.with("slider of 1e8 kg", &[("m3", 1e8)]),
    CRANK.with("crank of 1e8 kg", &[("m1", 1e8), ("J1", 1e7)]),
    LOOP.with("coupler of 1e-8 kg", &[("m2", 1e-8), ("J2", 2e-10)]),
    LOOP.with("coupler of 1e-6 kg", &[("m2", 1e-6), ("J2", 2e-8)]),
    LOOP.with("coupler of 1e-4 kg", &[("m2", 1e-4), ("J2", 2e-6)]),
    LOOP.with("coupler of 1e4 kg", &[("m2", 1e4), ("J2", 2e2)]),
    LOOP.with("coupler of 1e6 kg", &[("m2", 1e6), ("J2", 2e4)]),
    LOOP.with("coupler of 1e8 kg", &[("m2", 1e8), ("J2", 2e6)]),
    LOOP.with("crank of 1e-8 kg", &[("m1", 1e-8), ("J1", 2e-10)]),
    LOOP.with("crank of 1e8 kg", &[("m1", 1e8), ("J1", 2e6)]),
    LOOP.with("rocker of 1e-8 kg", &[("m3", 1e-8), ("J3", 2e-10)]),
    Case {
        what: "rocker of 1e8 kg",
        set: &[("m3", 1e8), ("J3", 2e6)],
        // Of sixteen digits, eight belong to the light parts.
        wanted: Wanted::Right {
            energy: 1e-6,
            end: 1e-6,
        },
        ..LOOP
    },
    Case {
        what: "rod of 1e-8 kg, through dead centres",
        set: &[("m2", 1e-8), ("J2", 2e-10)],
        until: 4.0,
        ..CRANK
    },
    Case {
        what: "rod of 1e-5 kg, through dead centres",
        set: &[("m2", 1e-5), ("J2", 2e-7)],
        until: 4.0,
        ..CRANK
    },
    Case {
        what: "rod of 1e5 kg, through dead centres",
        set: &[("m2", 1e5), ("J2", 2e4)],
        until: 4.0,
        ..CRANK
    },
    Case {
        what: "rod of 1e8 kg, through dead centres",
        set: &[("m2", 1e8), ("J2", 2e6)],
        until: 4.0,
        ..CRANK
    },
    Case {
        what: "crank of 1e-8 kg, through dead centres",
        set: &[("m1", 1e-8), ("J1", 2e-10)],
        until: 4.0,
        ..CRANK
    },
    Case {
        what: "lower arm of 1e-6 m",
        mechanism: "double_pendulum",
        set: &[("L2", 1e-6), ("J2", 1e-13)],
        until: 0.1,
        wanted: Wanted::Balanced { energy: 1e-8 },
        ..LENGTHS
    },
    Case {
        what: "lower arm of 1e6 m",
        mechanism: "double_pendulum",
        set: &[("L2", 1e6), ("J2", 1e11)],
        ..LENGTHS
    },
    Case {
        what: "crank of 1e-6 m",
        mechanism: "slider_crank",
        set: &[("L1", 1e-6)],
        ..LENGTHS
    },
    Case {
        what: "rod of 1e6 m",
        mechanism: "slider_crank",
        set: &[("L2", 1e6), ("J2", 1e11)],
        ..LENGTHS
    },
    Case {
        what: "crank of 1e6 m on a rod of 0.5 m",
        mechanism: "slider_crank",
        set: &[("L1", 1e6)],
        wanted: Wanted::Refused {
            words: &["L1*sin(q1) = L2*sin(q2)", "is off by", "q1"],
        },
        ..LENGTHS
    },
    Case {
        what: "pendulum of 1e-6 m",
        mechanism: "point_pendulum",
        set: &[("L", 1e-6)],
        until: 0.01,
        tolerance: 1e-13,
        wanted: Wanted::Balanced { energy: 1e-6 },
        ..LENGTHS
    },
    Case {
        what: "pendulum of 1e6 m",
        mechanism: "point_pendulum",
        set: &[("L", 1e6)],
        ..LENGTHS
    },
];
