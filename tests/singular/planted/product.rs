//! Products of surfaces in random coordinates: (w − f(x, t)) (w − h(x, t)) = 0.
//!
//! In:  random numbers.
//! Out: [`Product`], a scene whose motion stays on w = f.
//!
//! `x` and `w` are warped into the coordinates `q`, and the rows are mixed, so that
//! neither is seen in the constraints.

use super::smooth::{MOST, Smooth};
use super::wave::{Warp, Wave};
use bricard_testkit::Random;
use core::array::from_fn;

/// Rows that a product scene may have.
pub const ROWS: usize = 2;

/// One row, its surface and what the other surface is away from it.
#[derive(Clone, Debug)]
struct Row {
    own: Wave,
    /// Nothing where the row has one surface only.
    other: Option<Other>,
    /// Size and frequency of a lift of both surfaces.
    lift: (f64, f64),
}

/// h − f: zero where the surfaces cross.
#[derive(Clone, Debug)]
struct Other {
    slope: f64,
    along: [f64; MOST],
    place: f64,
    /// Half the distance of two crossings, if there are two.
    apart: Option<f64>,
    bend: Wave,
}

/// Products of surfaces in random coordinates.
#[derive(Clone, Debug)]
pub struct Product {
    /// Coordinates, freedoms, rows.
    pub sizes: (usize, usize, usize),
    warps: [Warp; 2],
    rows: Vec<Row>,
    mixed: [[f64; ROWS]; ROWS],
    metric: [(Wave, f64); MOST],
    potential: Wave,
}

impl Other {
    fn new(random: &mut Random, n: usize) -> Self {
        let mut along = from_fn(|i| if i < n { random.within(1.0) } else { 0.0 });
        let norm = along.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
        along = along.map(|x| x / norm);
        Self {
            slope: random.signed_decade(0.2, 1.5),
            along,
            place: random.within(0.3),
            apart: (random.below(4) == 0).then(|| random.decade(0.05, 0.3)),
            bend: Wave::new(random, n, 0.2),
        }
    }

    fn at<S: Smooth>(&self, x: &[S; MOST], n: usize) -> S {
        let pairs = self.along.iter().zip(x).take(n);
        let along = pairs.fold(S::of(-self.place), |sum, (a, x)| sum + S::of(*a) * *x);
        let bent = along + S::of(0.5) * self.bend.at(x, n) * along;
        let distance = match self.apart {
            Some(apart) => bent * bent - S::of(apart * apart),
            None => bent,
        };
        S::of(self.slope) * distance
    }
}

impl Product {
    /// A scene of `n` freedoms and `k` rows; the first row is a product.
    pub fn new(random: &mut Random, n: usize, k: usize) -> Self {
        let all = n + k;
        let moving = random.below(3) == 0;
        let row = |random: &mut Random, i: usize| Row {
            own: Wave::new(random, n, 0.6),
            other: (i == 0 || random.below(2) == 0).then(|| Other::new(random, n)),
            lift: match moving {
                true => (random.within(0.2), random.between(2.0, 7.0)),
                false => (0.0, 1.0),
            },
        };
        let rows = (0..k).map(|i| row(random, i)).collect();
        let warps = [Warp::new(random, all), Warp::new(random, all)];
        let turned = random.within(1.0);
        let scale = random.decade(0.1, 10.0);
        Self {
            sizes: (all, n, k),
            warps,
            rows,
            mixed: [[scale, turned], [-turned, 1.0]],
            metric: from_fn(|_| (Wave::new(random, all, 0.15), random.between(0.6, 1.6))),
            potential: Wave::new(random, all, 2.0),
        }
    }

    fn own<S: Smooth>(&self, row: usize, x: &[S; MOST], t: S) -> S {
        let Row { own, lift, .. } = &self.rows[row];
        let (sin, _) = (S::of(lift.1) * t).sin_cos();
        own.at(x, self.sizes.1) + S::of(lift.0) * sin
    }

    /// `x` and, for each row, w − f.
    fn seen<S: Smooth>(&self, q: &[S; MOST], t: S) -> ([S; MOST], [S; ROWS]) {
        let (_, n, k) = self.sizes;
        let y = self.warps[1].forth(&self.warps[0].forth(q));
        let off = from_fn(|i| match i < k {
            true => y[n + i] - self.own(i, &y, t),
            false => S::of(0.0),
        });
        (y, off)
    }

    /// Coordinates from independent ones.
    pub fn lift<S: Smooth>(&self, x: &[S; MOST], t: S) -> [S; MOST] {
        let (_, n, k) = self.sizes;
        let mut y = *x;
        for i in 0..k {
            y[n + i] = self.own(i, x, t);
        }
        self.warps[0].back(&self.warps[1].back(&y))
    }

    /// The constraints.
    pub fn rows<S: Smooth>(&self, q: &[S; MOST], t: S, out: &mut [S]) {
        let (_, n, k) = self.sizes;
        let (x, off) = self.seen(q, t);
        let value: [S; ROWS] = from_fn(|i| match self.rows.get(i).map(|row| &row.other) {
            Some(Some(other)) => off[i] * (off[i] - other.at(&x, n)),
            _ => off[i],
        });
        for (out, mixed) in out.iter_mut().zip(&self.mixed).take(k) {
            let terms = mixed.iter().zip(value).take(k);
            let terms = terms.map(|(part, value)| S::of(*part) * value);
            *out = terms.fold(S::of(0.0), |sum, term| sum + term);
        }
    }

    /// What the sheet is left by.
    pub fn off(&self, q: &[f64; MOST], t: f64) -> [f64; ROWS] {
        self.seen(q, t).1
    }

    /// The functions that are zero at singular positions.
    pub fn crossings(&self, x: &[f64; MOST], out: &mut [f64]) {
        let others = self.rows.iter().filter_map(|row| row.other.as_ref());
        for (out, other) in out.iter_mut().zip(others) {
            *out = other.at(x, self.sizes.1);
        }
    }

    /// Whether nothing in it moves by a clock.
    pub fn conservative(&self) -> bool {
        self.rows.iter().all(|row| row.lift.0 == 0.0)
    }

    /// Points of unit mass, and the potential behind them.
    pub fn points<S: Smooth>(&self, q: &[S; MOST], out: &mut [S]) {
        let all = self.sizes.0;
        let mut potential = self.potential.at(q, all);
        for i in 0..all {
            let (wave, root) = &self.metric[i];
            out[i] = S::of(*root) * (q[i] + wave.at(q, all));
            potential = potential + S::of(0.5) * q[i] * q[i];
        }
        out[all] = potential;
    }

    /// Independent coordinates and velocities that lead towards a crossing.
    pub fn start(&self, random: &mut Random) -> ([f64; MOST], [f64; MOST]) {
        let other = self.rows[0]
            .other
            .as_ref()
            .expect("the first row is a product");
        let (back, speed) = (random.between(0.3, 0.8), random.between(1.0, 4.0));
        let part = |i: usize, size: f64| if i < self.sizes.1 { size } else { 0.0 };
        let x = from_fn(|i| {
            part(
                i,
                other.along[i] * (other.place - back) + 0.2 * random.within(1.0),
            )
        });
        let v = from_fn(|i| part(i, other.along[i] * speed + random.within(0.7)));
        (x, v)
    }
}
