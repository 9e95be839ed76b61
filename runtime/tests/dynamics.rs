//! Accelerations, reactions and projections: the forms against each other, against
//! exact motions, at singular positions and beside them.

use crate::fixtures::{Framed, PLAIN, simulate, system_of};
use crate::mechanisms::{
    COUNT, FourBars, Hung, Massless, Parallelogram, Passing, Side, Sled, SliderCrank, Spring, Twice,
};
use bricard_runtime::nalgebra::SVector;
use bricard_runtime::{
    ConstrainedSystem, DynamicsError, Form, Integrator, Mechanism, Options, Rk4, Settings, Solver,
    Stabilisation, State, Structure, Terms,
};

/// Round-off of an acceleration of a few rad/s² where the rows are within a factor of
/// ten of dependent.
const ROUND_OFF: f64 = 1e-11;

fn form(form: Form) -> Settings<f64> {
    Settings {
        form,
        ..Settings::default()
    }
}

/// Acceleration and reaction of a form at a state.
fn solve<M, const N: usize, const R: usize>(
    mechanism: &M,
    settings: Settings<f64>,
    state: &State<f64, N>,
) -> Result<(SVector<f64, N>, SVector<f64, N>), DynamicsError<f64>>
where
    M: Mechanism<f64, N, R>,
{
    system_of(&mut Solver::new(settings), mechanism).reaction(state)
}

/// The exact acceleration, by central differences of the exact motion.
fn exact<P, const N: usize, const R: usize>(
    mechanism: &P,
    (angle, rate): (f64, f64),
) -> SVector<f64, N>
where
    P: Passing<N, R>,
{
    let velocity = |t: f64| {
        let (angle, rate) = mechanism.reduction().after(t, (angle, rate));
        mechanism.state(t, angle, rate).v
    };
    let h = 3e-4;
    (velocity(h) - velocity(-h)) * (2.0 / 3.0 / h)
        - (velocity(2.0 * h) - velocity(-2.0 * h)) / (12.0 * h)
}

/// Forms that may be used give the exact acceleration at an angle.
fn check_forms<P, const N: usize, const R: usize>(mechanism: &P, forms: &[Form], away: f64)
where
    P: Passing<N, R>,
{
    let (angle, rate) = mechanism.singular();
    let state = mechanism.state(0.0, angle + away, rate);
    let exact = exact(mechanism, (angle + away, rate));
    for &which in forms {
        let (found, _) = solve(mechanism, form(which), &state).unwrap();
        let error = (found - exact).amax();
        assert!(error < 1e-8, "{which}, {away} from singular: {error}");
    }
}

#[test]
fn all_forms_give_the_exact_acceleration_at_regular_positions() {
    check_forms::<_, 3, 2>(&SliderCrank::default(), &Form::ALL, 0.8);
    check_forms::<_, 3, 2>(&SliderCrank::DRIVEN, &Form::ALL, 0.8);
    check_forms::<_, 5, 4>(&FourBars, &Form::ALL, 0.8);
    check_forms::<_, 11, 10>(&FourBars, &Form::ALL, 0.8);
}

#[test]
fn forms_that_pass_are_exact_in_and_beside_singular_positions() {
    let forms = [Form::Reduced, Form::Full];
    for away in [0.0, 1e-15, -1e-9, 1e-6, 1e-4, -1e-3] {
        check_forms::<_, 5, 4>(&FourBars, &forms, away);
        check_forms::<_, 11, 10>(&FourBars, &forms, away);
    }
    for away in [0.0, 1e-15, -1e-9] {
        check_forms::<_, 3, 2>(&SliderCrank::default(), &forms, away);
        check_forms::<_, 6, 6>(&Parallelogram, &forms, away);
        check_forms::<_, 5, 8>(&Twice::<_, 4>(FourBars), &forms, away);
    }
    for away in [1e-6, 1e-4, -1e-3, 1e-2, 0.1] {
        check_forms::<_, 3, 2>(&SliderCrank::default(), &forms, away);
        check_forms::<_, 6, 6>(&Parallelogram, &forms, away);
    }
}

#[test]
fn forms_agree_to_round_off_on_accelerations_and_reactions() {
    let state = Passing::<5, 4>::state(&FourBars, 0.0, 0.9, -3.0);
    let (q, r) = solve::<_, 5, 4>(&FourBars, form(Form::Reduced), &state).unwrap();
    for which in Form::ALL {
        let (other, reaction) = solve::<_, 5, 4>(&FourBars, form(which), &state).unwrap();
        assert!((other - q).amax() < ROUND_OFF, "{which}");
        assert!((reaction - r).amax() < ROUND_OFF, "{which}");
    }
}

