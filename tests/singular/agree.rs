//! Whether a reduction moves as the whole can.
//!
//! In:  a [`Trial`] with a reduction.
//! Out: what the exact motion is off by, put into the equations of the whole: constraints,
//!      their rates, invariants, conserved energy.

use crate::exact::exact;
use crate::track::{OUTPUTS, larger};
use crate::trial::{Compare, Trial};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Interface, Mechanism, Position, State, Visitor, Whole};

/// Times at which both are compared.
const TIMES: usize = 40;

/// What the reduction of a trial is off by; nothing where it has none.
pub fn contradiction(trial: &Trial) -> Option<f64> {
    let (Compare::Reduction(reduced) | Compare::Turning(reduced)) = trial.compare else {
        return None;
    };
    let time = |i: usize| trial.until * i as f64 / TIMES as f64;
    let times: Vec<f64> = (0..=TIMES).map(time).collect();
    if let Some(planted) = &trial.planted {
        let numbers = planted.exact(&times).numbers;
        return Some(planted.off(&times, &numbers));
    }
    let visitor = Put {
        trial,
        reduced,
        times,
    };
    crate::descriptions::visit(trial.mechanism, visitor)
}

/// Puts a motion into the equations of a mechanism.
pub fn put<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    times: &[f64],
    numbers: &[f64],
) -> f64 {
    let (mut worst, mut first) = (0.0, None);
    for (t, row) in times.iter().zip(numbers.chunks(2 * N)) {
        let (q, v) = row.split_at(N);
        let state = State::new(
            *t,
            SVector::from_column_slice(q),
            SVector::from_column_slice(v),
        );
        let mut position: Position<f64, N, R> = Position::default();
        mechanism.position(&state, &mut position);
        let rate = position.jacobian * state.v + position.drift;
        let mut values = [0.0; OUTPUTS];
        mechanism.outputs(&state, &mut values);
        let off = position.residual.iter().chain(rate.iter()).chain(&values);
        worst = off.fold(worst, |worst, x| larger(worst, x.abs()));
        if mechanism.structure().conservative {
            let energy = mechanism.energy(&state).balance;
            let change = energy - *first.get_or_insert(energy);
            worst = larger(worst, change.abs() / (1.0 + energy.abs()));
        }
    }
    worst
}

struct Put<'a> {
    trial: &'a Trial,
    reduced: &'static str,
    times: Vec<f64>,
}

impl Visitor<f64> for Put<'_> {
    type Output = f64;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> f64
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let Trial {
            mechanism: name,
            set,
            ..
        } = self.trial;
        let parameters = mechanism.structure().parameters;
        for (name, value) in set {
            let place = parameters.iter().position(|p| p.name == *name);
            mechanism.set_parameter(place.expect("it is a parameter"), *value);
        }
        let exact = exact(name, self.reduced, set, N, &self.times);
        put::<N, R>(&mechanism, &self.times, &exact.numbers)
    }
}
