//! Speeds at which round-off dominates, and forces without bound.

use crate::case::{Case, Wanted};

const SPEEDS: Case = Case {
    kind: "Speeds",
    mechanism: "point_pendulum",
    wanted: Wanted::Balanced { energy: 1e-5 },
    ..Case::USUAL
};
const INPUTS: Case = Case {
    kind: "Inputs and forces",
    ..Case::USUAL
};

/// The cases.
pub const CASES: &[Case] = &[
    Case {
        what: "1e3 m/s for 0.1 s",
        hold: &[("der(y)", 1e3)],
        until: 0.1,
        ..SPEEDS
    },
    Case {
        what: "1e6 m/s for 1e-3 s",
        hold: &[("der(y)", 1e6)],
        until: 1e-3,
        ..SPEEDS
    },
    Case {
        what: "1e9 m/s for 1e-7 s",
        hold: &[("der(y)", 1e9)],
        until: 1e-7,
        ..SPEEDS
    },
    Case {
        what: "1e12 m/s for 1e-10 s",
        hold: &[("der(y)", 1e12)],
        until: 1e-10,
        ..SPEEDS
    },
    Case {
        what: "1e12 m/s for 1 s",
        hold: &[("der(y)", 1e12)],
        wanted: Wanted::Refused {
            words: &["at t = 0 s", "lost in the round-off of time"],
        },
        ..SPEEDS
    },
    Case {
        what: "1e200 m/s",
        hold: &[("der(y)", 1e200)],
        wanted: Wanted::Refused {
            words: &["at t = 0 s", "infinite or NaN"],
        },
        ..SPEEDS
    },
    Case {
        what: "an input that is not a number",
        mechanism: "four_bar",
        inputs: &[(0, f64::NAN)],
        wanted: Wanted::Refused {
            words: &["at t = 0 s", "infinite or NaN", "input"],
        },
        ..INPUTS
    },
    Case {
        what: "an infinite input",
        mechanism: "four_bar",
        inputs: &[(0, f64::INFINITY)],
        wanted: Wanted::Refused {
            words: &["at t = 0 s", "infinite or NaN", "input"],
        },
        ..INPUTS
    },
    Case {
        what: "an input of 1e300 N m",
        mechanism: "four_bar",
        inputs: &[(0, 1e300)],
        wanted: Wanted::Refused {
            words: &["at t = "],
        },
        ..INPUTS
    },
    Case {
        what: "an input that is no number after 0.5 s",
        mechanism: "fading_root",
        wanted: Wanted::Refused {
            words: &["at t = 0.5", "input"],
        },
        ..INPUTS
    },
    Case {
        what: "a force that blows up at 1 s",
        mechanism: "blow_up",
        until: 2.0,
        wanted: Wanted::Refused {
            words: &["at t = ", "grows without bound"],
        },
        ..INPUTS
    },
    Case {
        what: "the same up to 0.9 s",
        mechanism: "blow_up",
        until: 0.9,
        wanted: Wanted::Right {
            energy: 1e-7,
            end: 1e-6,
        },
        ..INPUTS
    },
];