#[test]
fn reactions_do_no_work_in_motions_the_constraints_allow() {
    for (away, bound, least) in [(0.7, 1e-12, 1.0), (1e-5, 1e-9, 0.0), (0.0, 1e-12, 0.0)] {
        let (angle, rate) = Passing::<3, 2>::singular(&SliderCrank::default());
        let state = SliderCrank::default().state(0.0, angle + away, rate);
        let (_, r) = solve(&SliderCrank::default(), Settings::default(), &state).unwrap();
        assert!(r.amax() >= least, "hardly a reaction: {r}");
        assert!((r.dot(&state.v) / state.v.norm()).abs() < bound, "{away}");
    }
}

#[test]
fn forms_of_old_end_with_the_time_and_the_rank_at_a_singular_position() {
    for which in [Form::Multipliers, Form::Partitioning] {
        for away in [0.0, 1e-12, 1e-6, 1e-3] {
            let state = Passing::<5, 4>::state(&FourBars, 2.5, away, -3.0);
            let error = solve::<_, 5, 4>(&FourBars, form(which), &state).unwrap_err();
            let DynamicsError::SingularPosition { t, form, rank, .. } = error else {
                panic!("{which}, {away}: {error}");
            };
            assert_eq!((t, form, rank), (2.5, which, 2));
            assert!(error.to_string().contains("at t = 2.5 s only 2 of "));
        }
    }
}

#[test]
fn the_published_method_passes_with_less_accuracy() {
    let settings = Settings {
        published: true,
        ..Settings::default()
    };
    for which in [Form::Reduced, Form::Full] {
        let settings = Settings {
            form: which,
            ..settings
        };
        for away in [0.0, 1e-5, 0.3] {
            let state = Passing::<5, 4>::state(&FourBars, 0.0, away, -3.0);
            let (q, _) = solve::<_, 5, 4>(&FourBars, settings, &state).unwrap();
            assert!(q.amax() < 100.0, "{which}, {away}: {q}");
        }
    }
}

#[test]
fn redundant_constraints_are_cheap_after_a_choice_of_rows() {
    let mechanism = Twice::<_, 4>(FourBars);
    let mut solver: Solver<f64, 5, 8> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &mechanism);
    let mut state = Passing::<5, 8>::state(&mechanism, 0.0, 80_f64.to_radians(), 0.0);
    let mut method = Rk4::new();
    for i in 1..=800 {
        let bound = f64::from(i) * 0.01;
        state = *method.step(&mut system, &state, bound).unwrap().end();
    }
    let done = system.counters();
    let all = done.cheap_accelerations + done.beside_accelerations + done.robust_accelerations;
    assert!(
        done.cheap_accelerations as f64 > 0.95 * all as f64,
        "{done:?}"
    );
    assert!(done.row_choices > 0);
    assert!(system.constraint_error(&state).position < 3e-14);
}

#[test]
fn no_constraints_means_no_work_for_constraints() {
    let mut solver: Solver<f64, 1, 0> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &Spring);
    let mut state = State::new(0.0, [0.3].into(), [0.0].into());
    for _ in 0..10 {
        assert!((system.acceleration(&state).unwrap()[0] + 2.0 * state.q[0]).abs() < 1e-15);
        system.project(&mut state).unwrap();
    }
    let done = system.counters();
    assert_eq!(
        done.mass_factorisations, 1,
        "a constant mass is factorised once"
    );
    assert_eq!(
        done.projections + done.rank_decisions + done.constraint_factorisations,
        0
    );
}

#[test]
fn a_velocity_constraint_is_kept_without_touching_positions() {
    let mut solver = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &Sled);
    let mut state = State::new(0.0, [0.0, 0.0, 0.0].into(), [1.0, 0.0, 0.5].into());
    let mut method = Rk4::new();
    for i in 1..=400 {
        let bound = f64::from(i) * 0.01;
        state = *method.step(&mut system, &state, bound).unwrap().end();
    }
    // A sled without forces runs on a circle of radius v/ω.
    let (radius, angle) = (2.0, 0.5 * 4.0_f64);
    let exact = [radius * angle.sin(), radius * (1.0 - angle.cos()), angle];
    let error = (state.q - SVector::from(exact)).amax();
    assert!(error < 1e-9, "{error}");
    assert!(system.constraint_error(&state).velocity < 1e-15);
}

