//! The kinds of singular configurations.
//!
//! Out: a picture of each.

use crate::curve::{Point, along, sampled};
use crate::drawing::{Curve, Panel, Picture, Role};
use crate::four_bar::FourBar;

/// The first loop of the library's `double_four_bar`.
const PARALLELOGRAM: FourBar = FourBar {
    crank: 0.4,
    ground: 0.7,
    coupler: 0.7,
};
/// The parallelogram with a coupler that is 2 % too long.
const WITH_GAP: FourBar = FourBar {
    coupler: 0.7 * 1.02,
    ..PARALLELOGRAM
};

/// Angles that are shown: half a turn to both sides, without its end.
const MOST: f64 = std::f64::consts::PI - 1e-3;

/// The pictures by the names of their files.
pub fn all() -> [(&'static str, Picture); 6] {
    [
        ("kind_crossing.svg", crossing()),
        ("kind_gap.svg", gap()),
        ("kind_touching.svg", touching()),
        ("kind_cusp.svg", cusp()),
        ("kind_three.svg", three()),
        ("kind_several.svg", several()),
    ]
}

fn crossing() -> Picture {
    let parallel = sampled(-MOST, MOST, |s| [s, s]);
    let crossed = sampled(-MOST, MOST, |s| [s, PARALLELOGRAM.crossed(s)]);
    let near = sampled(-1.0, 1.0, |s| [s, s]);
    Picture {
        title: "Two sheets cross: a parallelogram".into(),
        panels: vec![
            linkage(
                &PARALLELOGRAM,
                &[
                    (Role::Motion, [0.7, 0.7]),
                    (Role::Other, [0.7, PARALLELOGRAM.crossed(0.7)]),
                    (Role::Link, [0.0, 0.0]),
                ],
            ),
            angles(vec![
                Curve::new(Role::Other, crossed),
                Curve::new(Role::Motion, parallel),
                Curve::dot([0.0, 0.0]),
            ]),
            size(along(&near, |point| PARALLELOGRAM.gradient(point))),
        ],
    }
}

fn gap() -> Picture {
    let curves = WITH_GAP.zero_set();
    let near = |point: &&Point| point[0].abs() < 1.0 && point[1].abs() < 1.0;
    // The branch that the nearly parallel motion follows: it turns before the line.
    let left = curves.iter().flatten().filter(near);
    let mut left: Vec<Point> = left.filter(|[q1, _]| *q1 < 0.0).copied().collect();
    left.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let shown = curves
        .into_iter()
        .map(|curve| Curve::new(Role::Motion, curve));
    let nearest = left.iter().min_by(|a, b| {
        let [a, b] = [a, b].map(|point| WITH_GAP.gradient(**point));
        a.total_cmp(&b)
    });
    let nearest = nearest.copied().unwrap_or_default();
    Picture {
        title: "A gap keeps the sheets apart: the coupler is 2 % too long".into(),
        panels: vec![
            linkage(&WITH_GAP, &[(Role::Link, nearest)]),
            angles(shown.collect()),
            size(along(&left, |point| WITH_GAP.gradient(point))),
        ],
    }
}

/// A bead on two wires `y = f(x)` and `y = h(x)`, moving on the first: the constraint is
/// the product of `y − f` and `y − h`, and others.
fn wires(title: &str, f: fn(f64) -> f64, others: &[fn(f64) -> f64]) -> Picture {
    let motion = sampled(-1.0, 1.0, |x| [x, f(x)]);
    let gradient = |[x, y]: Point| {
        let step = 1e-6;
        let slope = (f(x + step) - f(x - step)) / (2.0 * step);
        let rest: f64 = others.iter().map(|h| (y - h(x)).abs()).product();
        rest * slope.hypot(1.0)
    };
    let sizes = along(&motion, gradient);
    let mut curves: Vec<Curve> = others
        .iter()
        .map(|h| Curve::new(Role::Other, sampled(-1.0, 1.0, |x| [x, h(x)])))
        .collect();
    curves.push(Curve::new(Role::Motion, motion));
    curves.push(Curve::dot([0.0, 0.0]));
    Picture {
        title: title.into(),
        panels: vec![plane(curves), size(sizes)],
    }
}

fn touching() -> Picture {
    wires(
        "Two sheets touch: (y − x²)(y + x²) = 0",
        |x| x * x,
        &[|x| -x * x],
    )
}

fn three() -> Picture {
    wires(
        "Three sheets through one point: (y − x)(y + x)(y − x²/2) = 0",
        |x| x,
        &[|x| -x, |x| x * x / 2.0],
    )
}

fn cusp() -> Picture {
    let curve = sampled(-1.0, 1.0, |s| [s * s, s * s * s]);
    let sizes = along(&curve, |[x, y]| (3.0 * x * x).hypot(2.0 * y));
    Picture {
        title: "A cusp: y² = x³".into(),
        panels: vec![
            plane(vec![
                Curve::new(Role::Motion, curve),
                Curve::dot([0.0, 0.0]),
            ]),
            size(sizes),
        ],
    }
}

/// A sheet of the constraint set: the angles of three cranks over that of the first.
type Way = (Role, fn(f64) -> [f64; 3]);

fn crossed(q: f64) -> f64 {
    PARALLELOGRAM.crossed(q)
}

/// Two parallelograms in a row: each may turn over by itself.
fn several() -> Picture {
    let ways: [Way; 4] = [
        (Role::Other, |q| [q, crossed(q), crossed(q)]),
        (Role::Other, |q| [q, q, crossed(q)]),
        (Role::Other, |q| [q, crossed(q), crossed(crossed(q))]),
        (Role::Motion, |q| [q, q, q]),
    ];
    let mut curves: Vec<Curve> = Vec::new();
    for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        curves.push(Curve::new(
            Role::Ghost,
            sampled(-1.0, 1.0, |s| oblique(axis.map(|x| s * x))),
        ));
    }
    for (role, way) in ways {
        let points = sampled(-1.0, 1.0, |s| [s, 0.0]).into_iter();
        let points = points.map(|[s, _]| way(s));
        let inside = points.filter(|point| point.iter().all(|x| x.abs() <= 1.0));
        curves.push(Curve::new(role, inside.map(oblique).collect()));
    }
    curves.push(Curve::dot([0.0, 0.0]));
    let near = sampled(-1.0, 1.0, |s| [s, s]);
    let set = Panel {
        title: "constraint set (q1, q3, q5)".into(),
        labels: [String::new(), String::new()],
        equal: true,
        axes: false,
        curves,
    };
    let mut line = Vec::new();
    for (role, angles) in [
        (Role::Motion, [0.7, 0.7, 0.7]),
        (Role::Other, [0.7, 0.7, crossed(0.7)]),
        (Role::Link, [0.0, 0.0, 0.0]),
    ] {
        let [first, second] = PARALLELOGRAM.joints([angles[0], angles[1]]);
        let [_, third] = PARALLELOGRAM.joints([angles[1], angles[2]]);
        let bearing = PARALLELOGRAM.ground;
        let third = [third[0] + bearing, third[1]];
        line.push(Curve::new(
            role,
            vec![[0.0, 0.0], first, second, [bearing, 0.0]],
        ));
        line.push(Curve::new(role, vec![second, third, [2.0 * bearing, 0.0]]));
    }
    Picture {
        title: "Several loops at once: two parallelograms in a row".into(),
        panels: vec![
            Panel {
                title: "mechanism".into(),
                labels: [String::new(), String::new()],
                equal: true,
                axes: false,
                curves: line,
            },
            set,
            size(along(&near, |point| PARALLELOGRAM.gradient(point))),
        ],
    }
}

