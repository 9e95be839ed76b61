//! Samples of the determinant along a step that is searched for passages.
//!
//! In:  a step, the chart at its start.
//! Out: [`Sample`]s where the determinant has a sign, with its rates.

use super::differences::{VALUES, differentiated, place};
use super::found::Searched;
use super::sheet::Sheet;
use crate::Real;
use crate::linalg::Workspace;
use crate::tolerance::{regular, resolved, window};

/// How far from a singular configuration a sample is taken instead, as parts of a step.
const BESIDE: [f64; 3] = [1e-6, 1e-4, 1e-2];
/// The inside of a step may be this many times as far off the motion as it is off the constraints.
const UNKNOWN: f64 = 8.0;
/// Samples of a step, equally far apart, its start among them.
pub(super) const SAMPLES: usize = VALUES;

/// The determinant at a time of a step.
pub(super) struct Sample<T> {
    pub(super) t: T,
    pub(super) determinant: T,
    /// The sine by which the weakest constraint is independent.
    pub(super) sine: T,
    /// How many rows may turn against others.
    rows: usize,
}

/// A sample, if the determinant has a sign, and how fast it changes there (1/s).
pub(super) type Sampled<T> = (Option<Sample<T>>, Option<T>);

impl<T: Real> Sheet<'_, T> {
    /// The last sample of earlier steps that has a sign, if this step starts where no sign can be
    /// told.
    pub(super) fn open_sample(
        &mut self,
        step: &Searched<'_, T>,
        workspace: &Workspace<'_, T>,
    ) -> Option<Sample<T>> {
        let (t, q) = step.open?;
        let start = self.eliminate_widely(step.start.t, step.start.q);
        let tells = start.is_ok() && self.frame.smallest() > regular();
        match tells {
            true => None,
            false => workspace.scope(|workspace| {
                let open = workspace.numbers(q.len());
                open.copy_from_slice(q);
                self.sample(t, open)
            }),
        }
    }

    /// How long the path of a step is, from one sample to the next.
    pub(super) fn path(&self, step: &Searched<'_, T>, workspace: &Workspace<'_, T>) -> T {
        workspace.scope(|workspace| {
            let [q, last] = [(); 2].map(|()| workspace.numbers(self.chart.n()));
            let ends = (step.start.t, step.start.t + step.length);
            let mut path = T::zero();
            for k in 0..SAMPLES {
                step.position(place(ends, k), q);
                if k > 0 {
                    path += self.chart.apart(q, last);
                }
                last.copy_from_slice(q);
            }
            path
        })
    }

    /// Samples between two times of a step, with their rates.
    pub(super) fn samples(
        &mut self,
        step: &Searched<'_, T>,
        between: (T, T),
        workspace: &Workspace<'_, T>,
    ) -> [Sampled<T>; SAMPLES] {
        let length = between.1 - between.0;
        let sampled = core::array::from_fn(|k| {
            let t = place(between, k);
            self.sample_at(step, t, workspace).or_else(|| {
                // In a singular configuration no sign can be told, but close to it.
                let inward = if k + 1 == SAMPLES { -length } else { length };
                let mut beside = BESIDE.iter().map(|part| t + inward * T::from_f64(*part));
                beside.find_map(|t| self.sample_at(step, t, workspace))
            })
        });
        let mut rates = rates(&sampled, between).into_iter();
        sampled.map(|sample| (sample, rates.next().flatten()))
    }

    /// The determinant at a time of a step, where it has a sign.
    fn sample_at(
        &mut self,
        step: &Searched<'_, T>,
        t: T,
        workspace: &Workspace<'_, T>,
    ) -> Option<Sample<T>> {
        workspace.scope(|workspace| {
            let q = workspace.numbers(self.chart.n());
            step.position(t, q);
            self.sample(t, q)
        })
    }

    /// The determinant at a position, where it has a sign; the position is used up.
    fn sample(&mut self, t: T, q: &mut [T]) -> Option<Sample<T>> {
        self.eliminate_widely(t, q).ok()?;
        let sample = Sample {
            t,
            determinant: self.frame.determinant(),
            sine: self.frame.smallest(),
            rows: self.frame.block().size(),
        };
        let is_told = sample.sine > window() || self.tells(sample.sine, sample.determinant, (t, q));
        is_told.then_some(sample)
    }

    /// Whether the sign of a determinant next to a singular configuration, at a position whose
    /// frame is at hand, is certain although the inside of a step is off the constraints; the
    /// position is used up.
    pub(super) fn tells(&mut self, sine: T, determinant: T, (t, q): (T, &mut [T])) -> bool {
        self.correct(q);
        match self.eliminate_widely(t, q) {
            Ok(()) => {
                let change = (self.frame.determinant() - determinant).abs();
                sine > resolved() && determinant.abs() > change * T::from_f64(UNKNOWN)
            }
            Err(_) => false,
        }
    }
}

/// How fast the determinant changes (1/s) at samples between two times; `None` where a sample is
/// missing or was taken beside its place, or where too many rows may turn.
fn rates<T: Real>(sampled: &[Option<Sample<T>>; SAMPLES], between: (T, T)) -> [Option<T>; SAMPLES] {
    let [Some(a), Some(b), Some(c), Some(d), Some(e)] = sampled else {
        return [None; SAMPLES];
    };
    let all = [a, b, c, d, e];
    let mut in_place = all.iter().enumerate();
    let in_place = in_place.all(|(k, sample)| sample.t == place(between, k));
    // A polynomial of fourth degree does not follow the determinant of more than four rows that
    // turn.
    if !in_place || all.iter().any(|sample| sample.rows >= SAMPLES) {
        return [None; SAMPLES];
    }
    let part = (between.1 - between.0) / T::from_f64((SAMPLES - 1) as f64);
    differentiated(all.map(|sample| sample.determinant), part).map(Some)
}
