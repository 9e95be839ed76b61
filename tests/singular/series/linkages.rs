//! Linkages with one degree of freedom, linkages that are driven, and knife edges.

use crate::trial::{Compare, Set, Trial};
use bricard_testkit::Random;
use core::f64::consts::{FRAC_PI_2, PI};

/// Gaps of the almost parallelogram: every decade, coupler too long or too short, at
/// three tolerances. `first` and `last` are the decades.
fn gap(index: usize, first: usize, last: usize) -> Trial {
    let tolerance = [1e-6, 1e-9, 1e-12][index % 3];
    let decade = first + index / 6 % (last - first + 1);
    let sign = if (index / 3).is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    let gap = sign * 10f64.powi(-(decade as i32));
    let trial = Trial::short("four_bar", "", vec![("gap", gap)]).uncounted();
    Trial {
        compare: Compare::Along,
        tolerance,
        ..trial
    }
}

/// All gaps from 1e-2 to 1e-13.
pub fn gaps(_: &mut Random, index: usize) -> Trial {
    gap(index, 2, 13)
}

/// Gaps down to 1e-8, which must come out right.
pub fn gaps_wide(_: &mut Random, index: usize) -> Trial {
    gap(index, 2, 8)
}

/// A parallelogram alone.
pub fn four_bar(random: &mut Random, _: usize) -> Trial {
    let set = vec![("a0", random.within(1.4)), ("w0", random.within(12.0))];
    Trial::short("four_bar", "parallelogram_reduced", set).until(3.0)
}

/// A parallelogram whose mass matrix is singular where its constraints are.
pub fn end_mass(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("a0", random.within(3.0)),
        ("wa", random.within(8.0)),
        ("p0", random.within(1.0)),
        ("mp", random.decade(0.01, 1.0)),
        ("J", random.decade(0.01, 1.0)),
    ];
    Trial::short("end_mass", "end_mass_reduced", set).until(1.5)
}

/// A slider without mass, whose constraint loses its gradient in the singular position.
pub fn massless(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("a0", random.within(3.0)),
        ("wa", random.within(6.0)),
        ("p0", random.within(1.0)),
    ];
    Trial::short("massless_slider", "massless_slider_reduced", set).until(1.5)
}

/// Bennett's linkage, whose rows are redundant, along either of two sheets.
pub fn bennett(random: &mut Random, index: usize) -> Trial {
    let (a, w) = (random.within(6.0), random.within(8.0));
    let (reduced, set) = match index % 2 {
        0 => {
            let set = vec![("a2", a), ("w2", w), ("a4", -a), ("w4", -w)];
            ("bennett_coupler_reduced", set)
        }
        _ => {
            let still = [("a2", PI), ("w2", 0.0), ("a4", PI), ("w4", 0.0)];
            let mut set = vec![("a1", a), ("w1", w)];
            set.extend(still);
            ("bennett_crank_reduced", set)
        }
    };
    Trial::short("bennett", reduced, set).until(3.0)
}

/// The slider–crank with equal links, turning.
pub fn slider(random: &mut Random, _: usize) -> Trial {
    let set = vec![("p0", random.within(1.4)), ("w0", random.within(8.0))];
    slider_crank(set).until(3.0)
}

fn slider_crank(set: Set) -> Trial {
    Trial::short("equal_slider_crank", "equal_slider_crank_reduced", set)
}

/// Released at rest 1e-8 … 1e-1 rad beside its upright position.
pub fn slider_rest(random: &mut Random, index: usize) -> Trial {
    let beside = 10f64.powi(-1 - (index % 8) as i32);
    let p0 = FRAC_PI_2 * random.sign() + random.sign() * beside;
    let mut trial = slider_crank(vec![("p0", p0), ("w0", 0.0)]).until(1.0);
    trial.held = &[(0, "p0")];
    trial
}

/// At rest exactly in a singular position: nothing moves, or the start is refused.
pub fn rest_on(_: &mut Random, index: usize) -> Trial {
    let trial = match index % 6 {
        0 => slider_crank(vec![("p0", FRAC_PI_2), ("w0", 0.0)]),
        1 => slider_crank(vec![("p0", -FRAC_PI_2), ("w0", 0.0)]),
        2 => at_rest("four_bar", vec![("a0", 0.0), ("w0", 0.0)]),
        3 => at_rest("four_bar", vec![("a0", PI), ("w0", 0.0)]),
        4 => at_rest("parallelogram_pendulum", vec![("a0", 0.0), ("wb0", 0.0)]),
        _ => {
            let set = vec![("x0", 0.0), ("v0", 0.0), ("h1", -0.5)];
            at_rest("curves", set)
        }
    };
    let compare = Compare::Rest;
    Trial { compare, ..trial }.uncounted()
}

