//! Particles on curves and surfaces that cross, touch or end.

use super::backwards::before;
use crate::trial::{Compare, Set, Trial};
use bricard_testkit::Random;

/// Tolerances that cases with a name are run at.
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];
/// The value and the tolerance at a place of a series that has every value at each.
fn of_index(index: usize, values: &[f64]) -> (f64, f64) {
    let tolerance = TOLERANCES[index % 3];
    (values[index / 3 % values.len()], tolerance)
}

fn curve(set: Set) -> Trial {
    Trial::short("curves", "curve_reduced", set)
}

fn surface(set: Set) -> Trial {
    Trial::short("surfaces", "surface_reduced", set)
}

/// Two parabolas that cross twice.
fn parabolas(h0: f64) -> Set {
    vec![
        ("f1", 0.0),
        ("h1", 0.0),
        ("f2", 1.0),
        ("h2", -1.0),
        ("h0", h0),
    ]
}

/// Two parabolas that cross twice, at distances from 0.14 to 1.
pub fn curves_named(_: &mut Random, index: usize) -> Trial {
    let (h0, tolerance) = of_index(index, &[0.01, 0.1, 0.25, 0.4, 0.5]);
    let trial = curve(parabolas(h0)).until(0.6);
    Trial { tolerance, ..trial }
}

/// Two parabolas so near to touching, or to missing each other, that an error will do.
pub fn near(_: &mut Random, index: usize) -> Trial {
    let decade = 10f64.powi(-1 - (index / 3 % 9) as i32);
    let sign = if index < 27 { 1.0 } else { -1.0 };
    let (_, tolerance) = of_index(index, &[0.0]);
    let trial = curve(parabolas(sign * decade)).until(0.6).uncounted();
    Trial { tolerance, ..trial }
}

/// Two random cubic curves, moving or not.
pub fn curves(random: &mut Random, _: usize) -> Trial {
    let set = vec![
        ("f1", random.within(1.0)),
        ("f2", random.within(1.0)),
        ("f3", random.within(0.5)),
        ("h1", random.within(1.0)),
        ("h2", random.within(1.0)),
        ("h3", random.within(0.5)),
        ("h0", random.within(0.3)),
        ("am", random.of_these(&[0.0, 0.1])),
        ("w", 7.0),
        ("v0", random.between(1.0, 6.0)),
    ];
    curve(set).until(0.8)
}

/// Two surfaces that cross twice, 0.002 … 2 apart.
pub fn surfaces_named(_: &mut Random, index: usize) -> Trial {
    let (f1, tolerance) = of_index(index, &[0.0005, 0.002, 0.02, 0.05, 0.5]);
    let set = vec![
        ("f1", f1),
        ("h1", -f1),
        ("f2", 0.5),
        ("h2", 0.0),
        ("fxy", 0.0),
        ("fyy", 0.0),
        ("hxy", 0.0),
        ("hyy", 0.0),
        ("y0", 0.0),
        ("vy0", 0.0),
    ];
    let trial = surface(set).until(0.4);
    Trial { tolerance, ..trial }
}

/// The coefficients of two random surfaces.
fn two_surfaces(random: &mut Random) -> Set {
    vec![
        ("f1", random.within(0.6)),
        ("f2", random.within(0.6)),
        ("fxy", random.within(0.4)),
        ("fyy", random.within(0.4)),
        ("h0", random.within(0.1)),
        ("h1", random.within(0.6)),
        ("h2", random.within(0.6)),
        ("hxy", random.within(0.4)),
        ("hyy", random.within(0.4)),
    ]
}

/// Two random surfaces.
pub fn surfaces(random: &mut Random, _: usize) -> Trial {
    let mut set = two_surfaces(random);
    set.push(("y0", random.within(0.6)));
    set.push(("vx0", random.between(1.0, 6.0)));
    set.push(("vy0", random.within(1.5)));
    set.push(("am", random.of_these(&[0.0, 0.1])));
    set.push(("w", 7.0));
    surface(set).until(0.8)
}

