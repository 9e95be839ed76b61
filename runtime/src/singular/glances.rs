//! First looks into a step that is searched for passages.
//!
//! In:  a step, the chart at its start.
//! Out: [`Glance`]s at determinants, where they have a sign, with their rates.

use super::differences::{VALUES, differentiated, place};
use super::found::Searched;
use super::sheet::Sheet;
use crate::Real;
use crate::linalg::Workspace;
use crate::tolerance::{regular, resolved};

/// How far from a look in a singular configuration it is looked instead, as parts of a step.
const BESIDE: [f64; 3] = [1e-6, 1e-4, 1e-2];
/// Looks into a step, equally far apart, its start among them.
pub(super) const LOOKS: usize = VALUES;

/// What a first look into a step sees.
pub(super) struct Glance<T> {
    pub(super) t: T,
    pub(super) determinant: T,
    /// The sine by which the weakest constraint is independent.
    pub(super) sine: T,
    /// How many rows may turn against others.
    rows: usize,
}

/// What a look sees, if anything, and how fast the determinant changes there (1/s).
pub(super) type Seen<T> = (Option<Glance<T>>, Option<T>);

impl<T: Real> Sheet<'_, T> {
    /// The last look at the steps before that told a sign, if this one starts where none can be
    /// told.
    pub(super) fn left_open(&mut self, step: &Searched<'_, T>) -> Option<Glance<T>> {
        let (t, q) = step.open?;
        let start = self.eliminate_widely(step.start.t, step.start.q);
        let tells = start.is_ok() && self.frame.smallest() > regular();
        match tells {
            true => None,
            false => self.glance(t, q),
        }
    }

    /// How long the way through a step is, from one look to the next.
    pub(super) fn path(&self, step: &Searched<'_, T>, workspace: &Workspace<'_, T>) -> T {
        workspace.scope(|workspace| {
            let [q, last] = [(); 2].map(|()| workspace.numbers(self.chart.n()));
            let ends = (step.start.t, step.start.t + step.length);
            let mut path = T::zero();
            for k in 0..LOOKS {
                step.position(place(ends, k), q);
                if k > 0 {
                    path += self.chart.apart(q, last);
                }
                last.copy_from_slice(q);
            }
            path
        })
    }

    /// Looks at determinants between two times of a step, with their rates.
    pub(super) fn glances(
        &mut self,
        step: &Searched<'_, T>,
        between: (T, T),
        workspace: &Workspace<'_, T>,
    ) -> [Seen<T>; LOOKS] {
        let length = between.1 - between.0;
        let seen = core::array::from_fn(|k| {
            let t = place(between, k);
            self.glance_at(step, t, workspace).or_else(|| {
                // In a singular configuration no sign can be told, but close to it.
                let inward = if k + 1 == LOOKS { -length } else { length };
                let mut beside = BESIDE.iter().map(|part| t + inward * T::from_f64(*part));
                beside.find_map(|t| self.glance_at(step, t, workspace))
            })
        });
        let mut rates = rates(&seen, between).into_iter();
        seen.map(|glance| (glance, rates.next().flatten()))
    }

    /// The determinant at a time of a step, where it has a sign.
    fn glance_at(
        &mut self,
        step: &Searched<'_, T>,
        t: T,
        workspace: &Workspace<'_, T>,
    ) -> Option<Glance<T>> {
        workspace.scope(|workspace| {
            let q = workspace.numbers(self.chart.n());
            step.position(t, q);
            self.glance(t, q)
        })
    }

    /// The determinant at a position, where it has a sign.
    fn glance(&mut self, t: T, q: &[T]) -> Option<Glance<T>> {
        self.eliminate_widely(t, q).ok()?;
        let sine = self.frame.smallest();
        (sine > resolved()).then(|| Glance {
            t,
            determinant: self.frame.determinant(),
            sine,
            rows: self.frame.block().size(),
        })
    }
}

/// How fast the determinant changes (1/s) at looks between two times; `None` where one is
/// missing or elsewhere, or several rows may turn.
fn rates<T: Real>(seen: &[Option<Glance<T>>; LOOKS], between: (T, T)) -> [Option<T>; LOOKS] {
    let [Some(a), Some(b), Some(c), Some(d), Some(e)] = seen else {
        return [None; LOOKS];
    };
    let all = [a, b, c, d, e];
    let mut in_place = all.iter().enumerate();
    let in_place = in_place.all(|(k, glance)| glance.t == place(between, k));
    // A polynomial of fourth degree is no picture of the determinant of more rows.
    if !in_place || all.iter().any(|glance| glance.rows >= LOOKS) {
        return [None; LOOKS];
    }
    let part = (between.1 - between.0) / T::from_f64((LOOKS - 1) as f64);
    differentiated(all.map(|glance| glance.determinant), part).map(Some)
}
