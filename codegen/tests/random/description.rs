//! Random descriptions: trees of bodies on hinges and slides, and loops that tie them.

use proptest::prelude::*;
use std::fmt::Write;

/// The most bodies of a random mechanism.
pub const BODIES_MAX: usize = 4;

/// How a body hangs on its parent.
#[derive(Clone, Copy, Debug)]
pub enum Joint {
    /// A hinge about an axis of the parent: `x`, `y` or `z`.
    Hinge(char),
    /// A slide along the x axis of the parent.
    Slide,
}

/// A body, in tenths of metres and kilograms: short numbers shrink to readable ones.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// The number of the parent; the ground if it is not an earlier body.
    pub parent: usize,
    pub joint: Joint,
    pub length: i32,
    pub mass: i32,
    pub inertia: i32,
}

/// A mechanism.
#[derive(Clone, Debug)]
pub struct Random {
    pub bodies: Vec<Body>,
    /// Pairs of bodies whose ends keep a distance, in tenths of metres.
    pub loops: Vec<(usize, usize, i32)>,
}

/// How a mechanism is written down.
#[derive(Clone, Copy, Debug)]
pub struct Manner {
    /// Units of length to the metre.
    pub scale: i32,
    /// Seconds to the unit of time.
    pub time_unit: i32,
    /// Whether coordinates and constraints are written in reverse order.
    pub reversed: bool,
    /// How many times each constraint is written.
    pub copies: usize,
}

impl Manner {
    pub const PLAIN: Self = Self {
        scale: 1,
        time_unit: 1,
        reversed: false,
        copies: 1,
    };
}

/// Mechanisms in the plane, where all hinges are parallel, and in space.
pub fn any() -> impl Strategy<Value = Random> {
    any_planar().prop_flat_map(|planar| {
        let joint = if planar {
            prop_oneof![3 => Just(Joint::Hinge('z')), 1 => Just(Joint::Slide)].boxed()
        } else {
            let axis = prop_oneof![Just('z'), Just('x'), Just('y')].prop_map(Joint::Hinge);
            prop_oneof![4 => axis, 1 => Just(Joint::Slide)].boxed()
        };
        let body = (0..=BODIES_MAX, joint, 1..20, 1..20, 1..20);
        let body = body.prop_map(|(parent, joint, length, mass, inertia)| Body {
            parent,
            joint,
            length,
            mass,
            inertia,
        });
        let bodies = proptest::collection::vec(body, 1..=BODIES_MAX);
        let tie = (0..BODIES_MAX, 0..=BODIES_MAX, 1..20);
        let loops = proptest::collection::vec(tie, 0..3);
        (bodies, loops).prop_map(|(bodies, loops)| Random { bodies, loops })
    })
}

fn any_planar() -> impl Strategy<Value = bool> {
    proptest::bool::ANY
}

/// A state: coordinates and velocities.
pub fn state() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    let numbers = || proptest::collection::vec(-2.0..2.0_f64, BODIES_MAX);
    (numbers(), numbers())
}

impl Random {
    /// How many coordinates it has.
    pub fn n(&self) -> usize {
        self.bodies.len()
    }

    /// The description.
    pub fn text(&self, manner: Manner) -> String {
        let mut text = "mechanism Random {\n".to_string();
        let mut line = |line: String| writeln!(text, "{line}").expect("memory suffices");
        let scale = manner.scale;
        let mut order: Vec<usize> = (0..self.n()).collect();
        if manner.reversed {
            order.reverse();
        }
        for i in order {
            line(format!("coord q{i};"));
        }
        for (i, body) in self.bodies.iter().enumerate() {
            let (frame, base) = match body.parent < i {
                true => (format!("R{}*", body.parent), format!("p{} + ", body.parent)),
                false => (String::new(), format!("[{i}*{scale}, 0, 0] + ")),
            };
            // Turning stores energy by the square of a length, sliding as it is.
            let unit = match body.joint {
                Joint::Hinge(_) => scale,
                Joint::Slide => 1,
            };
            let (turn, slid) = match body.joint {
                Joint::Hinge(axis) => (format!("{frame}rot{axis}(q{i})"), "0".to_string()),
                Joint::Slide => (format!("{frame}rotz(0)"), format!("q{i}")),
            };
            line(format!("let R{i} = {turn};"));
            let along = format!("{frame}[{slid}, 0, 0]");
            line(format!("let b{i} = {base}{along};"));
            line(format!(
                "let p{i} = b{i} + R{i}*({}/10*{scale}*[3/5, 4/5, 0]);",
                body.length
            ));
            line(format!("let c{i} = (b{i} + p{i})/2;"));
            let (mass, inertia) = (body.mass, body.inertia);
            line(format!(
                "kinetic {mass}/20*norm2(der(c{i})) + {inertia}/200*{unit}^2*der(q{i})^2;"
            ));
            let gravity = format!("981/100*{scale}*{}^2", manner.time_unit);
            line(format!("potential {mass}/10*{gravity}*c{i}.y;"));
        }
        let mut ties: Vec<String> = self
            .loops
            .iter()
            .filter_map(|tie| self.tie(*tie, scale))
            .collect();
        if manner.reversed {
            ties.reverse();
        }
        for tie in ties {
            (0..manner.copies).for_each(|_| line(tie.clone()));
        }
        text + "}\n"
    }

    /// How many constraints it has.
    pub fn ties(&self) -> usize {
        self.loops
            .iter()
            .filter_map(|tie| self.tie(*tie, 1))
            .count()
    }

    /// The end of a body at a distance from that of another, or from a fixed point.
    fn tie(&self, (a, b, distance): (usize, usize, i32), scale: i32) -> Option<String> {
        let a = a % self.n();
        let other = match b < self.n() {
            true if a == b || self.hangs_on(a, b) || self.hangs_on(b, a) => return None,
            true => format!("p{b}"),
            false => format!("[{scale}, {scale}, 0]"),
        };
        Some(format!(
            "constraint norm2(p{a} - {other}) = ({distance}/10*{scale})^2;"
        ))
    }

    /// Whether one body hangs on another: their ends keep a distance anyway.
    fn hangs_on(&self, child: usize, parent: usize) -> bool {
        self.bodies[child].parent == parent && parent < child
    }
}
