//! The chain written by hand in the angles of its rods, as whoever knows it would.
//!
//! In:  angles and their rates, whether the last end is on the ground, too.
//! Out: accelerations, with as many operations as there are rods.
//!
//! The forces at the joints are the unknowns: with `n` across a rod and `B = 3/m · n nᵀ`,
//! that the ends of neighbours have the same acceleration reads
//! `(B₋ − 1/m) F₋ + (2/m + B₋ + B) F + (B − 1/m) F₊ = −a₋ − a`, one block of two equations
//! for each joint with its neighbours, solved by elimination from the first to the last.
//! A closed chain is kept closed as Baumgarte does.

use std::ops::{Add, Mul, Sub};

/// Length of a rod (m).
pub const LENGTH: f64 = 0.5;
/// Its mass (kg).
const MASS: f64 = 1.0;
/// Its moment of inertia about its centre (kg m²).
const INERTIA: f64 = MASS * LENGTH * LENGTH / 12.0;
const GRAVITY: f64 = 9.81;
/// Part of the length of a closed chain by which its ends are apart.
pub const SPAN: f64 = 0.8;
/// Baumgarte's gain (1/s); the one that survives longest in `peers-simulators`.
const GAIN: f64 = 50.0;

/// A vector in the plane.
#[derive(Clone, Copy, Debug, Default)]
struct Vector([f64; 2]);

/// A matrix in the plane, by rows.
#[derive(Clone, Copy, Debug, Default)]
struct Matrix([[f64; 2]; 2]);

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other.times(-1.0)
    }
}

impl Vector {
    fn times(self, factor: f64) -> Self {
        Self(self.0.map(|entry| factor * entry))
    }

    fn dot(self, other: Self) -> f64 {
        self.0[0] * other.0[0] + self.0[1] * other.0[1]
    }
}

impl Mul<Vector> for Matrix {
    type Output = Vector;
    fn mul(self, x: Vector) -> Vector {
        Vector(self.0.map(|row| Vector(row).dot(x)))
    }
}

impl Mul for Matrix {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let [[a, b], [c, d]] = other.0;
        let (first, second) = (Vector([a, c]), Vector([b, d]));
        Self(
            self.0
                .map(|row| [Vector(row).dot(first), Vector(row).dot(second)]),
        )
    }
}

impl Matrix {
    fn multiple(factor: f64) -> Self {
        Self([[factor, 0.0], [0.0, factor]])
    }

    fn plus(self, other: Self, factor: f64) -> Self {
        let entry = |i: usize, j: usize| self.0[i][j] + factor * other.0[i][j];
        Self([[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]])
    }

    fn inverse(self) -> Self {
        let [[a, b], [c, d]] = self.0;
        let scale = 1.0 / (a * d - b * c);
        Self([[d * scale, -b * scale], [-c * scale, a * scale]])
    }
}

/// What is known of a rod before the forces are.
#[derive(Clone, Copy, Debug, Default)]
struct Rod {
    /// Along and across it.
    along: Vector,
    across: Vector,
    /// `B = 3/m · n nᵀ`.
    turning: Matrix,
    /// Half of its length times the square of its rate, along it.
    centripetal: Vector,
}

impl Rod {
    fn new(angle: f64, rate: f64) -> Self {
        let (s, c) = angle.sin_cos();
        let (along, across) = (Vector([s, -c]), Vector([c, s]));
        let weight = 3.0 / MASS;
        Self {
            along,
            across,
            turning: Matrix([
                [weight * c * c, weight * c * s],
                [weight * c * s, weight * s * s],
            ]),
            centripetal: along.times(LENGTH / 2.0 * rate * rate),
        }
    }
}

/// Chains of one length, with room for what an acceleration needs.
#[derive(Clone, Debug)]
pub struct Chain {
    closed: bool,
    rods: Vec<Rod>,
    /// Of each joint: the inverse of its block, after elimination, and its right-hand side;
    /// then the force at it.
    blocks: Vec<Matrix>,
    forces: Vec<Vector>,
}

impl Chain {
    /// A chain of `n` rods.
    pub fn new(n: usize, closed: bool) -> Self {
        Self {
            closed,
            rods: vec![Rod::default(); n],
            blocks: vec![Matrix::default(); n + 1],
            forces: vec![Vector::default(); n + 1],
        }
    }

    /// The angles that a run begins with.
    pub fn start(&self) -> Vec<f64> {
        let n = self.rods.len();
        let angle = |rod: usize| match (self.closed, 2 * rod < n) {
            (false, _) => 1.0,
            (true, true) => SPAN.asin(),
            (true, false) => std::f64::consts::PI - SPAN.asin(),
        };
        (0..n).map(angle).collect()
    }

    /// Writes the accelerations of the angles.
    pub fn accelerations(&mut self, angles: &[f64], rates: &[f64], out: &mut [f64]) {
        let motion = angles.iter().zip(rates);
        for (rod, (angle, rate)) in self.rods.iter_mut().zip(motion) {
            *rod = Rod::new(*angle, *rate);
        }
        self.eliminate(rates);
        for (i, (rod, out)) in self.rods.iter().zip(out).enumerate() {
            let force = self.forces[i] + self.forces[i + 1];
            *out = -LENGTH / (2.0 * INERTIA) * rod.across.dot(force);
        }
    }

    /// The forces at the joints.
    fn eliminate(&mut self, rates: &[f64]) {
        let n = self.rods.len();
        let weight = Vector([0.0, GRAVITY]);
        let light = Matrix::multiple(1.0 / MASS);
        let joints = if self.closed { n + 1 } else { n };
        self.forces[n] = Vector::default();
        for joint in 0..joints {
            let (mut block, mut right) = (Matrix::default(), Vector::default());
            if joint < n {
                let rod = &self.rods[joint];
                block = light.plus(rod.turning, 1.0);
                right = weight - rod.centripetal;
            } else {
                right = right - self.opening(rates);
            }
            if joint > 0 {
                let rod = &self.rods[joint - 1];
                block = block.plus(light.plus(rod.turning, 1.0), 1.0);
                right = right - weight - rod.centripetal;
                // It is symmetric, as that of the joint before it to this one.
                let coupling = rod.turning.plus(light, -1.0);
                let share = coupling * self.blocks[joint - 1];
                block = block.plus(share * coupling, -1.0);
                right = right - share * self.forces[joint - 1];
            }
            self.blocks[joint] = block.inverse();
            self.forces[joint] = right;
        }
        for joint in (0..joints).rev() {
            let mut right = self.forces[joint];
            if joint + 1 < joints {
                let coupling = self.rods[joint].turning.plus(light, -1.0);
                right = right - coupling * self.forces[joint + 1];
            }
            self.forces[joint] = self.blocks[joint] * right;
        }
    }

    /// The acceleration that the last end of a closed chain should have.
    fn opening(&self, rates: &[f64]) -> Vector {
        let n = self.rods.len();
        let mut gap = Vector([-SPAN * LENGTH * n as f64, 0.0]);
        let mut speed = Vector::default();
        for (rod, rate) in self.rods.iter().zip(rates) {
            gap = gap + rod.along.times(LENGTH);
            speed = speed + rod.across.times(LENGTH * rate);
        }
        speed.times(-2.0 * GAIN) - gap.times(GAIN * GAIN)
    }
}
