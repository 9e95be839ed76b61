//! Starts on and next to singular positions, and starts that contradict.

use crate::case::{Case, Wanted};
use core::f64::consts::FRAC_PI_2;

const SINGULAR: Case = Case {
    kind: "Starts on and next to singular positions",
    ..Case::USUAL
};
const BARS: Case = Case {
    mechanism: "n_four_bar",
    ..SINGULAR
};

/// All cranks at an angle, all couplers level: more than is needed, and consistent.
const fn in_line(angle: f64) -> [(&'static str, f64); 5] {
    [
        ("phi[0]", angle),
        ("phi[1]", angle),
        ("phi[2]", angle),
        ("psi[0]", 0.0),
        ("psi[1]", 0.0),
    ]
}

const CRANK: Case = Case {
    mechanism: "slider_crank",
    until: 0.5,
    ..SINGULAR
};
const TRIANGLE: Case = Case {
    mechanism: "four_bar",
    hold: &[("der(q1)", 0.0)],
    until: 0.01,
    ..SINGULAR
};
/// Two degrees of freedom: nothing can be interpolated along the one motion there is.
const HUNG: Case = Case {
    mechanism: "hung_slider",
    until: 0.5,
    ..SINGULAR
};
const CONTRARY: Case = Case {
    kind: "Inconsistent and over-determined starts",
    mechanism: "four_bar",
    ..Case::USUAL
};
const DEGENERATE: Case = Case {
    kind: "Degenerate parameters",
    mechanism: "four_bar",
    ..Case::USUAL
};

/// The cases.
pub const CASES: &[Case] = &[
    BARS.begun("all rods in line, to the last bit", &in_line(FRAC_PI_2)),
    BARS.begun("1e-3 rad before it", &in_line(FRAC_PI_2 - 1e-3)),
    BARS.begun("1e-6 rad before it", &in_line(FRAC_PI_2 - 1e-6)),
    BARS.begun("1e-9 rad before it", &in_line(FRAC_PI_2 - 1e-9)),
    BARS.begun("1e-12 rad before it", &in_line(FRAC_PI_2 - 1e-12)),
    BARS.begun("1e-9 rad behind it", &in_line(FRAC_PI_2 + 1e-9)),
    CRANK.begun(
        "slider–crank upright, turning",
        &[("q1", FRAC_PI_2), ("der(q1)", 3.0)],
    ),
    CRANK.begun(
        "slider–crank 1e-8 rad from upright, turning",
        &[("q1", FRAC_PI_2 - 1e-8), ("der(q1)", 3.0)],
    ),
    CRANK.begun(
        "slider–crank 1e-2 rad from upright, at rest",
        &[("q1", FRAC_PI_2 - 1e-2)],
    ),
    CRANK.begun(
        "slider–crank 1e-5 rad from upright, at rest",
        &[("q1", FRAC_PI_2 - 1e-5)],
    ),
    HUNG.begun(
        "a pendulum on its slider, 1e-2 rad from upright, at rest",
        &[("q1", FRAC_PI_2 - 1e-2)],
    ),
    HUNG.begun(
        "a pendulum on its slider, 1e-4 rad from upright, at rest",
        &[("q1", FRAC_PI_2 - 1e-4)],
    ),
    Case {
        what: "a triangle closed to 1e-5 m, at rest",
        set: &[("L0", 1.15 - 1e-5)],
        wanted: Wanted::Right {
            energy: 1e-7,
            end: 1e-6,
        },
        ..TRIANGLE
    },
    Case {
        what: "a triangle closed to 1e-9 m, at rest",
        set: &[("L0", 1.15 - 1e-9)],
        wanted: Wanted::Refused {
            words: &["nearly depends on the others"],
        },
        ..TRIANGLE
    },
    Case {
        what: "positions that no loop has",
        hold: &[("q1", 0.0), ("q2", 0.0), ("q3", 0.0)],
        wanted: Wanted::Refused {
            words: &["no position near the start", "is off by"],
        },
        ..CONTRARY
    },
    Case {
        what: "a loop that can't be closed",
        set: &[("L0", 2.0)],
        wanted: Wanted::Refused {
            words: &["no position near the start", "is off by"],
        },
        ..CONTRARY
    },
    Case {
        what: "velocities that no motion has",
        hold: &[("der(q1)", 1.0), ("der(q2)", 0.0), ("der(q3)", 0.0)],
        wanted: Wanted::Refused {
            words: &["no velocities", "per second", "der(q1)"],
        },
        ..CONTRARY
    },
    Case {
        what: "more values than degrees of freedom, all consistent",
        mechanism: "n_four_bar",
        hold: &[
            ("phi[0]", 0.5),
            ("phi[1]", 0.5),
            ("phi[2]", 0.5),
            ("psi[0]", 0.0),
        ],
        ..CONTRARY
    },
    DEGENERATE.with("no mass of the coupler", &[("m2", 0.0), ("J2", 0.0)]),
    Case {
        what: "no mass at all",
        set: &[
            ("m1", 0.0),
            ("m2", 0.0),
            ("m3", 0.0),
            ("J1", 0.0),
            ("J2", 0.0),
            ("J3", 0.0),
        ],
        wanted: Wanted::Refused {
            words: &["at t = 0 s", "can move without kinetic energy"],
        },
        ..DEGENERATE
    },
    Case {
        what: "negative masses",
        set: &[
            ("m1", -1.0),
            ("m2", -1.0),
            ("m3", -1.0),
            ("J1", -1.0),
            ("J2", -1.0),
            ("J3", -1.0),
        ],
        wanted: Wanted::Refused {
            words: &["at t = 0 s", "kinetic energy is negative"],
        },
        ..DEGENERATE
    },
    DEGENERATE.with("a crank of no length", &[("L1", 0.0)]),
    Case {
        what: "a coupler of no length",
        mechanism: "slider_crank",
        set: &[("L2", 0.0)],
        hold: &[("q1", 0.0), ("der(q1)", 0.0)],
        ..DEGENERATE
    },
    Case {
        what: "a length that is not a number",
        set: &[("L2", f64::NAN)],
        wanted: Wanted::Refused {
            words: &["t = 0 s", "infinite or NaN"],
        },
        ..DEGENERATE
    },
];