/// A point in space seen from above one side.
fn oblique([x, y, z]: [f64; 3]) -> Point {
    [x - 0.45 * y, z - 0.35 * y]
}

/// A linkage in some configurations.
fn linkage(linkage: &FourBar, configurations: &[(Role, Point)]) -> Panel {
    let curves = configurations.iter().map(|(role, angles)| {
        let [a, b] = linkage.joints(*angles);
        Curve::new(*role, vec![[0.0, 0.0], a, b, [linkage.ground, 0.0]])
    });
    Panel {
        title: "mechanism".into(),
        labels: [String::new(), String::new()],
        equal: true,
        axes: false,
        curves: curves.collect(),
    }
}

/// The plane of both crank angles.
fn angles(curves: Vec<Curve>) -> Panel {
    Panel {
        title: "constraint set".into(),
        labels: ["crank q1 [rad]".into(), "crank q3 [rad]".into()],
        equal: true,
        axes: true,
        curves,
    }
}

/// The plane of a bead.
fn plane(curves: Vec<Curve>) -> Panel {
    Panel {
        title: "mechanism and constraint set".into(),
        labels: ["x".into(), "y".into()],
        equal: true,
        axes: true,
        curves,
    }
}

/// The size of the gradient along the motion.
fn size(values: Vec<Point>) -> Panel {
    Panel {
        title: "length of the gradient".into(),
        labels: ["way along the sheet".into(), String::new()],
        equal: false,
        axes: true,
        curves: vec![Curve::new(Role::Motion, values)],
    }
}
