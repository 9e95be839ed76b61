//! Parallelograms in random places of random trees of bodies in the plane.
//!
//! In:  random numbers.
//! Out: [`Tree`], a scene whose motion keeps its cranks parallel.

use super::smooth::{MOST, Smooth};
use bricard_testkit::Random;

/// A body: where it hangs, what it weighs.
#[derive(Clone, Copy, Debug)]
struct Body {
    /// The body it hangs on; nothing for the ground.
    parent: Option<usize>,
    /// The point of the parent that it turns about (m).
    at: [f64; 2],
    /// Its coordinate counts from the parent's direction.
    relative: bool,
    /// Two point masses: where, and the roots of their masses.
    masses: [([f64; 2], f64); 2],
    role: Role,
}

/// What turns a body.
#[derive(Clone, Copy, Debug)]
enum Role {
    /// A freedom of its own, of this number.
    Free(usize),
    /// A crank of a parallelogram: freedom, direction of its base in the parent.
    Crank(usize, f64),
    /// A coupler, whose direction is the base's: that of the parent's parent and more.
    Coupler(f64),
}

/// The closure of a parallelogram: coupler, its length; second crank, its length.
#[derive(Clone, Copy, Debug)]
struct Loop {
    coupler: (usize, f64),
    crank: (usize, f64),
    first: usize,
}

/// Parallelograms in a tree of bodies.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    bodies: Vec<Body>,
    loops: Vec<Loop>,
    freedoms: usize,
}

/// Gravity (m/s²), along a direction that is no axis.
const GRAVITY: [f64; 2] = [3.0, 9.0];

impl Tree {
    /// A tree with so many parallelograms and so many other bodies.
    pub fn new(random: &mut Random, loops: usize, others: usize) -> Self {
        let mut tree = Self::default();
        let (mut loops, mut others) = (loops, others);
        while loops + others > 0 {
            let place = random.below(loops + others);
            let count = tree.bodies.len();
            let parent = random.below(count + 1).checked_sub(1);
            if place < loops {
                tree.add_loop(random, parent);
                loops -= 1;
            } else {
                let role = Role::Free(tree.freedoms);
                tree.freedoms += 1;
                let at = [random.within(0.8), random.within(0.8)];
                tree.add(random, parent, at, role);
                others -= 1;
            }
        }
        tree
    }

    fn add(&mut self, random: &mut Random, parent: Option<usize>, at: [f64; 2], role: Role) {
        let mut mass = || {
            let at = [random.between(0.2, 0.8), random.within(0.3)];
            (at, random.between(0.6, 1.4))
        };
        let masses = [mass(), mass()];
        self.bodies.push(Body {
            parent,
            at,
            relative: random.below(2) == 0,
            masses,
            role,
        });
    }

    fn add_loop(&mut self, random: &mut Random, parent: Option<usize>) {
        let (base, length) = (random.within(3.0), random.between(0.5, 1.2));
        let crank = length * random.between(0.4, 0.8);
        let at = [random.within(0.6), random.within(0.6)];
        let other = [at[0] + length * base.cos(), at[1] + length * base.sin()];
        let (first, freedom) = (self.bodies.len(), self.freedoms);
        self.freedoms += 1;
        self.add(random, parent, at, Role::Crank(freedom, base));
        self.add(random, Some(first), [crank, 0.0], Role::Coupler(base));
        self.add(random, parent, other, Role::Crank(freedom, base));
        self.loops.push(Loop {
            coupler: (first + 1, length),
            crank: (first + 2, crank),
            first,
        });
    }

    /// Coordinates, freedoms, rows.
    pub fn sizes(&self) -> (usize, usize, usize) {
        (self.bodies.len(), self.freedoms, 2 * self.loops.len())
    }

    /// The direction of a body's parent.
    fn before<S: Smooth>(&self, angles: &[S; MOST], body: usize) -> S {
        let parent = self.bodies[body].parent;
        parent.map_or(S::of(0.0), |parent| angles[parent])
    }

    /// Directions of all bodies.
    fn angles<S: Smooth>(&self, q: &[S; MOST]) -> [S; MOST] {
        let mut angles = [S::of(0.0); MOST];
        for (i, body) in self.bodies.iter().enumerate() {
            angles[i] = match body.relative {
                true => self.before(&angles, i) + q[i],
                false => q[i],
            };
        }
        angles
    }

