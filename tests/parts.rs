//! Functions that are emitted in parts, with loops, compute what they do in straight lines, to the
//! last bit.

use bricard::double_four_bar::DoubleFourBar;
use bricard_codegen::CompileSettings;
use bricard_fixtures::functions::Functions;
use bricard_fixtures::in_parts;
use bricard_fixtures::reserved::TypeOfThing;
use bricard_fixtures::straight::closed_rods::{self, ClosedRods};
use bricard_fixtures::straight::joints::{self, Joints};
use bricard_fixtures::straight::row::{self, Row};
use bricard_fixtures::with_loops;
use bricard_runtime::{Acceleration, Correction, Interface, Mechanism, Position, State, Terms};
use bricard_testkit::Random;

const STATES: usize = 20;

/// Fills all buffers by both mechanisms, at random states.
fn agree<const N: usize, const R: usize>(
    straight: &dyn Mechanism<f64, N, R>,
    parted: &dyn Mechanism<f64, N, R>,
) {
    let mut random = Random::seeded(320);
    for _ in 0..STATES {
        let mut state = State::<f64, N> {
            t: random.within(1.0),
            ..State::default()
        };
        state.q.iter_mut().for_each(|q| *q = random.within(1.5));
        state.v.iter_mut().for_each(|v| *v = random.within(2.0));
        let both = [straight, parted];
        let [a, b] = both.map(|mechanism| {
            let mut terms = Terms::<f64, N, R>::default();
            mechanism.terms(&state, &mut terms);
            terms
        });
        assert!(a.force.norm() > 0.0);
        assert_eq!((a.mass, a.force), (b.mass, b.force));
        assert_eq!((a.jacobian, a.bias), (b.jacobian, b.bias));
        let [a, b] = both.map(|mechanism| {
            let mut position = Position::<f64, N, R>::default();
            mechanism.position(&state, &mut position);
            position
        });
        assert_eq!((a.mass, a.residual), (b.mass, b.residual));
        assert_eq!((a.jacobian, a.drift), (b.jacobian, b.drift));
        let [a, b] = both.map(|mechanism| {
            let mut regular = Acceleration::<f64, N, R>::default();
            regular.weights.fill(1.5);
            let solved = mechanism.acceleration(&state, &mut regular);
            (solved, regular.acceleration, regular.pivots.row_pivots)
        });
        assert_eq!(a, b);
        assert!(a.0 && a.1.norm().is_normal());
        let [a, b] = both.map(|mechanism| mechanism.energy(&state));
        assert!(a.kinetic > 0.0);
        assert_eq!(a, b);
        if R == 0 {
            continue;
        }
        let [a, b] = both.map(|mechanism| {
            let mut correction = Correction::<f64, N, R>::default();
            correction.weights.fill(1.5);
            let solved = mechanism.correction(&state, &mut correction);
            (solved, correction.position, correction.velocity)
        });
        assert_eq!(a, b);
        assert!(a.0 && a.1.norm().is_normal() && a.2.norm().is_normal());
    }
}

#[test]
fn parts_compute_what_straight_lines_do() {
    agree(
        &DoubleFourBar::default(),
        &in_parts::double_four_bar::DoubleFourBar::default(),
    );
    agree(
        &Functions::default(),
        &in_parts::functions::Functions::default(),
    );
    agree(
        &TypeOfThing::default(),
        &in_parts::reserved::TypeOfThing::default(),
    );
}

#[test]
fn loops_compute_what_straight_lines_do() {
    agree(&Row::default(), &with_loops::row::Row::default());
    agree(&Joints::default(), &with_loops::joints::Joints::default());
    agree(
        &ClosedRods::default(),
        &with_loops::closed_rods::ClosedRods::default(),
    );
}

#[test]
fn arrays_on_request_are_the_same_with_loops() {
    let (straight, looped) = (
        Row::<f64>::default(),
        with_loops::row::Row::<f64>::default(),
    );
    let mut random = Random::seeded(640);
    for _ in 0..STATES {
        let mut state = State::<f64, 25>::default();
        state.q.iter_mut().for_each(|q| *q = random.within(1.5));
        state.v.iter_mut().for_each(|v| *v = random.within(2.0));
        macro_rules! agree {
            ($($array:ident)*) => {
                $(assert_eq!(straight.$array(&state), looped.$array(&state));)*
            };
        }
        agree!(mass_matrix potential_force applied_force coriolis_force);
        agree!(constraint_residual constraint_jacobian constraint_bias);
        assert!(straight.mass_matrix(&state).norm() > 0.0);
        assert_eq!(straight.start(), looped.start());
    }
}

