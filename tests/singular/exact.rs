//! The exact motion: a reduction without constraints, integrated as far as doubles go.
//!
//! In:  the name of a reduction, parameters, times.
//! Out: [`Exact`]: all coordinates and velocities at the times, and how often the
//!      functions that are zero at singular positions changed their signs.
//!
//! A reduction has the coordinates and velocities of the whole as its outputs, and the
//! functions that are zero at singular positions as its events.

use crate::track::{OUTPUTS, larger};
use crate::trial::Set;
use bricard_runtime::{
    Audit, DynamicsError, Interface, Mechanism, Observer, Options, Probe, State, Step, Visitor,
    Whole, assemble, simulate,
};
use std::ops::ControlFlow;

/// Tolerance of reductions.
const TOLERANCE: f64 = 1e-13;
/// How often each step is looked at for changes of sign.
const LOOKS: usize = 16;
/// Events that a reduction may have.
const EVENTS: usize = 4;
/// A function that turns nearer to zero than this may have changed its sign twice between
/// two looks.
const UNCLEAR: f64 = 1e-4;

/// The exact motion.
#[derive(Clone, Debug, Default)]
pub struct Exact {
    /// Coordinates and velocities of the whole at each time.
    pub numbers: Vec<f64>,
    /// Changes of sign up to the last time; `None` if they can't be counted safely.
    pub crossings: Option<u64>,
}

/// Follows a reduction.
struct Follow<'a, const N: usize, const R: usize> {
    mechanism: &'a dyn Whole<f64, N, R>,
    times: &'a [f64],
    width: usize,
    next: usize,
    exact: Exact,
    /// The event functions at the last two looks.
    looks: [[f64; EVENTS]; 2],
    unclear: bool,
}

impl<const N: usize, const R: usize> Follow<'_, N, R> {
    fn take(&mut self, state: &State<f64, N>) {
        let mut values = [0.0; OUTPUTS];
        self.mechanism.outputs(state, &mut values);
        self.exact.numbers.extend(&values[..self.width]);
        self.next += 1;
    }

    fn count(&mut self, state: &State<f64, N>) {
        let mut here = [1.0; EVENTS];
        self.mechanism.events(state, &mut here);
        let [before, middle] = self.looks;
        for i in 0..EVENTS {
            let crossed = middle[i] * here[i] < 0.0;
            if crossed && let Some(crossings) = &mut self.exact.crossings {
                *crossings += 1;
            }
            let turned = middle[i].abs() < before[i].abs() && middle[i].abs() < here[i].abs();
            let near = middle[i].abs() < UNCLEAR;
            let same = middle[i] * here[i] > 0.0 && middle[i] * before[i] > 0.0;
            self.unclear |= here[i] == 0.0 || (turned && near && same);
        }
        self.looks = [middle, here];
    }
}

impl<const N: usize, const R: usize> Observer<f64, N> for Follow<'_, N, R> {
    fn begin(
        &mut self,
        state: &State<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let mut here = [1.0; EVENTS];
        self.mechanism.events(state, &mut here);
        self.looks = [here; 2];
        self.unclear = here.iter().any(|x| x.abs() < 1e-12);
        while self.times.get(self.next).is_some_and(|t| *t <= state.t) {
            self.take(state);
        }
        Ok(ControlFlow::Continue(()))
    }

    fn step(
        &mut self,
        step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        for i in 1..=LOOKS {
            let part = i as f64 / LOOKS as f64;
            self.count(&step.at(step.start().t + part * step.length()));
        }
        while let Some(t) = self.times.get(self.next).filter(|t| **t <= step.end().t) {
            self.take(&step.at(*t));
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// Integrates a reduction and takes its motion at the times, which ascend.
pub fn follow<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    width: usize,
    times: &[f64],
) -> Exact {
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("nothing constrains it");
    let mut follow = Follow {
        mechanism,
        times,
        width,
        next: 0,
        exact: Exact {
            crossings: Some(0),
            ..Exact::default()
        },
        looks: [[0.0; EVENTS]; 2],
        unclear: false,
    };
    let until = times.iter().copied().fold(0.0, larger);
    let mut options = Options::dop853(until, TOLERANCE);
    options.audit = Audit::NONE;
    let ran = simulate(mechanism, &start, &options, &mut [&mut follow]);
    ran.unwrap_or_else(|failure| panic!("the reduction ended: {failure}"));
    let unclear = follow.unclear;
    let mut exact = follow.exact;
    if unclear {
        exact.crossings = None;
    }
    exact
}

struct Reduced<'a> {
    set: &'a Set,
    width: usize,
    times: &'a [f64],
}

impl Visitor<f64> for Reduced<'_> {
    type Output = Exact;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> Exact
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let parameters = mechanism.structure().parameters;
        for (name, value) in self.set {
            if let Some(place) = parameters.iter().position(|p| p.name == *name) {
                mechanism.set_parameter(place, *value);
            }
        }
        follow::<N, R>(&mechanism, self.width, self.times)
    }
}

/// All parameters of a mechanism, where not set at their defaults.
struct Parameters<'a>(&'a Set);

impl Visitor<f64> for Parameters<'_> {
    type Output = Set;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Set
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let value = |(place, name)| {
            let own = mechanism.parameter(place).expect("it is a parameter");
            let set = self.0.iter().find(|(other, _)| *other == name);
            (name, set.map_or(own, |(_, value)| *value))
        };
        let names = mechanism.structure().parameters.iter().map(|p| p.name);
        names.enumerate().map(value).collect()
    }
}

/// The exact motion of a mechanism with `n` coordinates at times, by a reduction that
/// takes over those of its parameters that it shares.
pub fn exact(mechanism: &str, reduced: &str, set: &Set, n: usize, times: &[f64]) -> Exact {
    let known = "it is in the catalogue";
    let set = crate::descriptions::visit(mechanism, Parameters(set)).expect(known);
    let visitor = Reduced {
        set: &set,
        width: 2 * n,
        times,
    };
    crate::descriptions::visit(reduced, visitor).expect(known)
}
