//! The problems, with their references and bounds.
//!
//! References to problems A01–A05 of the IFToMM library of computational benchmark
//! problems (<https://www.iftomm-multibody.org/benchmark>):
//!
//! - A01: the elliptic functions of the pendulum, `sin(θ/2) = √½ cd(√(g/L) t | ½)`;
//! - A02: `φ/2 = am(t/2 | −4k)`, `k = 3 g (3N+1)/(2 (4N+1))`, since all cranks stay
//!   parallel; the library has it twice, with N = 2 for 10 s and with N = 40 for 20 s;
//! - A03: integrated by extrapolation with 34 digits at two steps that agree to 1e−19
//!   and checked by a quadrature; the values that are published with the Test Set for
//!   IVP Solvers are right to ten digits;
//! - A04: the one-parameter closed form of the linkage's positions, integrated to 14
//!   digits;
//! - A05: Radau IIA of the three-coordinate form at two tolerances that agree to 6e−13.
//!
//! The flexible slider–crank is compared with the values published with the Test Set,
//! the cart–pole with the quadrature of its one degree of freedom, the runs of Phong &
//! Hoang (2012) with those of their exact reductions.

use super::problem::{Measure, Problem};
use crate::simulate::TOLERANCE;
use bricard_runtime::Method;

/// What most problems have in common.
const USUAL: Problem = Problem {
    title: "",
    mechanism: "",
    held: &[],
    until: 10.0,
    method: Method::Dop853,
    tolerance: (1e-13, 1e-13),
    keep_energy: false,
    reference: &[],
    measure: Measure::Absolute,
    bound: 1e-9,
    balance_bound: Some(1e-9),
    work: None,
    constraint_bound: 1e-12,
    stiffness: None,
    published: "",
    long: false,
};

