//! The forms of the equations of motion, solved for random mechanisms with loops.

use super::description::{BODIES_MAX, Body, Joint, Manner, Random, any, state};
use super::{Case, config};
use bricard_codegen::internals::derive::{Energies, Equations};
use bricard_codegen::internals::expr::ExprId;
use bricard_runtime::nalgebra::{SMatrix, SVector};
use bricard_runtime::{
    DynamicsError, Energy, Form, Initial, Mechanism, Position, Quantity, Settings, Singularity,
    Solver, Start, State, Structure, Terms, assemble,
};
use proptest::prelude::*;

/// Positions at which the constraints are independent by less than this sine are left
/// out: the forms that can't pass singular positions lose digits there.
const REGULAR_SINE: f64 = 0.05;
/// What forms may differ by, relative to the largest acceleration.
const FORMS: f64 = 1e-8;

/// An angle as random descriptions have them: without a unit. Like those of any
/// mechanism they are turned to find out which rows and masses are small everywhere,
/// and which only at one position.
const COORDINATE: Quantity = Quantity {
    name: "q",
    unit: "",
    docs: "",
};

/// What is known about mechanisms with one coordinate, with two, and so on.
static NAMELESS: [Structure; BODIES_MAX] = [
    nameless(&[COORDINATE], &[0]),
    nameless(&[COORDINATE; 2], &[0, 1]),
    nameless(&[COORDINATE; 3], &[0, 1, 2]),
    nameless(&[COORDINATE; 4], &[0, 1, 2, 3]),
];

const fn nameless(
    coordinates: &'static [Quantity],
    unitless_angles: &'static [usize],
) -> Structure {
    Structure {
        name: "Random",
        coordinates,
        unitless_angles,
        conservative: true,
        ..Structure::PLAIN
    }
}

/// A mechanism whose equations are evaluated, not compiled.
struct Interpreted<'a>(&'a Case);

impl Interpreted<'_> {
    /// Values of several matrices, one after the other: evaluated at once, they share
    /// what they have in common.
    fn values<const N: usize>(
        &self,
        state: &State<f64, N>,
        rows: &[&[Vec<ExprId>]],
        entries: &[&[ExprId]],
    ) -> std::vec::IntoIter<f64> {
        let mut all: Vec<ExprId> = rows.iter().flat_map(|rows| rows.concat()).collect();
        entries.iter().for_each(|entries| all.extend(*entries));
        let (q, v) = (state.q.as_slice(), state.v.as_slice());
        self.0.vector_at(q, v, &all).into_iter()
    }
}

/// The next entries of a stream, row by row.
fn matrix<const K: usize, const L: usize>(
    values: &mut impl Iterator<Item = f64>,
) -> SMatrix<f64, K, L> {
    SMatrix::from_row_iterator(values.by_ref().take(K * L))
}

impl<const N: usize, const R: usize> Mechanism<f64, N, R> for Interpreted<'_> {
    fn structure(&self) -> &'static Structure {
        &NAMELESS[N - 1]
    }

    fn terms(&self, state: &State<f64, N>, out: &mut Terms<f64, N, R>) {
        let Equations {
            jacobian,
            force,
            bias,
            ..
        } = &self.0.equations;
        let values = &mut self.values(state, &[self.0.mass(), jacobian], &[force, bias]);
        (out.mass, out.jacobian) = (matrix(values), matrix(values));
        (out.force, out.bias) = (matrix(values), matrix(values));
    }

    fn position(&self, state: &State<f64, N>, out: &mut Position<f64, N, R>) {
        let Equations {
            jacobian,
            residual,
            drift,
            ..
        } = &self.0.equations;
        let values = &mut self.values(state, &[self.0.mass(), jacobian], &[residual, drift]);
        (out.mass, out.jacobian) = (matrix(values), matrix(values));
        (out.residual, out.drift) = (matrix(values), matrix(values));
    }

    fn energy(&self, state: &State<f64, N>) -> Energy<f64> {
        let Energies {
            kinetic,
            potential,
            balance,
            power,
        } = self.0.equations.energies;
        let values = &mut self.values(state, &[], &[&[kinetic, potential, balance, power]]);
        let mut next = || values.next().unwrap_or(f64::NAN);
        Energy {
            kinetic: next(),
            potential: next(),
            balance: next(),
            power: next(),
        }
    }
}