/// The code of so many parallelograms in a row.
fn parallelograms(loops: usize, settings: &CompileSettings) -> String {
    let source = bricard::n_four_bar::SOURCE;
    let source = source.replace("const N = 2;", &format!("const N = {loops};"));
    let compiled = bricard_codegen::compile_source(&source, "row", "x.mech", settings);
    compiled.expect("a row").code
}

#[test]
fn what_comes_again_is_a_loop() {
    let mut settings = CompileSettings::default();
    let count = |code: &str| code.matches("for turn in").count();
    assert_eq!(count(&parallelograms(20, &settings)), 0);
    // What no step calls need not be as fast.
    let code = parallelograms(120, &settings);
    let function = |name: &str| {
        let (_, rest) = code.split_once(&format!("fn {name}(")).expect(name);
        let (function, _) = rest.split_once(" fn ").expect(name);
        (count(function), function.lines().count())
    };
    assert_eq!(function("position").0, 0);
    for name in [
        "mass_matrix",
        "constraint_jacobian",
        "constraint_bias",
        "energy",
    ] {
        let (loops, lines) = function(name);
        assert!(
            loops > 0 && lines < 500,
            "{name}: {loops} loops, {lines} lines"
        );
    }
    settings.options.unrolled = Some(2_000);
    let [fewer, more] = [20, 30].map(|loops| parallelograms(loops, &settings));
    assert!(count(&fewer) > 5);
    // Every loop has more turns; the functions themselves are as long.
    let lines = |code: &str| {
        let from = code.find("fn acceleration").unwrap_or_default();
        let to = code.find("fn position").unwrap_or_default();
        code[from..to].lines().count()
    };
    assert!(lines(&fewer) > 1000);
    assert!(lines(&more) < lines(&fewer) * 11 / 10);
    settings.options.unrolled = Some(60);
    for source in [row::SOURCE, closed_rods::SOURCE, joints::SOURCE] {
        let compiled = bricard_codegen::compile_source(source, "loops", "x.mech", &settings);
        assert!(count(&compiled.expect("a fixture").code) > 3);
    }
}

#[test]
fn long_functions_are_emitted_in_parts() {
    let part = |code: &str| code.matches("fn acceleration_part_").count();
    let source = bricard::double_four_bar::SOURCE;
    let mut settings = CompileSettings::default();
    let compiled = |settings: &_| {
        let compiled =
            bricard_codegen::compile_source(source, "double_four_bar", "x.mech", settings);
        compiled.expect("a mechanism of the library").code
    };
    assert_eq!(part(&compiled(&settings)), 0);
    settings.options.straight_line = Some(60);
    assert!(part(&compiled(&settings)) > 2);
}

/// Gravity turns each joint of a chain by the weight of all bodies behind it: by other numbers at
/// each joint, though what is done with them is the same.
#[test]
fn numbers_that_differ_between_turns_are_entries_of_a_table() {
    let source = include_str!("fixtures/rows/joints.mech");
    let lines = |joints: usize| {
        let source = source.replace("const N = 64;", &format!("const N = {joints};"));
        let settings = CompileSettings::default();
        let compiled = bricard_codegen::compile_source(&source, "chain", "x.mech", &settings);
        let code = compiled.expect("a chain").code;
        let (_, rest) = code.split_once("fn acceleration(").expect("a solve");
        let (function, _) = rest.split_once(" fn ").expect("others");
        assert!(function.contains("static NUMBERS: [[f64; 2]; "), "{joints}");
        function.lines().count()
    };
    let (few, many) = (lines(100), lines(150));
    // A line or two for each of the numbers of a joint, and for its angle.
    assert!(
        many - few < 50 * 10,
        "{few} lines, {many} of half as many joints more"
    );
}
