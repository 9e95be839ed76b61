//! The passage through a singular configuration costs no accuracy, wherever the stages
//! of a step are placed.
//!
//! A run begins on the exact motion so that a stage of its first step lies at a
//! distance `d` from the singular position, `d = ±{1, 3.3}·10⁻ᵏ`, `k = 1…16`, and is
//! followed for 0.4 s. No placement may be much worse than the median of all.

use crate::reduction::Reduction;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    Integrator, Interface, Mechanism, Rk4, Settings, Solver, State, Visitor, Whole,
};
use bricard_testkit::Motion;

/// How long a motion is followed (s).
const SPAN: f64 = 0.4;

/// How much worse than the median the worst placement may be.
const SPREAD: f64 = 2.0;

/// The least order that the median shows.
const ORDER: f64 = 3.8;

/// The velocity in the singular position (rad/s).
const RATES: [(Reduction, f64); 3] = [
    (Reduction::SliderCrank, -3.0),
    (Reduction::SliderCrankDriven, 5.0),
    (Reduction::DoubleFourBar, -7.0),
];

/// Stages of a step of RK4: abscissa, and how the stage is reached.
#[derive(Clone, Copy, Debug)]
pub enum Stage {
    First,
    Second,
    Third,
    Last,
}

/// All placements with one step size.
pub struct Placements {
    reduction: Reduction,
    rate: f64,
    steps: usize,
}

/// The errors of all placements, with the stage and the distance.
pub type Errors = Vec<(f64, Stage, f64)>;

impl Visitor<f64> for Placements {
    type Output = Errors;

    fn visit<M, const N: usize, const R: usize>(self, mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N>,
    {
        let mechanism: &dyn Whole<f64, N, R> = &mechanism;
        let mut errors = Vec::new();
        for stage in [Stage::First, Stage::Second, Stage::Third, Stage::Last] {
            for exponent in 1..=16 {
                for size in [1.0, -1.0, 3.3, -3.3] {
                    let distance = size * 10.0_f64.powi(-exponent);
                    let start = self.aimed(mechanism, stage, distance);
                    errors.push((self.error(mechanism, start), stage, distance));
                }
            }
        }
        errors
    }
}

impl Placements {
    fn step(&self) -> f64 {
        SPAN / self.steps as f64
    }

    /// The exact motion at a time from the singular position.
    fn exact(&self, t: f64) -> Motion {
        self.reduction
            .after(t, (self.reduction.singular(), self.rate))
    }

    fn state<const N: usize>(&self, t: f64) -> State<f64, N> {
        let (q, v) = self.reduction.full(self.exact(t));
        State::new(
            t,
            SVector::from_fn(|i, _| q[i]),
            SVector::from_fn(|i, _| v[i]),
        )
    }

    /// The first coordinate at a stage of the step that begins at a time.
    fn placed<M, const N: usize, const R: usize>(&self, mechanism: &M, stage: Stage, t: f64) -> f64
    where
        M: Mechanism<f64, N, R> + ?Sized,
    {
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(mechanism);
        let mut acceleration = |state: &State<f64, N>| {
            system
                .acceleration(state)
                .expect("an acceleration beside a singular position")
        };
        let (start, half): (State<f64, N>, f64) = (self.state(t), self.step() / 2.0);
        let mut velocity = |state: &State<f64, N>, h: f64| start.v + acceleration(state) * h;
        let reached = |velocity: SVector<f64, N>, h: f64| start.q + velocity * h;
        match stage {
            Stage::First => start.q[0],
            Stage::Second => reached(start.v, half)[0],
            Stage::Third => reached(velocity(&start, half), half)[0],
            Stage::Last => {
                let v2 = velocity(&start, half);
                let v3 = velocity(&State::new(t + half, reached(start.v, half), v2), half);
                reached(v3, 2.0 * half)[0]
            }
        }
    }

    /// The time at which a step begins whose stage lies at a distance from the
    /// singular position, by the secant method.
    fn aimed<M, const N: usize, const R: usize>(
        &self,
        mechanism: &M,
        stage: Stage,
        distance: f64,
    ) -> f64
    where
        M: Mechanism<f64, N, R> + ?Sized,
    {
        let abscissa = match stage {
            Stage::First => 0.0,
            Stage::Second | Stage::Third => 0.5,
            Stage::Last => 1.0,
        };
        let target = self.reduction.singular() + distance;
        let miss = |t: f64| self.placed(mechanism, stage, t) - target;
        let mut at = distance / self.rate - abscissa * self.step();
        for _ in 0..8 {
            let gap = miss(at);
            let slope = (miss(at + 1e-6) - gap) / 1e-6;
            if gap == 0.0 || !slope.is_normal() {
                break;
            }
            at -= gap / slope;
        }
        at
    }

    /// The largest error of a coordinate at the end of a run.
    fn error<M, const N: usize, const R: usize>(&self, mechanism: &M, t: f64) -> f64
    where
        M: Mechanism<f64, N, R> + ?Sized,
    {
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(mechanism);
        let mut method = Rk4::new();
        let mut state: State<f64, N> = self.state(t);
        for i in 1..=self.steps {
            match method.step(&mut system, &state, t + i as f64 * self.step()) {
                Ok(step) => state = *step.end(),
                Err(_) => return f64::INFINITY,
            }
        }
        let exact: State<f64, N> = self.state(t + SPAN);
        (state.q - exact.q).amax()
    }
}

/// What is wrong with the placements of a mechanism; `visited` shows it to them.
pub fn judged(
    reduction: Reduction,
    rate: f64,
    visited: &dyn Fn(Placements) -> Errors,
) -> Vec<String> {
    let mut failures = Vec::new();
    let mut medians = Vec::new();
    for steps in [20, 40, 80, 160] {
        let mut errors = visited(Placements {
            reduction,
            rate,
            steps,
        });
        errors.sort_by(|a, b| a.0.total_cmp(&b.0));
        let median = errors[errors.len() / 2].0;
        let (worst, stage, distance) = errors[errors.len() - 1];
        if worst > SPREAD * median {
            failures.push(format!(
                "{}, {steps} steps: median {median:.1e}, worst {worst:.1e} where stage \
                 {stage:?} lies at {distance:e}",
                reduction.name()
            ));
        }
        medians.push(median);
    }
    let order = (medians[0] / medians[3]).log2() / 3.0;
    if order < ORDER {
        failures.push(format!(
            "{}: order {order:.2}, {medians:?}",
            reduction.name()
        ));
    }
    failures
}

#[test]
fn no_placement_is_much_worse_than_the_median_and_the_median_is_of_order_four() {
    let mut failures = Vec::new();
    for (reduction, rate) in RATES {
        failures.extend(judged(reduction, rate, &|placements| {
            let errors = bricard::visit::<f64, _>(reduction.name(), placements);
            errors.expect("a name of the catalogue")
        }));
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