/// All of them.
pub const PROBLEMS: &[Problem] = &[
    Problem {
        title: "A01 pendulum, 10 s",
        mechanism: "pendulum",
        reference: &[
            ("x", -0.275_087_462_576_116_9),
            ("y", -0.961_419_205_099_125),
        ],
        bound: 1e-11,
        published: "EXUDYN 5e-5 J in 0.04 s; OpenSim 0.64 s",
        ..USUAL
    },
    Problem {
        title: "A01 pendulum, 2000 s",
        mechanism: "pendulum",
        until: 2000.0,
        keep_energy: true,
        reference: &[
            ("x", 0.814_603_068_589_032_2),
            ("y", -0.580_018_827_836_935_5),
        ],
        published: "simEngine3D passes 1e-3 in 60 s",
        long: true,
        ..USUAL
    },
    Problem {
        title: "A02 four-bars, N = 2",
        mechanism: "n_four_bar",
        reference: &[
            ("first.x", 0.328_458_111_540_815_4),
            ("first.y", 0.944_518_538_178_601),
        ],
        published: "EXUDYN 0.11 J in 0.08 s; OpenSim 0.46 s",
        ..USUAL
    },
    Problem {
        title: "A02 four-bars, N = 40, 20 s",
        mechanism: "forty_four_bars",
        until: 20.0,
        tolerance: (1e-12, 1e-12),
        keep_energy: true,
        reference: &[
            ("x[0]", 0.410_901_153_762_945_2),
            ("y[0]", 0.911_679_900_971_98),
            ("der(x[0])", 1.566_785_371_909_069_9),
            ("der(y[0])", -0.706_162_235_593_837_3),
        ],
        bound: 1e-8,
        constraint_bound: 1e-9,
        published: "the library's own table is right to 4e-6",
        long: true,
        ..USUAL
    },
    Problem {
        title: "A03 Andrews, Test Set, 0.03 s",
        until: 0.03,
        reference: &[
            ("beta", 15.810_771_195_153_707),
            ("Theta", -15.756_371_058_411_839),
            ("gamma", 0.040_822_240_119_645_8),
            ("Phi", -0.534_730_116_342_079_6),
            ("delta", 0.524_409_965_879_954),
            ("Omega", 0.534_730_116_342_079_6),
            ("epsilon", 1.048_080_741_041_938),
        ],
        published: "published reference 3e-10; PSIDE 1112 steps",
        ..ANDREWS
    },
    Problem {
        title: "A03 Andrews, beta = -0.062, 0.05 s",
        held: &[("beta", -0.062)],
        until: 0.05,
        reference: &[
            ("crank.x", -0.005_158_985_250_188_671),
            ("crank.y", 0.004_731_265_284_079_487),
        ],
        published: "OpenSim 0.38 s",
        ..ANDREWS
    },
    Problem {
        title: "A04 Bricard, 30 coordinates",
        mechanism: "bricard",
        published: "OpenSim 0.26 s at 1e-7; EXUDYN 3.6 s (5 s)",
        ..BRICARD
    },
    Problem {
        title: "A04 Bricard, joint angles",
        mechanism: "bricard_relative",
        published: "as above",
        ..BRICARD
    },
    Problem {
        title: "A05 flyball governor",
        mechanism: "flyball_governor",
        method: Method::Radau9,
        tolerance: (1e-8, 1e-8),
        reference: &[("s", 0.619_622_917_061_313_1)],
        bound: 1e-7,
        balance_bound: None,
        stiffness: Some(50.0),
        published: "EXUDYN 0.53 s; OpenSim 0.23 s",
        ..USUAL
    },
    Problem {
        title: "flexible slider–crank, 0.1 s",
        mechanism: "flexible_slider_crank",
        until: 0.1,
        tolerance: (1e-10, 1e-12),
        reference: &[
            ("phi1", 15.000_000_000_001_04),
            ("phi2", -0.331_173_498_825_626),
            ("x3", 0.169_737_332_842_786),
            ("u1", 0.000_189_319_289_961_350_9),
            ("u2", 2.375_751_249_879_174e-5),
            ("w1", -5.323_896_770_569_702e-6),
            ("w2", -8.363_313_279_112_129e-6),
        ],
        measure: Measure::Relative,
        bound: 1e-7,
        balance_bound: None,
        published: "MEBDFI 180090 steps; IDA, DASSL fail",
        ..USUAL
    },
    Problem {
        title: "cart–pole with a light cart, default tolerances",
        mechanism: "light_cart",
        tolerance: (TOLERANCE, TOLERANCE),
        reference: &[
            ("x", 1.999_763_282_468_727_7),
            ("tip.x", 0.999_998_000_236_717_5),
            ("tip.y", -0.021_665_189_672_586_37),
        ],
        bound: 1e-6,
        balance_bound: None,
        published: "SciPy's solvers 0.09 … 3.8 by default",
        ..USUAL
    },
    Problem {
        title: "Phong & Hoang, slider–crank, free, 8 s",
        mechanism: "slider_crank",
        until: 8.0,
        reference: &[
            ("q1", -1.962_686_419_093_813),
            ("der(q1)", -3.684_010_995_488_191_7),
        ],
        published: "RK4, h = 0.01: figures only",
        ..USUAL
    },
    Problem {
        title: "Phong & Hoang, slider–crank, driven, 20 s",
        mechanism: "slider_crank_driven",
        until: 20.0,
        reference: &[
            ("q1", 89.830_891_650_147_32),
            ("der(q1)", 3.397_563_053_091_582_6),
        ],
        published: "RK4, h = 0.01: figures only",
        ..USUAL
    },
    Problem {
        title: "Phong & Hoang, double four-bar, 8 s",
        mechanism: "double_four_bar",
        until: 8.0,
        reference: &[
            ("q1", -1.528_710_001_192_138_2),
            ("der(q1)", -8.581_436_319_158_87),
        ],
        published: "RK4, h = 0.01: 6 of 9 passages",
        ..USUAL
    },
];

/// What the two starts of Andrews' mechanism have in common.
const ANDREWS: Problem = Problem {
    mechanism: "andrews",
    measure: Measure::Relative,
    bound: 1e-11,
    balance_bound: Some(1e-13),
    work: Some("work"),
    constraint_bound: 1e-15,
    ..USUAL
};

/// What the two descriptions of Bricard's linkage have in common.
const BRICARD: Problem = Problem {
    reference: &[
        ("P3.x", 0.999_999_963_806_349_4),
        ("P3.y", -1.000_269_012_696_165),
        ("P3.z", 0.999_730_951_119_919_5),
    ],
    bound: 1e-8,
    ..USUAL
};