/// Directions that the rows leave free: what Gram and Schmidt leave of the axes.
///
/// Angles are those of the metric of the kinetic energy, `M = L Lᵀ`, like those of
/// [`Rank::sine`](bricard_runtime::Rank): in coordinates as they are, two rows may
/// differ by less by the square root of the condition of `M`.
fn null_space<const N: usize, const R: usize>(
    rows: &SMatrix<f64, R, N>,
    lower: &SMatrix<f64, N, N>,
) -> Vec<SVector<f64, N>> {
    let mut taken: Vec<SVector<f64, N>> = Vec::new();
    let left = |taken: &[SVector<f64, N>], vector: SVector<f64, N>| {
        let once = |vector: SVector<f64, N>| taken.iter().fold(vector, |x, e| x - e * e.dot(&x));
        once(once(vector))
    };
    for row in rows.row_iter() {
        let lifted = lower
            .solve_lower_triangular(&row.transpose())
            .expect("M is definite");
        let rest = left(&taken, lifted);
        if rest.norm() > REGULAR_SINE * lifted.norm() * 0.1 {
            taken.push(rest.normalize());
        }
    }
    let fixed = taken.len();
    while taken.len() < N {
        let axes =
            (0..N).map(|i| left(&taken, SVector::from_fn(|j, _| f64::from(u8::from(i == j)))));
        let longest = axes.max_by(|a, b| a.norm().total_cmp(&b.norm()));
        taken.extend(longest.map(|axis| axis.normalize()));
    }
    let back = |w| lower.tr_solve_lower_triangular(&w).expect("M is definite");
    let free = taken.split_off(fixed).into_iter();
    free.map(|w| back(w).normalize()).collect()
}

/// Whether the mechanism can be assembled at a regular position near the state; if so,
/// all forms were compared there.
fn forms_agree<const N: usize, const R: usize>(case: &Case) -> Result<bool, TestCaseError> {
    let mechanism = Interpreted(case);
    let guess = |value: &f64| Initial {
        value: *value,
        held: false,
    };
    let start = Start {
        q: core::array::from_fn(|i| guess(&case.q[i])),
        v: core::array::from_fn(|i| guess(&case.v[i])),
    };
    let Ok(state) = assemble::<f64, _, N, R>(&mechanism, &start, 0.0) else {
        return Ok(false);
    };
    let mut solver = Solver::<f64, N, R>::new(Settings::default());
    let rank = match solver.on(&mechanism).rank(&state) {
        // Two points whose distance is just as long as their arms reach.
        Err(DynamicsError::SingularConfiguration {
            kind: Singularity::Vanishing,
            ..
        }) => return Ok(false),
        rank => rank.map_err(|e| TestCaseError::fail(e.to_string()))?,
    };
    if rank.rank < R || rank.sine < REGULAR_SINE {
        return Ok(false);
    }
    let mut terms = Terms::<f64, N, R>::default();
    mechanism.terms(&state, &mut terms);
    let metric = terms.mass.cholesky();
    let metric = metric.ok_or_else(|| TestCaseError::fail("M is not definite"))?;
    let free = null_space(&terms.jacobian, &metric.l());
    prop_assert_eq!(free.len(), N - R);
    let mut first: Option<SVector<f64, N>> = None;
    for form in Form::ALL {
        let mut solver = Solver::<f64, N, R>::new(Settings {
            form,
            ..Settings::default()
        });
        let found = solver.on(&mechanism).reaction(&state);
        let (a, r) = found.map_err(|e| TestCaseError::fail(format!("{form}: {e}")))?;
        let exact = *first.get_or_insert(a);
        let bound = FORMS * (1.0 + exact.amax()) / rank.sine;
        prop_assert!((a - exact).amax() <= bound, "{form}: {a} is not {exact}");
        let gap = terms.jacobian * a - terms.bias;
        let size = terms.jacobian.amax() * a.amax() + terms.bias.amax();
        prop_assert!(
            gap.amax() <= FORMS * (1.0 + size),
            "{form}: A q̈ − p₂ = {gap}"
        );
        for direction in &free {
            let along = terms.jacobian * direction;
            prop_assert!(
                along.amax() <= 1e-12 * (1.0 + terms.jacobian.amax()),
                "A D = {along}"
            );
            let work = direction.dot(&r);
            let size = terms.force.amax() + terms.mass.amax() * a.amax();
            prop_assert!(
                work.abs() <= FORMS * (1.0 + size) / rank.sine,
                "{form}: Dᵀr = {work}"
            );
        }
    }
    Ok(true)
}