fn at_rest(mechanism: &'static str, set: Set) -> Trial {
    Trial::short(mechanism, "", set)
}

fn crank(set: Set) -> Trial {
    Trial::short("driven_crank", "driven_crank_reduced", set)
}

/// A driven crank that passes its dead centres at a steady rate.
pub fn driven(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("p0", random.within(1.3)),
        ("w", random.signed_decade(0.5, 6.0)),
        ("al", random.of_these(&[0.0, 0.5])),
        ("b0", random.within(1.0)),
        ("wb", random.within(2.0)),
    ];
    crank(set).until(2.0)
}

/// A driven crank that stops after 1 s, exactly at its dead centre or 1e-6 … 1e-1 rad
/// before or behind it, and turns back.
pub fn driven_stops(random: &mut Random, index: usize) -> Trial {
    let beside = match index % 2 {
        0 => 0.0,
        _ => random.signed_decade(1e-6, 1e-1),
    };
    // Doubles that are sums of few powers of two, so that it stops to the last bit.
    let w = random.of_these(&[0.5, 1.0, 2.0, 4.0]);
    let set = vec![
        ("p0", FRAC_PI_2 - w / 2.0 + beside),
        ("w", w),
        ("al", -w),
        ("b0", random.within(1.0)),
        ("wb", random.within(2.0)),
    ];
    let trial = crank(set).until(2.0);
    // Stopping there is no sign change, and no one could say whether it is a passage.
    if beside == 0.0 {
        trial.uncounted()
    } else {
        trial
    }
}

/// A driven crank until it stops, exactly at its dead centre or beside it.
pub fn driven_to_stop(random: &mut Random, index: usize) -> Trial {
    driven_stops(random, index).until(1.0)
}

/// A crank driven along a spline, a knot of which lies in a dead centre, or 1e-6 … 1e-1 rad
/// before or behind it.
pub fn splined(random: &mut Random, index: usize) -> Trial {
    let beside = match index % 2 {
        0 => 0.0,
        _ => random.signed_decade(1e-6, 1e-1),
    };
    let w = random.signed_decade(0.5, 4.0);
    let set = vec![
        ("p0", FRAC_PI_2 - w + beside),
        ("w", w),
        ("b0", random.within(1.0)),
        ("wb", random.within(2.0)),
    ];
    Trial::short("splined_crank", "splined_crank_reduced", set).until(2.0)
}

/// A parallelogram on a table that turns, with rows that are scaled or not.
pub fn turntable(random: &mut Random, index: usize) -> Trial {
    let set = vec![
        ("om", random.within(4.0)),
        ("a0", random.within(3.0)),
        ("w0", random.within(5.0)),
        ("s", [0.0, 1.5][index % 2]),
    ];
    Trial::short("turntable", "turntable_reduced", set).until(4.0)
}

/// A driven parallelogram on ice that leaves its way to a skate and a wheel.
pub fn skated(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        // A start beside the singular configuration does not say on which sheet it is.
        ("a0", random.sign() * random.between(0.1, 0.5)),
        ("a1", random.between(0.7, 1.3)),
        ("th0", random.within(2.0)),
        ("lean", random.between(0.4, 1.0)),
        ("lag", random.within(0.2)),
    ];
    Trial::short("skated", "skated_reduced", set).until(2.0)
}

/// Two knife edges that turn past each other.
pub fn knife_edges(random: &mut Random, index: usize) -> Trial {
    let mut set = Set::new();
    if index > 0 {
        set.extend([
            ("F", random.within(2.0)),
            ("Fy", random.within(2.0)),
            ("s0", random.between(0.3, 1.5)),
            ("w1", random.within(2.0)),
            ("w2", random.within(2.0)),
            ("t1", random.of_these(&[0.0, 1.0])),
            ("k", random.of_these(&[0.0, 2.0])),
        ]);
    }
    Trial::short("knife_edges", "knife_edges_reduced", set).until(4.0)
}

/// A parallelogram with each constraint written several times.
pub fn duplicated(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("a0", random.within(1.4)),
        ("w0", random.within(5.0)),
        ("s1", random.signed_decade(1e-8, 1e8)),
        ("s2", random.signed_decade(1e-8, 1e8)),
        ("s3", random.signed_decade(1e-2, 1e2)),
    ];
    Trial::short("duplicated", "parallelogram_reduced", set).until(2.0)
}