    /// Coordinates from independent ones.
    pub fn lift<S: Smooth>(&self, x: &[S; MOST]) -> [S; MOST] {
        let (mut angles, mut q) = ([S::of(0.0); MOST], [S::of(0.0); MOST]);
        for (i, body) in self.bodies.iter().enumerate() {
            let before = self.before(&angles, i);
            angles[i] = match body.role {
                Role::Free(freedom) => x[freedom],
                Role::Crank(freedom, base) => before + S::of(base) + x[freedom],
                Role::Coupler(base) => self.base(&angles, i) + S::of(base),
            };
            q[i] = match body.relative {
                true => angles[i] - before,
                false => angles[i],
            };
        }
        q
    }

    /// The direction of what the crank of a coupler hangs on.
    fn base<S: Smooth>(&self, angles: &[S; MOST], coupler: usize) -> S {
        let crank = self.bodies[coupler].parent;
        crank.map_or(S::of(0.0), |crank| self.before(angles, crank))
    }

    /// A point of a body, in space.
    fn point<S: Smooth>(
        &self,
        (sines, origins): (&[(S, S)], &[[S; 2]]),
        body: usize,
        at: [f64; 2],
    ) -> [S; 2] {
        let ((sin, cos), [x, y]) = (sines[body], origins[body]);
        let (a, b) = (S::of(at[0]), S::of(at[1]));
        [x + cos * a - sin * b, y + sin * a + cos * b]
    }

    /// Sines and cosines of all bodies, and where they turn.
    fn frames<S: Smooth>(&self, q: &[S; MOST]) -> (Vec<(S, S)>, Vec<[S; 2]>) {
        let angles = self.angles(q);
        let (mut sines, mut origins) = (Vec::new(), Vec::new());
        for (i, body) in self.bodies.iter().enumerate() {
            let origin = match body.parent {
                Some(parent) => self.point((&sines, &origins), parent, body.at),
                None => body.at.map(S::of),
            };
            origins.push(origin);
            sines.push(angles[i].sin_cos());
        }
        (sines, origins)
    }

    /// The constraints.
    pub fn rows<S: Smooth>(&self, q: &[S; MOST], out: &mut [S]) {
        let (sines, origins) = self.frames(q);
        for (i, closed) in self.loops.iter().enumerate() {
            let end = |(body, length)| self.point((&sines, &origins), body, [length, 0.0]);
            let (a, b) = (end(closed.coupler), end(closed.crank));
            (out[2 * i], out[2 * i + 1]) = (a[0] - b[0], a[1] - b[1]);
        }
    }

    /// Points of unit mass, and the potential behind them.
    pub fn points<S: Smooth>(&self, q: &[S; MOST], out: &mut [S]) {
        let (sines, origins) = self.frames(q);
        let (mut place, mut potential) = (0, S::of(0.0));
        for (i, body) in self.bodies.iter().enumerate() {
            for (at, root) in body.masses {
                for (x, g) in self
                    .point((&sines, &origins), i, at)
                    .into_iter()
                    .zip(GRAVITY)
                {
                    potential = potential + S::of(g * root * root) * x;
                    out[place] = S::of(root) * x;
                    place += 1;
                }
            }
        }
        out[place] = potential;
    }

    /// Cranks that are not parallel, couplers that are not level.
    pub fn off(&self, q: &[f64; MOST], out: &mut [f64]) {
        let angles = self.angles(q);
        for (i, closed) in self.loops.iter().enumerate() {
            let coupler = closed.coupler.0;
            let Role::Coupler(base) = self.bodies[coupler].role else {
                continue;
            };
            out[2 * i] = angles[closed.first] - angles[closed.crank.0];
            out[2 * i + 1] = angles[coupler] - self.base(&angles, coupler) - base;
        }
    }

    /// The functions that are zero at singular positions.
    pub fn crossings(&self, x: &[f64; MOST], out: &mut [f64]) {
        for (out, closed) in out.iter_mut().zip(&self.loops) {
            if let Role::Crank(freedom, _) = self.bodies[closed.first].role {
                *out = x[freedom].sin();
            }
        }
    }

    /// Independent coordinates and velocities.
    pub fn start(&self, random: &mut Random) -> ([f64; MOST], [f64; MOST]) {
        let (mut x, mut v) = ([0.0; MOST], [0.0; MOST]);
        for i in 0..self.freedoms {
            (x[i], v[i]) = (random.within(1.4), random.within(4.0));
        }
        (x, v)
    }
}