#[test]
fn baumgarte_pulls_an_opened_loop_back_together_in_every_form() {
    let opened = |form, stabilisation| {
        let settings = Settings {
            form,
            stabilisation,
            ..Settings::default()
        };
        let mut solver = Solver::new(settings);
        let mechanism = SliderCrank::default();
        let mut system: ConstrainedSystem<'_, _, f64, 3, 2> = system_of(&mut solver, &mechanism);
        let mut state = mechanism.state(0.0, 0.3, 0.0);
        state.q[2] += 1e-3;
        let mut method = Rk4::new();
        for i in 1..=100 {
            let bound = f64::from(i) * 0.002;
            state = *method.step(&mut system, &state, bound).unwrap().end();
        }
        system.constraint_error(&state).position
    };
    let (alpha, beta) = (50.0, 50.0);
    for form in Form::ALL {
        let pulled = opened(form, Stabilisation::Baumgarte { alpha, beta });
        let left = opened(form, Stabilisation::None);
        let projected = opened(form, Stabilisation::Projection);
        assert!(pulled < 1e-5, "{form:?}: {pulled}");
        assert!(left > 5e-4, "{form:?}: {left}");
        assert!(projected < 1e-14, "{form:?}: {projected}");
    }
}

#[test]
fn what_is_not_finite_is_an_error_with_its_time_and_never_a_hang() {
    for bad in [f64::NAN, f64::INFINITY] {
        for which in Form::ALL {
            for entry in 0..3 {
                let mut state = SliderCrank::default().state(1.5, 0.3, 1.0);
                state.q[entry] = bad;
                let found = solve(&SliderCrank::default(), form(which), &state);
                // The slider's position is in no term of the equations.
                if entry < 2 {
                    assert_eq!(found.unwrap_err(), DynamicsError::NotFinite { t: 1.5 });
                }
                let mut solver: Solver<f64, 3, 2> = Solver::new(form(which));
                let mechanism = SliderCrank::default();
                let error = system_of(&mut solver, &mechanism)
                    .project(&mut state)
                    .unwrap_err();
                assert_eq!(error.time(), 1.5);
            }
        }
    }
}

#[test]
fn a_loop_that_cannot_close_is_an_error_with_its_row() {
    let mechanism = FourBars;
    let mut solver: Solver<f64, 5, 4> = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &mechanism);
    let mut state = Passing::<5, 4>::state(&mechanism, 0.0, 1.0, 0.0);
    system.acceleration(&state).unwrap();
    // Far from any closure Newton's iteration may go anywhere but not on for ever.
    state.q = SVector::from([1e3, 2.0, -700.0, 40.0, 3.0]);
    match system.project(&mut state) {
        Ok(()) => assert!(system.constraint_error(&state).position < 1e-9),
        Err(error) => assert!(error.to_string().contains("take a smaller step"), "{error}"),
    }
}

#[test]
fn a_massless_coordinate_is_legal_where_a_constraint_holds_it() {
    let state = SliderCrank::default().state(0.0, 0.6, 2.0);
    let mechanism = Massless::default();
    let mut terms = Terms::default();
    mechanism.terms(&state, &mut terms);
    for which in Form::ALL {
        let (q, r) = solve(&mechanism, form(which), &state).unwrap();
        let gap = terms.jacobian * q - terms.bias;
        assert!(gap.amax() < 1e-12, "{which}: {gap}");
        assert!(r.dot(&state.v).abs() < 1e-11, "{which}: {r}");
    }
}

