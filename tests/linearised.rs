//! The linearised equations of motion, against dual numbers and against differences.

use crate::dual::{Dual, evaluate};
use crate::library::{
    Derived, Inspect, Point, everything, has_regular_states, inspect, names, step_scale,
};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    AccelerationJacobian, Options, Settings, Solver, State, System, Whole, assemble, simulate,
};
use bricard_testkit::Random;
use num_dual::Dual64;

/// What derivatives may differ by, relative to the largest of their row.
const ROUND_OFF: f64 = 1e-11;

/// What differences may be off, relative to the largest derivative.
const DIFFERENCES: f64 = 1e-5;

/// How far coordinates and velocities are varied.
const VARIATION: f64 = 1e-5;

/// Random states for each mechanism.
const STATES: u64 = 4;

/// What a row of derivatives is taken by, one for each coordinate.
type By = fn(u32) -> Symbol;

/// The value of an expression whose inputs are held, or follow their laws.
fn value<D: Dual>(derived: &Derived, e: ExprId, point: &Point, moved: &dyn Fn(Symbol) -> D) -> D {
    let graph = &derived.mechanism.graph;
    evaluate(graph, e, &|symbol| match symbol {
        Symbol::Input(i) if point.follows => {
            evaluate(graph, derived.mechanism.inputs[i as usize].law, moved)
        }
        _ => moved(symbol),
    })
}

/// `∂e/∂symbol` by dual numbers.
fn partial(derived: &Derived, e: ExprId, point: &Point, by: Symbol) -> f64 {
    let seeded = |symbol: Symbol| {
        // The value of an input that follows its law is never asked for.
        let seed = if symbol == by { 1.0 } else { 0.0 };
        Dual64::new(point.value(symbol), seed)
    };
    value(derived, e, point, &seeded).eps
}

/// A row of derivatives, symbolic and by dual numbers, of `e − Σ entry·given`.
fn check_row(
    derived: &Derived,
    point: &Point,
    (e, entries): (ExprId, &[(ExprId, f64)]),
    (symbolic, by): (&[ExprId], By),
) {
    let found = derived.vector(symbolic, point);
    let mut exact = Vec::new();
    for j in 0..derived.n() {
        let by = by(u32::try_from(j).expect("few coordinates"));
        let rest = entries
            .iter()
            .map(|(entry, given)| partial(derived, *entry, point, by) * given);
        exact.push(partial(derived, e, point, by) - rest.sum::<f64>());
    }
    let scale = exact.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    for (j, (found, exact)) in found.iter().zip(&exact).enumerate() {
        let name = &derived.name;
        let error = (found - exact).abs();
        assert!(
            error <= ROUND_OFF * scale,
            "{name}, {j}: {found:e} {exact:e}"
        );
    }
}

#[test]
fn linearised_equations_have_the_derivatives_of_dual_numbers() {
    for derived in everything() {
        for seed in 0..STATES {
            for follows in [false, true] {
                let point = Point {
                    follows,
                    ..derived.point(&mut Random::seeded(seed))
                };
                check(&derived, &at_law(&derived, point));
            }
        }
    }
}

/// The point with the values of the laws, if inputs follow them.
fn at_law(derived: &Derived, mut point: Point) -> Point {
    if point.follows {
        let laws = derived.mechanism.inputs.iter();
        point.inputs = laws.map(|input| derived.value(input.law, &point)).collect();
    }
    point
}

fn check(derived: &Derived, point: &Point) {
    let (equations, linear) = (&derived.equations, &derived.linearised);
    let (q, v): (By, By) = (Symbol::Coordinate, Symbol::Velocity);
    for i in 0..derived.n() {
        let masses = derived.mass[i]
            .iter()
            .copied()
            .zip(point.accelerations.clone());
        let column = equations.jacobian.iter().map(|row| row[i]);
        let reactions = column.zip(point.multipliers.clone());
        let given: Vec<(ExprId, f64)> = masses.chain(reactions).collect();
        let e = (equations.force[i], &given[..]);
        check_row(derived, point, e, (&linear.force_by_position[i], q));
        check_row(derived, point, e, (&linear.force_by_velocity[i], v));
    }
    for (row, entries) in equations.jacobian.iter().enumerate() {
        let given: Vec<(ExprId, f64)> = entries
            .iter()
            .copied()
            .zip(point.accelerations.clone())
            .collect();
        let e = (equations.bias[row], &given[..]);
        check_row(derived, point, e, (&linear.row_by_position[row], q));
        check_row(derived, point, e, (&linear.row_by_velocity[row], v));
    }
}

/// Compares the Jacobian of the acceleration with differences; whether there is one.
struct Compare {
    name: &'static str,
}

impl Inspect<f64> for Compare {
    type Output = bool;

    fn inspect<const N: usize, const R: usize>(self, mechanism: &mut dyn Whole<f64, N, R>) -> bool {
        let mechanism = &*mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        let options = Options::dop853(0.19 * step_scale(self.name), 1e-10);
        let run = simulate(mechanism, &start, &options, &mut []);
        let state = run.unwrap_or_else(|failure| panic!("{failure}")).end;
        let mut solver = Solver::new(Settings::default());
        let mut system = solver.on(mechanism);
        let mut acceleration =
            |state: &State<f64, N>| system.acceleration(state).expect("a regular state");
        let (mut by_q, mut by_v) = (Vec::new(), Vec::new());
        for j in 0..N {
            let mut change = |vary: &dyn Fn(&mut State<f64, N>, f64)| -> SVector<f64, N> {
                let ends = [VARIATION, -VARIATION].map(|size| {
                    let mut near = state;
                    vary(&mut near, size);
                    acceleration(&near)
                });
                (ends[0] - ends[1]) / (2.0 * VARIATION)
            };
            by_q.push(change(&|state, size| state.q[j] += size));
            by_v.push(change(&|state, size| state.v[j] += size));
        }
        let Some(AccelerationJacobian { q, v }) = system.acceleration_jacobian(&state) else {
            return false;
        };
        for (what, found, near) in [("q", q, by_q), ("q̇", v, by_v)] {
            let scale = found.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for (j, near) in near.iter().enumerate() {
                let error = (found.column(j) - near).amax();
                let name = self.name;
                assert!(
                    error <= DIFFERENCES * scale,
                    "{name}, by {what}{j}: {error:e} of {scale:e}"
                );
            }
        }
        true
    }
}

#[test]
fn slopes_of_accelerations_are_the_limits_of_differences() {
    let without: Vec<&str> = names()
        .filter(|name| has_regular_states(name))
        .filter(|name| !inspect(name, Compare { name }))
        .collect();
    assert!(without.is_empty(), "no Jacobian for {without:?}");
}