fn compared(case: &Case, n: usize, rows: usize) -> Result<bool, TestCaseError> {
    match (n, rows) {
        (2, 1) => forms_agree::<2, 1>(case),
        (3, 1) => forms_agree::<3, 1>(case),
        (4, 1) => forms_agree::<4, 1>(case),
        (3, 2) => forms_agree::<3, 2>(case),
        (4, 2) => forms_agree::<4, 2>(case),
        _ => Ok(false),
    }
}

fn tied() -> impl Strategy<Value = Random> {
    any().prop_filter("has a loop that leaves it free to move", |random| {
        let ties = random.ties();
        ties > 0 && ties < random.n()
    })
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn forms_agree_and_reactions_do_no_work_at_regular_positions(
        random in tied(), (q, v) in state(),
    ) {
        let case = Case::new(&random.text(Manner::PLAIN), q, v)?;
        let rows = case.equations.residual.len();
        compared(&case, random.n(), rows)?;
    }
}

/// The rows differ by an angle of 0.04 degrees in the metric of the kinetic energy: two
/// bodies have short levers in them here, but not elsewhere.
#[test]
fn a_position_next_to_a_singular_one_is_not_taken_for_regular() {
    let body = |parent, length, mass, inertia| Body {
        parent,
        joint: Joint::Hinge('z'),
        length,
        mass,
        inertia,
    };
    let random = Random {
        bodies: vec![
            body(0, 14, 1, 1),
            body(1, 12, 7, 3),
            body(1, 18, 2, 1),
            body(2, 2, 4, 14),
        ],
        loops: vec![(3, 0, 16), (0, 1, 4)],
    };
    let q = [
        0.661_881_188_640_822,
        0.858_750_613_912_074_9,
        0.918_210_226_484_534,
        -0.105_414_635_057_841,
    ];
    let case = Case::new(&random.text(Manner::PLAIN), q.to_vec(), vec![0.0; 4]);
    let case = case.expect("a mechanism");
    let is_compared = compared(&case, 4, 2).expect("no contradiction");
    assert!(!is_compared, "it was taken for regular");
}

#[test]
fn most_random_loops_are_compared() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::new(super::Config {
        cases: 1,
        ..config()
    });
    let strategy = (tied(), state());
    let mut hits = 0;
    const TRIED: usize = 200;
    for _ in 0..TRIED {
        let (random, (q, v)) = strategy.new_tree(&mut runner).expect("a value").current();
        let case = Case::new(&random.text(Manner::PLAIN), q, v).expect("a mechanism");
        let rows = case.equations.residual.len();
        hits += usize::from(compared(&case, random.n(), rows).expect("no contradiction"));
    }
    assert!(
        hits > TRIED / 4,
        "only {hits} of {TRIED} are assembled at regular positions"
    );
}
