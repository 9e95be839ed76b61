//! Random smooth functions, and random changes of coordinates that can be undone exactly.
//!
//! In:  random numbers.
//! Out: [`Wave`], [`Warp`].

use super::smooth::{MOST, Smooth};
use bricard_testkit::Random;
use core::array::from_fn;

/// A polynomial of degree two and two sines of random directions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wave {
    constant: f64,
    linear: [f64; MOST],
    /// A direction, and the factor of its square.
    square: ([f64; MOST], f64),
    /// Directions, phases and sizes.
    sines: [([f64; MOST], f64, f64); 2],
}

fn dot<S: Smooth>(weights: &[f64; MOST], x: &[S; MOST], n: usize) -> S {
    let terms = weights.iter().zip(x).take(n);
    terms.fold(S::of(0.0), |sum, (weight, x)| sum + S::of(*weight) * *x)
}

fn direction(random: &mut Random, n: usize) -> [f64; MOST] {
    let size = 1.0 / n.max(1) as f64;
    from_fn(|_| size * random.within(1.5))
}

impl Wave {
    /// A function of this size of `n` arguments.
    pub fn new(random: &mut Random, n: usize, size: f64) -> Self {
        let linear = direction(random, n).map(|x| size * x);
        let square = (direction(random, n), size * random.within(0.5));
        let mut sine = || {
            let along = direction(random, n).map(|x| 2.0 * x);
            (along, random.within(3.0), size * random.within(0.5))
        };
        let sines = [sine(), sine()];
        Self {
            constant: size * random.within(0.5),
            linear,
            square,
            sines,
        }
    }

    /// Its value at the first `n` arguments.
    pub fn at<S: Smooth>(&self, x: &[S; MOST], n: usize) -> S {
        let square = dot(&self.square.0, x, n);
        let mut value = S::of(self.constant) + dot(&self.linear, x, n);
        value = value + S::of(self.square.1) * square * square;
        for (along, phase, size) in &self.sines {
            let (sin, _) = (dot(along, x, n) + S::of(*phase)).sin_cos();
            value = value + S::of(*size) * sin;
        }
        value
    }
}

/// A rotation, then a shear: yᵢ = uᵢ + sᵢ(u₀ … uᵢ₋₁) with u = Q q.
#[derive(Clone, Debug)]
pub struct Warp {
    n: usize,
    rotation: [[f64; MOST]; MOST],
    shears: [Wave; MOST],
}

impl Warp {
    /// A warp of `n` coordinates.
    pub fn new(random: &mut Random, n: usize) -> Self {
        let mut rotation = from_fn(|i| from_fn(|j| f64::from(u8::from(i == j))));
        for i in 0..n {
            for j in 0..i {
                let (sin, cos) = random.within(3.0).sin_cos();
                let (a, b): ([f64; MOST], [f64; MOST]) = (rotation[i], rotation[j]);
                rotation[i] = from_fn(|k| cos * a[k] + sin * b[k]);
                rotation[j] = from_fn(|k| cos * b[k] - sin * a[k]);
            }
        }
        let shears = from_fn(|i| {
            if i > 0 {
                Wave::new(random, i, 0.4)
            } else {
                Wave::default()
            }
        });
        Self {
            n,
            rotation,
            shears,
        }
    }

    /// From `q` to `y`.
    pub fn forth<S: Smooth>(&self, q: &[S; MOST]) -> [S; MOST] {
        let u: [S; MOST] = from_fn(|i| match i < self.n {
            true => dot(&self.rotation[i], q, self.n),
            false => S::of(0.0),
        });
        from_fn(|i| match i < self.n {
            true => u[i] + self.shears[i].at(&u, i),
            false => S::of(0.0),
        })
    }

    /// From `y` to `q`.
    pub fn back<S: Smooth>(&self, y: &[S; MOST]) -> [S; MOST] {
        let mut u = [S::of(0.0); MOST];
        for i in 0..self.n {
            u[i] = y[i] - self.shears[i].at(&u, i);
        }
        let column = |i: usize| from_fn(|j| self.rotation[j][i]);
        from_fn(|i| match i < self.n {
            true => dot(&column(i), &u, self.n),
            false => S::of(0.0),
        })
    }
}