/// Along the line in which two surfaces cross, 1e-6 … 1e-2 beside it, across it slowly or
/// turning round.
pub fn grazing(random: &mut Random, _: usize) -> Trial {
    let slope = random.signed_decade(0.1, 0.6);
    let set = vec![
        ("f1", slope),
        ("h1", -slope),
        ("f2", random.within(0.6)),
        ("h2", random.within(0.6)),
        ("fxy", random.within(0.3)),
        ("hxy", random.within(0.3)),
        ("fyy", 0.4),
        ("hyy", 0.4),
        ("gx", random.within(3.0)),
    ];
    let mut reached = set.clone();
    reached.push(("x0", random.signed_decade(1e-6, 1e-2)));
    reached.push(("y0", random.within(0.3)));
    reached.push(("vx0", random.of_these(&[0.0, 1e-6, 1e-3])));
    reached.push(("vy0", random.signed_decade(0.3, 5.0)));
    let span = random.decade(0.01, 0.1);
    let names = ("surfaces", "surface_reduced");
    let state = before(names, 3, &reached, &["vx0", "vy0"], span);
    let mut set = set;
    set.extend([
        ("x0", state[0]),
        ("y0", state[1]),
        ("vx0", state[3]),
        ("vy0", state[4]),
    ]);
    surface(set).until(2.0 * span)
}

/// Three random curves through one point.
pub fn three_curves(random: &mut Random, index: usize) -> Trial {
    let mut set = Set::new();
    if index == 0 {
        // Elsewhere than at -1, where two of the curves cross.
        set.push(("x0", -0.9));
    } else {
        set.extend([
            ("f1", random.between(0.3, 1.0)),
            ("f2", random.within(1.0)),
            ("h1", random.between(-1.0, -0.3)),
            ("h2", random.within(1.0)),
            ("k1", random.within(0.2)),
            ("k2", random.within(1.0)),
            ("v0", random.between(1.0, 6.0)),
        ]);
    }
    let trial = Trial::short("three_curves", "curve_reduced", set);
    trial.until(0.8).uncounted()
}

/// Three random surfaces through one curve.
pub fn three_surfaces(random: &mut Random, index: usize) -> Trial {
    let mut set = Set::new();
    if index > 0 {
        set.extend([
            ("f1", random.between(0.2, 0.6)),
            ("f2", random.within(0.4)),
            ("h1", random.between(-0.6, -0.2)),
            ("k1", random.within(0.1)),
            ("vx0", random.between(1.0, 6.0)),
            ("vy0", random.within(1.5)),
        ]);
    }
    let trial = Trial::short("three_surfaces", "surface_reduced", set);
    trial.until(0.5).uncounted()
}

/// Two curves, or surfaces, that touch.
pub fn tacnode(random: &mut Random, index: usize) -> Trial {
    let f2 = random.decade(0.2, 1.0);
    let mut set = vec![
        ("f1", 0.0),
        ("h1", 0.0),
        ("h0", 0.0),
        ("f2", f2),
        ("h2", -random.decade(0.2, 1.0)),
    ];
    // Every third begins where they touch.
    let there = index % 3 == 2;
    if index.is_multiple_of(2) {
        set.push(("v0", random.between(1.0, 6.0)));
        set.push(("x0", if there { 0.0 } else { -1.0 }));
        return curve(set).until(0.6).uncounted();
    }
    set.push(("vx0", random.between(1.0, 6.0)));
    set.push(("x0", if there { 0.0 } else { -1.0 }));
    set.push(("y0", 0.2));
    surface(set).until(0.6).uncounted()
}

/// Into a cusp.
pub fn cusp(random: &mut Random, index: usize) -> Trial {
    let mut set = Set::new();
    if index > 0 {
        set.push(("v0", -random.decade(0.1, 5.0)));
        set.push(("x0", random.decade(0.05, 2.0)));
        set.push(("gx", random.of_these(&[0.0, 9.81])));
    }
    let trial = Trial::short("cusp", "", set).until(3.0).uncounted();
    let compare = Compare::Invariants;
    Trial { compare, ..trial }
}

/// Along a straight line through the apex of a cone.
pub fn cone(random: &mut Random, index: usize) -> Trial {
    let mut set = Set::new();
    if index > 0 {
        set.push(("v0", random.between(4.5, 8.0)));
        set.push(("c", random.decade(0.3, 3.0)));
        set.push(("y0", random.of_these(&[0.0, 0.5, -2.0])));
    }
    Trial::short("cone", "cone_reduced", set)
        .until(0.5)
        .uncounted()
}

/// A constraint that vanishes for an instant.
pub fn instant(random: &mut Random, index: usize) -> Trial {
    let mut set = Set::new();
    if index > 0 {
        set.push(("t0", random.between(0.1, 1.5)));
        set.push(("f2", random.within(1.0)));
        set.push(("v0", random.within(3.0)));
    }
    let trial = Trial::short("instant", "curve_reduced", set);
    trial.until(2.0).uncounted()
}
