//! A mechanism that is being put together: what is done, and what is known so far.

use super::Mechanism;
use super::declared::Frame;
use super::evaluate::Evaluator;
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::ast::Part;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The work in progress.
pub struct Lowering<'a> {
    /// Formulas and names.
    pub evaluator: Evaluator,
    /// What is done. Its graph is with the evaluator until the end.
    pub mechanism: Mechanism,
    /// Constants with another value.
    pub constants: &'a [(String, f64)],
    /// Parameters that become constants.
    pub frozen: &'a [String],
    /// The loops around, with the value of each index.
    pub indices: Vec<(String, i64)>,
    /// The parts that statements can use.
    pub parts: FxHashMap<&'a str, &'a Part>,
    /// The parts that statements use.
    pub used_parts: Vec<String>,
    /// Where names are looked up.
    pub frame: Rc<Frame>,
    /// Quantities that wait for their values, in order of declaration.
    pub waiting: Vec<String>,
    /// The number of inputs so far.
    pub n_inputs: u32,
    /// The names of outputs and events and the places of start entries so far.
    pub named: Named,
}

/// Names and targets that are taken, each with its place.
#[derive(Debug, Default)]
pub struct Named {
    /// Outputs.
    pub outputs: FxHashMap<String, Span>,
    /// Events.
    pub events: FxHashMap<String, Span>,
    /// Constraints.
    pub constraints: FxHashMap<String, Span>,
    /// Points of the picture: the first with two components, and the first with three.
    pub points: FxHashMap<usize, Span>,
    /// States whose rate is given, by their coordinates.
    pub rates: FxHashMap<u32, Span>,
    /// Start entries: coordinate, whether the velocity is meant; with the number of parts
    /// around.
    pub starts: FxHashMap<(u32, bool), (Span, usize)>,
    /// Whether a loop ended at what is wrong, so that not every target is known.
    pub cut_short: bool,
}

impl Lowering<'_> {
    /// Records a finding.
    pub fn report<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.evaluator.report(diagnostic)
    }
}