#[test]
fn solves_of_its_own_serve_a_mechanism_that_names_the_rows_of_its_metric() {
    let named = Massless {
        solves: true,
        ..Massless::default()
    };
    let state = SliderCrank::default().state(0.0, 0.6, 2.0);
    let (exact, _) = solve(&Massless::default(), Settings::default(), &state).unwrap();
    let mut solver = Solver::new(Settings::default());
    let mut system = system_of(&mut solver, &named);
    let found = system.acceleration(&state).unwrap();
    assert!((found - exact).amax() < ROUND_OFF, "{found} is not {exact}");
    assert_eq!(system.counters().cheap_accelerations, 1);
    assert_eq!(system.counters().constraint_factorisations, 0);

    let mut off = state;
    off.q += SVector::from([1e-3, -2e-3, 1e-3]);
    off.v += SVector::from([-3e-3, 1e-3, 2e-3]);
    let mut placed = off;
    system.project(&mut placed).unwrap();
    assert_eq!(system.counters().constraint_factorisations, 0);
    let mut general = off;
    let mut solver = Solver::new(Settings::default());
    let unnamed = Massless::default();
    let mut system = system_of(&mut solver, &unnamed);
    system.project(&mut general).unwrap();
    assert!(
        (placed.q - general.q).amax() < 1e-5,
        "{}",
        placed.q - general.q
    );
    let error = system.constraint_error(&placed);
    assert!(
        error.position < ROUND_OFF && error.velocity < ROUND_OFF,
        "{error:?}"
    );
}

#[test]
fn changes_of_units_change_no_acceleration() {
    // Every constraint in another unit: the same decisions, the same motion.
    let mechanism = Twice::<_, 2>(SliderCrank::default());
    let (angle, rate) = Passing::<3, 2>::singular(&SliderCrank::default());
    for away in [0.5, 0.02, 1e-3, 1e-6, 0.0] {
        let state = SliderCrank::default().state(0.0, angle + away, rate);
        let (once, _) = solve(&SliderCrank::default(), Settings::default(), &state).unwrap();
        let (twice, _) = solve::<_, 3, 4>(&mechanism, Settings::default(), &state).unwrap();
        assert!((once - twice).amax() < 1e-9, "{away}: {}", once - twice);
    }
}

/// Loops near singular positions among others that are not: each moves as it would alone, however far
/// from its own singular position it is.
#[test]
fn loops_near_singular_positions_move_as_they_would_alone() {
    let crank = SliderCrank::default();
    let (angle, rate) = Passing::<3, 2>::singular(&crank);
    for away in [
        [0.4, 1e-3, 0.7, -0.5],
        [1e-6, 0.3, 0.8, 0.5],
        [0.4, -0.6, 0.7, 0.0],
        [2e-3, 0.5, 1e-5, -0.4],
        [1e-3, -1e-3, 1e-7, 0.0],
        [0.6, 0.5, 0.4, 0.3],
    ] {
        let rates = [rate, 0.7 * rate, 1.3 * rate, -rate];
        let each: [_; COUNT] = core::array::from_fn(|k| {
            Passing::<3, 2>::state(&crank, 0.0, angle + away[k], rates[k])
        });
        for which in [Form::Reduced, Form::Full] {
            let (found, _) = solve(&Side, form(which), &Side::state(each)).unwrap();
            for k in 0..COUNT {
                let alone = exact::<_, 3, 2>(&crank, (angle + away[k], rates[k]));
                let error = (found.fixed_rows::<3>(3 * k) - alone).amax();
                assert!(error < 1e-8, "{which}, {k} of {away:?}: {error}");
            }
        }
    }
}

#[test]
fn eighty_one_coordinates_and_eighty_constraints_fit_on_a_small_stack() {
    let work = || {
        for away in [0.5, 1e-3] {
            let state = Passing::<81, 80>::state(&FourBars, 0.0, away, -3.0);
            let exact = Passing::<81, 80>::reduction(&FourBars).acceleration(away, -3.0);
            for which in [Form::Reduced, Form::Full] {
                let (q, _) = solve::<_, 81, 80>(&FourBars, form(which), &state).unwrap();
                assert!(
                    (q[0] - exact).abs() < 1e-7,
                    "{which}, {away}: {}",
                    q[0] - exact
                );
            }
        }
    };
    let thread = std::thread::Builder::new().stack_size(5 << 20).spawn(work);
    thread.unwrap().join().unwrap();
}

#[test]
fn a_mechanism_that_was_declared_regular_ends_at_a_singular_position() {
    static DECLARED: Structure = Structure {
        assumed_regular: true,
        ..PLAIN
    };
    let hung = Framed::<Hung, 6>::new(Hung, &DECLARED);
    let before = State::new(0.0, [0.3, -1.2].into(), [-6.0, 2.0].into());
    let start = Hung::state(&before);
    let options = Options::rk4(0.2, 0.01);
    let failure = simulate::<6, 4>(&hung, &start, &options, &mut []);
    let message = failure.map_or_else(|failure| failure.to_string(), |_| String::new());
    assert!(message.contains("declared to be regular"), "{message}");
}
