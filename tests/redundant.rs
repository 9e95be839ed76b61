//! Constraint rows that follow from others, which emitted solves leave out.

use crate::library::{Inspect, REDUNDANT, inspect};
use bricard_runtime::{Options, Summary, Whole, assemble, simulate};

/// Runs a mechanism, with its first parameter changed if another value is given.
struct Run {
    until: f64,
    first: Option<f64>,
}

/// What a run came to.
struct End {
    q: Vec<f64>,
    evaluations: u64,
    factorisations: u64,
}

impl Inspect<f64> for Run {
    type Output = End;

    fn inspect<const N: usize, const R: usize>(self, mechanism: &mut dyn Whole<f64, N, R>) -> End {
        if let Some(value) = self.first {
            assert!(mechanism.set_parameter(0, value));
        }
        let mechanism = &*mechanism;
        let start = assemble(mechanism, &mechanism.start(), 0.0).expect("the start assembles");
        let options = Options::dop853(self.until, 1e-11);
        let summary: Summary<f64, N> =
            simulate(mechanism, &start, &options, &mut []).expect("the run ends");
        End {
            q: summary.end.q.as_slice().to_vec(),
            evaluations: summary.counters.cheap_accelerations,
            factorisations: summary.counters.constraint_factorisations,
        }
    }
}

#[test]
fn emitted_solves_do_without_the_rows_that_follow_from_others() {
    for name in REDUNDANT {
        // With another parameter the second equation does not follow.
        let expected = usize::from(name != "loosened");
        assert_eq!(inspect(name, Left), expected, "{name}");
    }
    let run = Run {
        until: 1.0,
        first: None,
    };
    let End {
        evaluations,
        factorisations,
        ..
    } = inspect("spherical_four_bar", run);
    assert!(
        10 * factorisations < evaluations,
        "{factorisations} of {evaluations}"
    );
}

/// How many rows emitted solves leave out.
struct Left;

impl Inspect<f64> for Left {
    type Output = usize;

    fn inspect<const N: usize, const R: usize>(
        self,
        mechanism: &mut dyn Whole<f64, N, R>,
    ) -> usize {
        mechanism.structure().redundant.len()
    }
}

#[test]
fn rows_that_do_not_follow_with_other_parameters_are_obeyed() {
    let of = |share| {
        let run = Run {
            until: 2.0,
            first: Some(share),
        };
        inspect("loosened", run).q
    };
    // Both springs on both masses, at first at rest.
    let swings = (2.0_f64.sqrt() * 2.0).cos();
    for (share, height) in [(0.0, -2.0), (0.5, 0.0), (1e-3, 0.0)] {
        let exact = [swings, swings, height];
        for (found, exact) in of(share).iter().zip(exact) {
            let error = (found - exact).abs();
            assert!(error < 1e-9, "{share}: {found}, {exact}");
        }
    }
}

/// A row for velocities that the first contradicts, more and more.
#[test]
fn redundant_rows_that_contradict_one_another_end_the_run() {
    let run = |p| {
        let source = "mechanism Pulled { param p = 0; coord x: m; coord y: m; param w: 1/s = 1;
            param m: kg = 1; param c: m/s = 1;
            kinetic 1/2*m*(der(x)^2 + der(y)^2);
            constraint der(x) = c*sin(w*t); constraint der(x) = c*(sin(w*t) + p*(w*t)^4);
            start { x = 0; y = 0; der(x) ~ 0; der(y) = 1; } }";
        let folder = crate::command::folder("redundant");
        let file = folder.join("pulled.mech");
        std::fs::write(&file, source).expect("the folder is ours");
        let file = file.to_string_lossy().into_owned();
        let set = format!("p={p}");
        let words = [
            "simulate", &file, "--until", "2", "--set", &set, "--out", "-",
        ];
        crate::command::bricard(&words)
    };
    assert_eq!(run(0).status, Some(0));
    let refused = run(1);
    assert_ne!(refused.status, Some(0));
    assert!(refused.err.contains("is violated by"), "{}", refused.err);
}
