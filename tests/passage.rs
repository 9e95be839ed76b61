//! The passage through a singular configuration costs no accuracy, wherever the stages
//! of a step are placed.
//!
//! Here stages lie exactly at their distance, and not only up to the error of the step until
//! then: the start of the step is found for that.

use crate::reduction::Reduction;
use bricard::double_four_bar::DoubleFourBar;
use bricard::slider_crank::SliderCrank;
use bricard::slider_crank_driven::SliderCrankDriven;
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Integrator, Rk4, Settings, Solver, State, Whole};
use bricard_testkit::Motion;
use bricard_testkit::placement::{Placements, SPAN, complaints, distances};

/// The least order that medians show.
const ORDER: f64 = 3.7;

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

const STAGES: [Stage; 4] = [Stage::First, Stage::Second, Stage::Third, Stage::Last];

/// Runs past a singular position with one step size.
pub struct Passage {
    reduction: Reduction,
    rate: f64,
    steps: u32,
}

/// The errors of all placements, by the stage and its distance.
pub type Placed = Placements<(Stage, f64)>;

impl Passage {
    /// The errors that a mechanism makes.
    pub fn placed<const N: usize, const R: usize>(
        &self,
        mechanism: &dyn Whole<f64, N, R>,
    ) -> Placed {
        let mut errors = Vec::new();
        for stage in STAGES {
            for distance in distances() {
                let start = self.start_before(mechanism, stage, distance);
                errors.push((self.error(mechanism, start), (stage, distance)));
            }
        }
        Placements::of(errors).expect("some placements")
    }

    fn step(&self) -> f64 {
        SPAN / f64::from(self.steps)
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
    fn reached<const N: usize, const R: usize>(
        &self,
        mechanism: &dyn Whole<f64, N, R>,
        stage: Stage,
        t: f64,
    ) -> f64 {
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
    fn start_before<const N: usize, const R: usize>(
        &self,
        mechanism: &dyn Whole<f64, N, R>,
        stage: Stage,
        distance: f64,
    ) -> f64 {
        let abscissa = match stage {
            Stage::First => 0.0,
            Stage::Second | Stage::Third => 0.5,
            Stage::Last => 1.0,
        };
        let target = self.reduction.singular() + distance;
        let miss = |t: f64| self.reached(mechanism, stage, t) - target;
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
    fn error<const N: usize, const R: usize>(
        &self,
        mechanism: &dyn Whole<f64, N, R>,
        t: f64,
    ) -> f64 {
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(mechanism);
        let mut method = Rk4::new();
        let mut state: State<f64, N> = self.state(t);
        for i in 1..=self.steps {
            match method.step(&mut system, &state, t + f64::from(i) * self.step()) {
                Ok(step) => state = *step.end(),
                Err(_) => return f64::INFINITY,
            }
        }
        let exact: State<f64, N> = self.state(t + SPAN);
        (state.q - exact.q).amax()
    }
}

/// What is wrong with the placements of a mechanism.
pub fn judged(reduction: Reduction, rate: f64, placed: &dyn Fn(Passage) -> Placed) -> Vec<String> {
    let found = complaints(ORDER, |steps| {
        placed(Passage {
            reduction,
            rate,
            steps,
        })
    });
    let name = reduction.name();
    found.iter().map(|said| format!("{name}, {said}")).collect()
}

#[test]
fn no_placement_is_much_worse_than_the_median_and_the_median_is_of_order_four() {
    let mut failures = Vec::new();
    for (reduction, rate) in RATES {
        failures.extend(judged(reduction, rate, &|passage| match reduction {
            Reduction::SliderCrank => passage.placed(&SliderCrank::default()),
            Reduction::SliderCrankDriven => passage.placed(&SliderCrankDriven::default()),
            Reduction::DoubleFourBar => passage.placed(&DoubleFourBar::default()),
        }));
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
