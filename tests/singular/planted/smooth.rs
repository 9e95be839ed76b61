//! Numbers that carry derivatives.
//!
//! Out: [`Smooth`], the operations that scenes are made of; [`Slope`], with all first
//!      derivatives; [`Path`], with the first two along a path.

use core::array::from_fn;
use core::ops::{Add, Mul, Sub};

/// Coordinates that a scene may have.
pub const MOST: usize = 8;

/// A number that scenes are computed with.
pub trait Smooth: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A constant.
    fn of(value: f64) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
}

impl Smooth for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
}

/// A value and its derivatives by all coordinates, the last one that by time.
#[derive(Clone, Copy, Debug)]
pub struct Slope {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub by: [f64; MOST + 1],
}

impl Slope {
    /// The variable at a place.
    pub fn variable(value: f64, place: usize) -> Self {
        let by = from_fn(|i| f64::from(u8::from(i == place)));
        Self { value, by }
    }
}

/// The product rule.
fn rule((a, da): (f64, f64), (b, db): (f64, f64)) -> f64 {
    da * b + a * db
}

impl Add for Slope {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            by: from_fn(|i| self.by[i] + other.by[i]),
        }
    }
}

impl Sub for Slope {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            by: from_fn(|i| self.by[i] - other.by[i]),
        }
    }
}

impl Mul for Slope {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            by: from_fn(|i| rule((self.value, self.by[i]), (other.value, other.by[i]))),
        }
    }
}

impl Smooth for Slope {
    fn of(value: f64) -> Self {
        let by = [0.0; MOST + 1];
        Self { value, by }
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        let (up, down) = (self.by.map(|x| x * cos), self.by.map(|x| -x * sin));
        (
            Self { value: sin, by: up },
            Self {
                value: cos,
                by: down,
            },
        )
    }
}

/// A value along a path, with its first two derivatives by the path's parameter.
#[derive(Clone, Copy, Debug)]
pub struct Path(
    /// Value, first and second derivative.
    pub [f64; 3],
);

impl Add for Path {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Path {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul for Path {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([a, da, dda], [b, db, ddb]) = (self.0, other.0);
        Self([a * b, da * b + a * db, dda * b + 2.0 * da * db + a * ddb])
    }
}

impl Smooth for Path {
    fn of(value: f64) -> Self {
        Self([value, 0.0, 0.0])
    }

    fn sin_cos(self) -> (Self, Self) {
        let [x, dx, ddx] = self.0;
        let (sin, cos) = x.sin_cos();
        (
            Self([sin, cos * dx, cos * ddx - sin * dx * dx]),
            Self([cos, -sin * dx, -sin * ddx - cos * dx * dx]),
        )
    }
}
