//! Expression, interpreted program and compiled code say the same.

use crate::compiled::{Answers, Place, answers, asked};
use crate::dense::{dot, null_space, size, times};
use crate::library::{Derived, Point, everything, has_regular_states, is_of_unit_size};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::Shape;
use bricard_codegen::internals::optimise::{Slot, interpret, optimise, plain};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{Mechanism, Position, State, Terms};
use bricard_testkit::Random;
use std::collections::BTreeMap;

/// What equal values may differ by: some units in the last place of the largest
/// entry of their array, since the operations are done in another order.
const ROUND_OFF: f64 = 1e-13;

/// What a solution of the equations may leave over, relative to what cancels.
const SOLVED: f64 = 1e-11;

/// Below this pivot ratio the regular path is not used.
const REGULAR: f64 = 1e-2;

/// What single precision may differ by.
const ROUGH: f64 = 1e-4;
/// What times are multiplied by for single precision.
const EARLY: f64 = 1e-2;

/// Random states for each mechanism.
const STATES: u64 = 50;

/// Every expression with the place that the compiled code writes it to.
fn places(derived: &Derived) -> Vec<(Place, ExprId)> {
    let equations = &derived.equations;
    let energies = equations.energies;
    let energies = [
        energies.kinetic,
        energies.potential,
        energies.balance,
        energies.power,
    ];
    let outputs: Vec<ExprId> = derived.mechanism.outputs.iter().map(|o| o.value).collect();
    let events: Vec<ExprId> = derived.mechanism.events.iter().map(|e| e.value).collect();
    let picture: Vec<ExprId> = derived.mechanism.shapes.iter().flat_map(drawn).collect();
    let mut places = Vec::new();
    let linear = &derived.linearised;
    let vectors: [(&'static str, &[ExprId]); 8] = [
        ("force", &equations.force),
        ("bias", &equations.bias),
        ("residual", &equations.residual),
        ("drift", &equations.drift),
        ("energy", &energies),
        ("outputs", &outputs),
        ("events", &events),
        ("draw", &picture),
    ];
    for (array, entries) in vectors {
        places.extend(
            entries
                .iter()
                .enumerate()
                .map(|(row, &e)| ((array, row, 0), e)),
        );
    }
    let matrices = [
        ("force by q", &linear.force_by_position),
        ("force by v", &linear.force_by_velocity),
        ("row by q", &linear.row_by_position),
        ("row by v", &linear.row_by_velocity),
        ("mass", &derived.mass),
        ("jacobian", &equations.jacobian),
    ];
    for (array, rows) in matrices {
        for (row, entries) in rows.iter().enumerate() {
            let entry = |(column, &e)| ((array, row, column), e);
            places.extend(entries.iter().enumerate().map(entry));
        }
    }
    places
}

/// The numbers of a shape in the order in which they are drawn.
fn drawn(shape: &Shape) -> Vec<ExprId> {
    match shape {
        Shape::Line(points) | Shape::Polygon(points) => points.concat(),
        Shape::Circle(centre, radius) => [&centre[..], &[*radius]].concat(),
        Shape::Trace(point) => point.to_vec(),
    }
}

/// The point with inputs at their laws.
fn at_law(derived: &Derived, point: &Point) -> Point {
    let law = |input: &bricard_codegen::internals::model::Input| derived.value(input.law, point);
    Point {
        inputs: derived.mechanism.inputs.iter().map(law).collect(),
        follows: true,
        ..point.clone()
    }
}

/// Entries agree, measured by the largest one of their array.
fn agree(what: &str, found: &BTreeMap<Place, f64>, exact: &[(Place, f64)]) {
    for ((array, row, column), value) in exact {
        let same = exact.iter().filter(|((other, ..), _)| other == array);
        let scale = same.fold(1.0_f64, |most, (_, x)| most.max(x.abs()));
        let found = found.get(&(*array, *row, *column)).copied().unwrap_or(0.0);
        assert!(
            (found - value).abs() <= ROUND_OFF * scale,
            "{what}: {array}[{row},{column}] is {found:e}, its expression {value:e}"
        );
    }
}

fn evaluated(derived: &Derived, places: &[(Place, ExprId)], point: &Point) -> Vec<(Place, f64)> {
    let expressions: Vec<ExprId> = places.iter().map(|(_, e)| *e).collect();
    let values = derived.vector(&expressions, point);
    places.iter().map(|(place, _)| *place).zip(values).collect()
}

#[test]
fn compiled_code_has_the_values_of_its_expressions() {
    for derived in everything() {
        let places = places(&derived);
        for seed in 0..STATES {
            for held in [false, true] {
                let (point, answers) = asked(&derived, seed, held);
                let point = if held {
                    point
                } else {
                    at_law(&derived, &point)
                };
                let exact = evaluated(&derived, &places, &point);
                agree(
                    &format!("{}, seed {seed}", derived.name),
                    &answers.entries,
                    &exact,
                );
            }
        }
    }
}

#[test]
fn interpreted_programs_have_the_values_of_their_expressions() {
    for mut derived in everything() {
        let places = places(&derived);
        let slot = |((array, row, column), e): &(Place, ExprId)| {
            (
                Slot {
                    array,
                    row: *row,
                    column: *column,
                },
                *e,
            )
        };
        let wanted: Vec<(Slot, ExprId)> = places.iter().map(slot).collect();
        let laws: Vec<ExprId> = derived.mechanism.inputs.iter().map(|i| i.law).collect();
        let program = optimise(&mut derived.mechanism.graph, &laws, &wanted);
        for seed in 0..STATES {
            let (point, _) = asked(&derived, seed, false);
            let point = at_law(&derived, &point);
            let run = interpret(&program, &|symbol| match symbol {
                Symbol::Input(_) => None,
                _ => Some(point.value(symbol)),
            });
            let place = |(slot, value): (Slot, f64)| ((slot.array, slot.row, slot.column), value);
            let found = run.into_iter().map(place).collect();
            let exact = evaluated(&derived, &places, &point);
            agree(&format!("{}, seed {seed}", derived.name), &found, &exact);
        }
    }
}

#[test]
fn the_start_has_the_values_of_the_description() {
    for derived in everything() {
        let (point, answers) = asked(&derived, 0, false);
        let n = derived.n();
        for start in &derived.mechanism.starts {
            let wanted = [(
                Slot {
                    array: "start",
                    row: 0,
                    column: 0,
                },
                start.value,
            )];
            let program = plain(&derived.mechanism.graph, &wanted);
            let run = interpret(&program, &|symbol| Some(point.value(symbol)));
            let exact = run.first().map_or(0.0, |(_, value)| *value);
            let row = start.coordinate + if start.velocity { n } else { 0 };
            let found = answers.get(("start", row, 0));
            let error = (found - exact).abs();
            assert!(
                error <= ROUND_OFF * (1.0 + exact.abs()),
                "{}: {found} {exact}",
                derived.name
            );
        }
    }
}

/// Mechanisms in Euler parameters: their mass matrix is definite nowhere, so that their
/// regular path needs weights, which are the solver's.
const SEMI_DEFINITE: [&str; 4] = ["hinged_body", "platform", "placed", "tied_bar"];

/// Runs a check where the regular path may be used; says how often it was.
fn where_regular(claim: impl Fn(&Derived, &Answers, &str)) {
    // Rows that follow from others do so where the constraints hold.
    let is_regular = |name: &str| has_regular_states(name) && !SEMI_DEFINITE.contains(&name);
    let usual = |name: &str| is_of_unit_size(name) && is_regular(name);
    for derived in everything().filter(|derived| usual(&derived.name)) {
        let mut regular = 0;
        for seed in 0..STATES {
            let (_, answers) = asked(&derived, seed, true);
            if answers.regular > REGULAR {
                regular += 1;
                claim(
                    &derived,
                    &answers,
                    &format!("{}, seed {seed}", derived.name),
                );
            }
        }
        assert!(
            2 * regular > STATES,
            "{}: only {regular} regular states",
            derived.name
        );
    }
}

/// A residual is round-off against what cancelled in it.
fn cancels(left: f64, scale: f64, what: &str) {
    assert!(
        left.abs() <= SOLVED * (1.0 + scale),
        "{what}: {left:e} is left of {scale:e}"
    );
}

#[test]
fn the_regular_acceleration_solves_the_equations_of_motion() {
    where_regular(|derived, answers, what| {
        let (n, r) = (derived.n(), derived.equations.residual.len());
        let jacobian = answers.matrix("jacobian", r, n);
        let mass = answers.matrix("mass", n, n);
        let acceleration = answers.vector("acceleration", n);
        for (row, bias) in jacobian.iter().zip(answers.vector("bias", r)) {
            let left = dot(row, &acceleration) - bias;
            cancels(
                left,
                size(row, &acceleration) + bias.abs(),
                &format!("{what}: A q̈ − p₂"),
            );
        }
        let (inertia, force) = (times(&mass, &acceleration), answers.vector("force", n));
        let reaction: Vec<f64> = inertia.iter().zip(&force).map(|(m, p)| m - p).collect();
        for direction in null_space(&jacobian, n) {
            let scale = size(&direction, &inertia) + size(&direction, &force);
            cancels(
                dot(&direction, &reaction),
                scale,
                &format!("{what}: Dᵀ(M q̈ − p₁)"),
            );
        }
    });
}

#[test]
fn the_regular_corrections_solve_the_constraints_with_the_least_kinetic_norm() {
    where_regular(|derived, answers, what| {
        let (n, r) = (derived.n(), derived.equations.residual.len());
        let jacobian = answers.matrix("jacobian", r, n);
        let mass = answers.matrix("mass", n, n);
        for (row, residual) in answers.vector("residual", r).iter().enumerate() {
            let found = answers.get(("corrected residual", row, 0));
            cancels(found - residual, residual.abs(), &format!("{what}: g"));
        }
        let (point, _) = asked(derived, seed_of(what), true);
        // The velocity is corrected as it is needed after the position is.
        let moved = answers.vector("correction of q", n);
        let gap_of_speed = |row: &Vec<f64>, i: usize| {
            let turn = derived.vector(&derived.equations.turn[i], &point);
            let turned = dot(&turn, &moved);
            let scale = size(row, &point.v) + size(&turn, &moved);
            let gap = dot(row, &point.v) + answers.get(("drift", i, 0)) + turned;
            (gap, scale)
        };
        for (level, array) in ["correction of q", "correction of v"]
            .into_iter()
            .enumerate()
        {
            let step = answers.vector(array, n);
            for (i, row) in jacobian.iter().enumerate() {
                let (gap, scale) = match level {
                    0 => (answers.get(("residual", i, 0)), 0.0),
                    _ => gap_of_speed(row, i),
                };
                let scale = size(row, &step) + gap.abs() + scale;
                cancels(dot(row, &step) + gap, scale, &format!("{what}: {array}"));
            }
            let pushed = times(&mass, &step);
            for direction in null_space(&jacobian, n) {
                let scale = size(&direction, &pushed);
                cancels(
                    dot(&direction, &pushed),
                    scale,
                    &format!("{what}: Dᵀ M, {array}"),
                );
            }
        }
    });
}

/// The seed in the name of a check.
fn seed_of(what: &str) -> u64 {
    what.rsplit(' ')
        .next()
        .and_then(|seed| seed.parse().ok())
        .expect("a seed at the end")
}

#[test]
fn single_precision_says_roughly_the_same() {
    for derived in everything() {
        for seed in 0..STATES {
            let mut point = derived.point(&mut Random::seeded(seed));
            // Single precision knows an angle of 300 rad to 1.5e-5 only.
            point.t *= EARLY;
            let exact = answers::<f64>(&derived, &point, true);
            let rough = answers::<f32>(&derived, &point, true);
            for (place, value) in &exact.entries {
                let solved = ["acceleration", "correction of q", "correction of v"];
                if solved.contains(&place.0) {
                    continue;
                }
                let same = exact
                    .entries
                    .iter()
                    .filter(|((array, ..), _)| *array == place.0);
                let scale = same.fold(1.0_f64, |most, (_, x)| most.max(x.abs()));
                let found = rough.get(*place);
                let error = (found - value).abs();
                assert!(
                    error <= ROUGH * scale,
                    "{}: {place:?} {found} {value}",
                    derived.name
                );
            }
        }
    }
}

/// The functions that a user may call one by one.
#[test]
fn separate_functions_say_what_the_fused_ones_do() {
    let mechanism = bricard::slider_crank_driven::SliderCrankDriven::<f64>::default();
    let mut random = Random::seeded(7);
    for _ in 0..STATES {
        let mut vector = || SVector::from_fn(|_, _| random.between(-3.0, 3.0));
        let state = State::new(0.0, vector(), vector());
        let mut terms = Terms::default();
        mechanism.terms(&state, &mut terms);
        let mut position = Position::default();
        mechanism.position(&state, &mut position);
        let coriolis = mechanism.coriolis_force(&state);
        let force = mechanism.applied_force(&state) - coriolis - mechanism.potential_force(&state);
        let differences = [
            (mechanism.mass_matrix(&state) - terms.mass).amax(),
            (force - terms.force).amax(),
            (mechanism.coriolis_matrix(&state) * state.v - coriolis).amax(),
            (mechanism.constraint_residual(&state) - position.residual).amax(),
            (mechanism.constraint_jacobian(&state) - terms.jacobian).amax(),
            (mechanism.constraint_bias(&state) - terms.bias).amax(),
        ];
        // Entries of these arrays are below 100.
        assert!(
            differences.iter().all(|x| *x <= 100.0 * ROUND_OFF),
            "{differences:?}"
        );
    }
}
