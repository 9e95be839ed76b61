//! A Taylor series method for one degree of freedom.
//!
//! In:  a [`Reduction`], a state, a tolerance.
//! Out: the motion.
//!
//! The coefficients follow from one another by the products of power series. Source: Jorba
//! & Zou, Experimental Mathematics 14 (2005) 99–117; the step is the one of their section
//! 3.2, by the last two coefficients.

use bricard_testkit::Reduction;

/// The highest order.
pub const MOST: usize = 40;

type Series = [f64; MOST + 2];

/// `Σ aᵢ bₖ₋ᵢ`, `i = 0 … k`.
fn product(a: &Series, b: &Series, k: usize) -> f64 {
    let (a, b) = (&a[..=k], &b[..=k]);
    a.iter().zip(b.iter().rev()).map(|(a, b)| a * b).sum()
}

/// The series of all quantities of the equation of motion.
struct Motion {
    angle: Series,
    rate: Series,
    sine: Series,
    cosine: Series,
    /// Of twice the angle.
    double_sine: Series,
    double_cosine: Series,
    square: Series,
    acceleration: Series,
}

/// The next coefficients of the sine and the cosine of an angle that changes at a rate.
fn turn(sine: &mut Series, cosine: &mut Series, rate: &Series, factor: f64, k: usize) {
    let share = factor / (k + 1) as f64;
    (sine[k + 1], cosine[k + 1]) = (
        share * product(cosine, rate, k),
        -share * product(sine, rate, k),
    );
}

impl Motion {
    /// All coefficients up to an order, from a state.
    fn new(reduction: &Reduction, (angle, rate): (f64, f64), order: usize) -> Self {
        let zero = [0.0; MOST + 2];
        let mut all = Self {
            angle: zero,
            rate: zero,
            sine: zero,
            cosine: zero,
            double_sine: zero,
            double_cosine: zero,
            square: zero,
            acceleration: zero,
        };
        (all.angle[0], all.rate[0]) = (angle, rate);
        (all.sine[0], all.cosine[0]) = angle.sin_cos();
        (all.double_sine[0], all.double_cosine[0]) = (2.0 * angle).sin_cos();
        for k in 0..order {
            all.extend(reduction, k);
        }
        all
    }

    fn extend(&mut self, reduction: &Reduction, k: usize) {
        let Reduction {
            constant,
            ripple,
            weight,
            drive,
            damping,
        } = *reduction;
        self.square[k] = product(&self.rate, &self.rate, k);
        let mut moment = -damping * self.rate[k] - weight * self.cosine[k];
        if k == 0 {
            moment += drive;
        }
        let mass = constant + ripple * self.double_cosine[0];
        let mut rest = moment;
        if ripple != 0.0 {
            // The mass varies: its series takes part in a product and in a quotient.
            rest += ripple * product(&self.double_sine, &self.square, k);
            let known: f64 = (1..=k)
                .map(|i| self.double_cosine[i] * self.acceleration[k - i])
                .sum();
            rest -= ripple * known;
        }
        self.acceleration[k] = rest / mass;
        let share = 1.0 / (k + 1) as f64;
        self.angle[k + 1] = share * self.rate[k];
        self.rate[k + 1] = share * self.acceleration[k];
        turn(&mut self.sine, &mut self.cosine, &self.rate, 1.0, k);
        if ripple != 0.0 {
            let (sine, cosine) = (&mut self.double_sine, &mut self.double_cosine);
            turn(sine, cosine, &self.rate, 2.0, k);
        }
    }

    fn at(&self, h: f64, order: usize) -> (f64, f64) {
        let value = |series: &Series| {
            series[..=order]
                .iter()
                .rev()
                .fold(0.0, |sum, c| sum * h + c)
        };
        (value(&self.angle), value(&self.rate))
    }

    /// How long a step may be.
    fn step(&self, tolerance: f64, order: usize) -> f64 {
        let of = |k: usize| {
            let size = self.angle[k].abs().max(self.rate[k].abs());
            (tolerance / size).powf(1.0 / k as f64)
        };
        of(order).min(of(order - 1))
    }
}

/// The motion from a state for so long, and the number of steps.
pub fn after(
    reduction: &Reduction,
    mut state: (f64, f64),
    span: f64,
    (tolerance, order): (f64, usize),
) -> ((f64, f64), u32) {
    let (mut t, mut steps) = (0.0, 0);
    while t < span {
        let motion = Motion::new(reduction, state, order);
        let h = motion.step(tolerance, order).min(span - t);
        state = motion.at(h, order);
        t = if h == span - t { span } else { t + h };
        steps += 1;
    }
    (state, steps)
}
