//! Motions that nothing projects: they stay on their branch, or end in an error where the
//! constraint error no longer tells which it is.

use bricard_runtime::{
    DynamicsError, IntegrateError, Method, Options, Recorder, SimulateError, Singularity,
    Stabilisation, Whole, assemble, simulate,
};
use bricard_singular::descriptions::equal_slider_crank::EqualSliderCrank;
use bricard_singular::descriptions::two_parallelograms::TwoParallelograms;

const METHODS: [Method; 4] = [Method::Dop853, Method::Dp5, Method::Radau5, Method::Radau9];

fn options(until: f64, method: Method, tolerance: f64, way: Stabilisation<f64>) -> Options<f64> {
    let mut options = Options {
        method,
        ..Options::dop853(until, tolerance)
    };
    options.settings.stabilisation = way;
    options
}

fn has_drifted(error: &SimulateError<f64>) -> bool {
    let kind = |error: &DynamicsError<f64>| match error {
        DynamicsError::SingularConfiguration { kind, .. } => Some(*kind),
        _ => None,
    };
    match error {
        SimulateError::Integrate(IntegrateError::Dynamics(error)) => {
            kind(error) == Some(Singularity::Drifted)
        }
        _ => false,
    }
}

/// On its branch both links of the equal slider–crank make the same angle with the guide. A drift
/// that opens a gap where branches cross would lead onto the other one.
#[test]
fn a_drifting_motion_ends_before_it_changes_its_branch() {
    let mechanism = EqualSliderCrank::<f64>::default();
    let mechanism: &dyn Whole<f64, 2, 1> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let mut ended = 0;
    for method in METHODS {
        for tolerance in [1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11] {
            let name = format!("{method:?} {tolerance:e}");
            let options = options(30.0, method, tolerance, Stabilisation::None);
            let mut recorder = Recorder::new(0.05).expect("an interval");
            let ran = simulate(mechanism, &start, &options, &mut [&mut recorder]);
            if let Err(failure) = ran {
                assert!(has_drifted(&failure.error), "{name}: {failure}");
                ended += 1;
            }
            for row in recorder.rows() {
                let off = (row.q[0] + row.q[1]).abs();
                assert!(off < 0.5, "{name}: off by {off:e} at t = {}", row.t);
            }
        }
    }
    assert!(ended > 0);
}

#[test]
fn baumgarte_s_terms_keep_passages_what_they_are() {
    let mechanism = TwoParallelograms::<f64>::default();
    let mechanism: &dyn Whole<f64, 7, 4> = &mechanism;
    let start = assemble(mechanism, &mechanism.start(), 0.0).expect("it can be assembled");
    let passages = |method, tolerance, way| {
        let options = options(4.0, method, tolerance, way);
        let mut recorder = Recorder::new(0.2).expect("an interval");
        let ran = simulate(mechanism, &start, &options, &mut [&mut recorder]);
        let name = format!("{method:?} {tolerance:e} {way:?}");
        match ran {
            Ok(summary) => summary.passages,
            Err(failure) => {
                assert!(has_drifted(&failure.error), "{name}: {failure}");
                None
            }
        }
    };
    let expected = passages(Method::Dop853, 1e-11, Stabilisation::Projection);
    assert!(expected.is_some_and(|count| count > 3), "{expected:?}");
    let mut finished = 0;
    for method in METHODS {
        for tolerance in [1e-6, 1e-7, 2e-8, 5e-9, 1e-9] {
            for gain in [6.0, 10.0, 25.0] {
                let way = Stabilisation::Baumgarte {
                    alpha: gain,
                    beta: gain,
                };
                let found = passages(method, tolerance, way);
                let keeps = found.is_none() || found == expected;
                assert!(
                    keeps,
                    "{method:?} {tolerance:e} {gain}: {found:?} {expected:?}"
                );
                finished += usize::from(found.is_some());
            }
        }
    }
    assert!(finished > 40, "{finished}");
}
