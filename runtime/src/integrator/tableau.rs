//! Coefficients of the explicit Runge–Kutta methods, with their papers.
//!
//! Out: one [`Tableau`] per method.
//!
//! Every coefficient is a pair `high + low`, so that a scalar of more than 53
//! bits gets all the digits that are known ([`Real::constant`]).
//!
//! Not here: how the stages are computed ([`super::explicit`]).

use super::control::Gains;
use crate::Real;

pub(crate) use super::dop853::DOP853;

/// One non-zero entry of a row: slot of the derivative it multiplies, and its value
/// as `high + low`.
pub(crate) type Term = (usize, f64, f64);

/// A Runge–Kutta method as data. Slots `0..s` hold the derivatives of the `s`
/// stages, slot `s` the derivative at the end of the step, the slots after it those
/// of the extra stages of the interpolant.
#[derive(Debug)]
pub(crate) struct Tableau {
    /// Order of the solution that is propagated.
    pub(crate) order: u8,
    /// Order of the error estimate plus one: the estimate is `O(h^error_order)`.
    pub(crate) error_order: u8,
    /// By how much a step may shrink and grow at once.
    pub(crate) jumps: (f64, f64),
    /// How the control of the step answers to errors.
    pub(crate) gains: Gains,
    /// Abscissae of the stages, as `(high, low)`.
    pub(crate) nodes: &'static [(f64, f64)],
    /// Rows `a_ij`, one per stage.
    pub(crate) rows: &'static [&'static [Term]],
    /// Weights `b_i`.
    pub(crate) weights: &'static [Term],
    /// Error estimates, each a combination of derivatives.
    pub(crate) errors: &'static [&'static [Term]],
    /// Abscissae of the extra stages of the interpolant.
    pub(crate) extra_nodes: &'static [(f64, f64)],
    /// Rows of the extra stages.
    pub(crate) extra_rows: &'static [&'static [Term]],
    /// The coefficients of the interpolant beyond its cubic Hermite part.
    pub(crate) dense: &'static [&'static [Term]],
}

impl Tableau {
    /// Number of stages, which is also the slot of the derivative at the end.
    pub(crate) const fn stages(&self) -> usize {
        self.nodes.len()
    }

    /// Abscissa of a stage.
    pub(crate) fn node<T: Real>((high, low): (f64, f64)) -> T {
        T::constant(high, low)
    }
}

/// The pair of orders 5 and 4 of Dormand and Prince, with the interpolant of
/// order 4.
///
/// Source: Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19–26, table 2
/// (RK5(4)7M); interpolant: Hairer, Nørsett & Wanner, Solving Ordinary
/// Differential Equations I (1993), eq. II.6.12 and code DOPRI5.
pub(crate) static DP5: Tableau = Tableau {
    order: 5,
    error_order: 5,
    jumps: (0.2, 10.0),
    gains: Gains::CALM,
    nodes: &[
        (0.0, 0.0),
        (0.2, -1.1102230246251566e-17),
        (0.3, 1.1102230246251566e-17),
        (0.8, -4.4408920985006264e-17),
        (0.8888888888888888, 4.9343245538895844e-17),
        (1.0, 0.0),
    ],
    rows: &[
        &[],
        &[(0, 0.2, -1.1102230246251566e-17)],
        &[
            (0, 0.075, 2.7755575615628915e-18),
            (1, 0.225, -5.551115123125783e-18),
        ],
        &[
            (0, 0.9777777777777777, 3.20731096002823e-17),
            (1, -3.7333333333333334, 5.921189464667501e-17),
            (2, 3.5555555555555554, 1.9737298215558337e-16),
        ],
        &[
            (0, 2.9525986892242035, 8.440470121673953e-17),
            (1, -11.595793324188385, -8.739643160469453e-16),
            (2, 9.822892851699436, 2.382554517104436e-16),
            (3, -0.2908093278463649, -9.975254885178018e-18),
        ],
        &[
            (0, 2.8462752525252526, -7.177199351112124e-17),
            (1, -10.757575757575758, 2.153159805333637e-16),
            (2, 8.906422717743473, -2.562801843769753e-16),
            (3, 0.2784090909090909, 2.5232341468753557e-17),
            (4, -0.2735313036020583, -2.3518446576536335e-17),
        ],
    ],
    weights: &[
        (0, 0.09114583333333333, 4.625929269271485e-18),
        (2, 0.44923629829290207, -3.341641628476437e-18),
        (3, 0.6510416666666666, 3.700743415417188e-17),
        (4, -0.322376179245283, -1.7805463602478925e-17),
        (5, 0.13095238095238096, -6.6084703846735505e-18),
    ],
    errors: &[&[
        (0, 0.0012326388888888888, 8.577243853440879e-20),
        (2, -0.0042527702905061394, -1.1824590090815252e-19),
        (3, 0.03697916666666667, -4.625929269271486e-19),
        (4, -0.05086379716981132, -7.12218544099157e-19),
        (5, 0.0419047619047619, 1.7710700630925118e-18),
        (6, -0.025, 1.3877787807814458e-18),
    ]],
    extra_nodes: &[],
    extra_rows: &[],
    dense: &[&[
        (0, -1.1270175653862835, 3.68427257320943e-17),
        (2, 2.675424484351598, -1.8184827063948802e-17),
        (3, -5.685526961588504, 2.1710335226270377e-16),
        (4, 3.5219323679207912, 1.4714550158626843e-16),
        (5, -1.7672812570757455, 6.096928095454083e-17),
        (6, 2.382468931778144, -2.218314285466272e-16),
    ]],
};

/// What the step control needs of Radau IIA, whose coefficients are in
/// [`super::collocation`]: with `S` stages, the estimate is that of an embedded
/// solution of order `S`.
const fn implicit(stages: u8) -> Tableau {
    Tableau {
        order: 2 * stages - 1,
        error_order: stages + 1,
        jumps: (0.2, 8.0),
        gains: Gains::QUICK,
        nodes: &[],
        rows: &[],
        weights: &[],
        errors: &[],
        extra_nodes: &[],
        extra_rows: &[],
        dense: &[],
    }
}

/// Radau IIA of order 5.
pub(crate) static RADAU5: Tableau = implicit(3);

/// Radau IIA of order 9.
pub(crate) static RADAU9: Tableau = implicit(5);
