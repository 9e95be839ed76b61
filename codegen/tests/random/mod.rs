//! Random mechanisms: what holds of every mechanism, for trees and loops in the plane
//! and in space that nobody chose.
//!
//! Everything is evaluated, nothing compiled, so that thousands pass in seconds. A
//! failure is shrunk and printed as a description.

mod derivatives;
mod description;
mod eliminated;
mod forms;
mod identities;
mod invariances;
mod shared;

use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{Equations, derive};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::Mechanism;
use proptest::test_runner::{Config, RngSeed, TestCaseError};

/// How many mechanisms each test tries; `BRICARD_LONG=1` tries a hundred thousand.
const CASES: u32 = 250;
const LONG_CASES: u32 = 100_000;

/// How many descriptions may be thrown away, on average, for each that is tried: more,
/// and a filter lets next to nothing pass.
const REJECTS_PER_CASE: u32 = 16;

/// What values may differ by, relative to the sizes of what was added up.
const ROUND_OFF: f64 = 1e-11;

fn config() -> Config {
    let long = std::env::var_os("BRICARD_LONG").is_some();
    let cases = if long { LONG_CASES } else { CASES };
    Config {
        cases,
        max_local_rejects: REJECTS_PER_CASE * cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(19_840_223),
        ..Config::default()
    }
}

/// A mechanism with its equations at one state.
struct Case {
    mechanism: Mechanism,
    equations: Equations,
    q: Vec<f64>,
    v: Vec<f64>,
}

impl Case {
    fn new(source: &str, q: Vec<f64>, v: Vec<f64>) -> Result<Self, TestCaseError> {
        let analysed = analyse(source, &CompileSettings::default());
        let (mut mechanism, _) =
            analysed.map_err(|errors| TestCaseError::fail(errors.render("random.mech", source)))?;
        let equations = derive(&mut mechanism)
            .map_err(|errors| TestCaseError::fail(errors.render("random.mech", source)))?;
        Ok(Self {
            mechanism,
            equations,
            q,
            v,
        })
    }

    fn symbol(&self, symbol: Symbol) -> f64 {
        match symbol {
            Symbol::Coordinate(i) => self.q[i as usize],
            Symbol::Velocity(i) => self.v[i as usize],
            _ => 0.0,
        }
    }

    fn value(&self, e: ExprId) -> f64 {
        let graph = &self.mechanism.graph;
        graph.evaluate(e, &|symbol| self.symbol(symbol))
    }

    fn vector(&self, entries: &[ExprId]) -> Vec<f64> {
        let graph = &self.mechanism.graph;
        graph.evaluate_all(entries, &|symbol| self.symbol(symbol))
    }

    /// Values at another state than the case's own.
    fn vector_at(&self, q: &[f64], v: &[f64], entries: &[ExprId]) -> Vec<f64> {
        let symbol = |symbol| match symbol {
            Symbol::Coordinate(i) => q[i as usize],
            Symbol::Velocity(i) => v[i as usize],
            _ => 0.0,
        };
        self.mechanism.graph.evaluate_all(entries, &symbol)
    }

    /// The entries of `M`, which every short mechanism has.
    fn mass(&self) -> &[Vec<ExprId>] {
        self.equations.mass.as_deref().expect("a short mechanism")
    }

    fn matrix(&self, rows: &[Vec<ExprId>]) -> Vec<Vec<f64>> {
        rows.iter().map(|row| self.vector(row)).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The size of what a product of vectors adds up.
fn size(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x * y).abs()).sum()
}

/// Two values are the same but for round-off against a size.
fn agree(what: &str, found: f64, exact: f64, size: f64) -> Result<(), TestCaseError> {
    let bound = ROUND_OFF * (1.0 + size + exact.abs());
    if (found - exact).abs() <= bound {
        return Ok(());
    }
    let message = format!("{what}: {found:e} is not {exact:e}, which may differ by {bound:e}");
    Err(TestCaseError::fail(message))
}
