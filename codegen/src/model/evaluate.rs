//! Formulas to values.
//!
//! In:  formulas of the syntax tree, names with their values.
//! Out: [`Value`]s whose expressions are valid: finite, no division by zero, no
//!      exponent beyond reason. `None` stands for a mistake that was reported.
//!
//! Not here: what a formula may contain where it stands; that is `check`'s.

use super::analysis::{Analyses, Analysis};
use super::declared::{Functions, Parts};
use super::language;
use super::messages::SIZE;
use super::order::{Mention, collect, parts};
use super::scope::{BUILT_IN, Kind, Scope};
use super::symbol::{Graph, Symbol};
use super::unit::Unit;
use super::unit_names;
use super::value::{Scalar, Value};
use crate::diagnostic::{Diagnostic, Diagnostics, Span, nearest};
use crate::expr::{Direction, ExprId, Function, Number, Table};
use crate::syntax::ast::{Expr, ExprKind, Range};
use crate::syntax::messages::{DECLARED, NO_QUOTES, did_you_mean};
use crate::syntax::{NESTING, SHAPES, STATEMENTS, place_of};
use std::path::PathBuf;

/// The most formulas that are evaluated for one description, loops unrolled.
const WORK: usize = 10_000_000;
/// The most indices of a range, and the most rounds of all loops together.
const ROUNDS: usize = 1_000_000;
/// Whole numbers from here on are not told apart.
const LARGEST: f64 = 1e18;
/// The most expressions that a mechanism may have, before and after its equations are derived:
/// about what rustc takes ten minutes for.
pub const EXPRESSIONS_MAX: usize = 150_000;

const UNIT_BEHIND: &str = "in `[…]` stands the size of an array; a unit goes behind `:`";

/// Evaluates formulas.
#[derive(Debug, Default)]
pub struct Evaluator {
    /// The expressions.
    pub graph: Graph,
    /// The names in force.
    pub scope: Scope,
    /// The functions that the description declares.
    pub functions: Functions,
    /// What was found.
    pub diagnostics: Diagnostics,
    /// What is being evaluated, where only numbers and constants may occur.
    pub constant: Option<&'static str>,
    /// Whether numbers are gains whose units nobody wrote.
    pub gains: bool,
    /// The direction of motion at frozen velocities.
    pub flow: Direction<Symbol>,
    /// The parts and the quantities in them.
    pub parts: Parts,
    pub analyses: Analyses,
    /// The folder of the description, if it has one, in which files are looked for.
    pub folder: Option<PathBuf>,
    /// The files that were read.
    pub files: Vec<PathBuf>,
    /// The tables that code holds as data.
    pub tables: Vec<&'static Table>,
    /// Whether what nothing uses is looked at, whose arguments have no values.
    pub unread: bool,
    work: usize,
    rounds: usize,
    /// Whether too much work was refused.
    exhausted: bool,
    /// The number of formulas inside one another.
    depth: usize,
}

impl Evaluator {
    /// Records a finding.
    pub fn report<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.diagnostics.push(diagnostic);
        None
    }

    /// What an expression is made of.
    pub fn analysis(&mut self, e: ExprId) -> Analysis {
        self.analyses.of(&self.graph, e)
    }

    /// Counts one piece of work; `None` if there was too much.
    pub fn spend(&mut self, span: Span) -> Option<()> {
        self.work += 1;
        let (most, what) = match self.graph.len() > EXPRESSIONS_MAX {
            true => (EXPRESSIONS_MAX, "expressions"),
            false if self.rounds > ROUNDS => (ROUNDS, "rounds of loops"),
            false if self.work > WORK => (WORK, "formulas"),
            false => return Some(()),
        };
        if !std::mem::replace(&mut self.exhausted, true) {
            let message = format!("unrolled, this description has more than {most} {what}");
            let error = Diagnostic::error(span, message);
            self.diagnostics
                .push(error.help("make the ranges of `for` and `sum` smaller"));
        }
        None
    }

    /// Counts one round of a loop of statements, which takes longer than a formula.
    pub fn spend_round(&mut self, span: Span) -> Option<()> {
        self.rounds += 1;
        self.spend(span)
    }

    /// The value of a formula.
    pub fn evaluate(&mut self, e: &Expr) -> Option<Value> {
        self.spend(e.span)?;
        self.depth += 1;
        let value = self.value(e);
        self.depth -= 1;
        value
    }

    /// Whether there is room for the formulas of a function inside the formula that is
    /// being evaluated.
    pub fn has_room(&self) -> bool {
        self.depth <= NESTING
    }

    fn value(&mut self, e: &Expr) -> Option<Value> {
        match &e.kind {
            ExprKind::Number(number) => {
                let id = self.graph.number(*number);
                let unit = if self.gains {
                    Unit::Unchecked
                } else {
                    Unit::Number
                };
                Some(Value::Scalar(Scalar { id, unit }))
            }
            ExprKind::Name(name) => self.look_up(name, e.span),
            ExprKind::Text(_) => {
                let error = Diagnostic::error(e.span, NO_QUOTES);
                self.report(error.help("a file of numbers is read by `table(\"file.csv\", t)`"))
            }
            ExprKind::Negative(inside) => self.negative(inside),
            ExprKind::Sum(terms) => self.sum(terms),
            ExprKind::Product(factors) => self.product(factors),
            ExprKind::Power(base, exponent) => self.power(base, exponent, e.span),
            ExprKind::Call(name, arguments) => self.call(name, arguments, e.span),
            ExprKind::Repeat(range, term) => self.repeated_sum(range, term, e.span),
            ExprKind::Vector(parts) => self.vector(parts, e.span),
            ExprKind::Component(inside, axis) => self.component(inside, *axis, e.span),
            ExprKind::Member(inside, name) => self.member(inside, &name.text, name.span),
            ExprKind::Index(inside, index) => self.element(inside, index, e.span),
            ExprKind::InUnit(inside, unit) => self.in_unit(inside, unit),
            ExprKind::If(condition, then, otherwise) => {
                self.choice(condition, then, otherwise, e.span)
            }
        }
    }

    /// The value of a formula that has to be a number.
    pub fn scalar(&mut self, e: &Expr, what: &str) -> Option<Scalar> {
        match self.evaluate(e)? {
            Value::Scalar(scalar) => Some(scalar),
            other => {
                let message = format!("{what} has to be a number, this is {}", other.shape());
                let help = match other {
                    Value::Array(_) => "write one element: `[0]` behind the name",
                    _ => "write one component, such as `.x`, or `norm(…)`",
                };
                self.report(Diagnostic::error(e.span, message).help(help))
            }
        }
    }

    /// The value of a formula that has to be a whole number known now.
    pub fn integer(&mut self, e: &Expr, what: &str) -> Option<i64> {
        let scalar = self.scalar(e, what)?;
        if let Some(value) = self.graph.as_number(scalar.id).and_then(Number::as_integer) {
            return Some(value);
        }
        let found = match self.analysis(scalar.id).value {
            Some(value) if value.abs() >= LARGEST => {
                let message = format!("{what} is too large: this is {value:e}");
                let help = "arrays have up to 10000 elements, loops a million rounds";
                return self.report(Diagnostic::error(e.span, message).help(help));
            }
            Some(value) if value.fract() == 0.0 => format!("this is {value} but for round-off"),
            Some(value) => format!("this is {value}"),
            None => "this is not".into(),
        };
        let message =
            format!("{what} has to be a whole number known when the code is generated, {found}");
        let help = self.make_constant(e);
        let help = help.unwrap_or_else(|| "build it of integers and constants".to_string());
        self.report(Diagnostic::error(e.span, message).help(help))
    }

    /// What to do about the parameters in a formula that has to be constant, if there are any.
    pub fn make_constant(&self, e: &Expr) -> Option<String> {
        let mut names: Vec<String> = Vec::new();
        collect(e, &mut |mention| {
            if let Mention::Name(name) = mention
                && let Some(entry) = self.scope.get(name)
                && entry.kind == Kind::Parameter
                && !names.contains(&format!("`{name}`"))
            {
                names.push(format!("`{name}`"));
            }
        });
        let names = names.join(" and ");
        (!names.is_empty()).then(|| format!("declare {names} with `const` instead of `param`"))
    }

    /// The bounds of a range.
    pub fn bounds(&mut self, range: &Range) -> Option<std::ops::Range<i64>> {
        let from = self.integer(&range.from, "the bound of a range");
        let to = self.integer(&range.to, "the bound of a range");
        let (from, to) = (from?, to?);
        if to.saturating_sub(from) > ROUNDS as i64 {
            let span = range.from.span.to(range.to.span);
            let message = format!(
                "a range of {} indices is too large",
                to.saturating_sub(from)
            );
            return self
                .report(Diagnostic::error(span, message).help(format!("the limit is {ROUNDS}")));
        }
        Some(from..to)
    }

    fn look_up(&mut self, name: &str, span: Span) -> Option<Value> {
        if let Some(value) = self.built_in(name, span) {
            return value;
        }
        match self.scope.get(name) {
            Some(_) => self.declared(name, false, span),
            None => self.undeclared(name, span),
        }
    }

    /// The value of a declared name, which may be in full.
    pub fn declared(&mut self, name: &str, full: bool, span: Span) -> Option<Value> {
        let entry = self.scope.look_up(name, full)?;
        let (kind, place) = (entry.kind, entry.name.span);
        if entry.value.is_none() {
            let full = entry.name.text.clone();
            self.evaluate_waiting(&full, kind, span);
        }
        let value = self.scope.look_up(name, full)?.value.clone();
        match self.constant {
            // What is wrong with a part has been said.
            Some(_) if kind == Kind::Part => None,
            Some(what) if !matches!(kind, Kind::Constant | Kind::Index | Kind::Argument) => {
                let message = format!(
                    "{what} is built of numbers and constants; `{name}` is {}",
                    kind.words()
                );
                let error = Diagnostic::error(span, message).also(place, DECLARED);
                let help = match (what, kind) {
                    (SIZE, Kind::Parameter) if unit_names::units().any(|unit| unit == name) => {
                        format!("{UNIT_BEHIND}; for a size, declare `{name}` with `const`")
                    }
                    (SIZE, Kind::Parameter) => {
                        format!("declare `{name}` with `const` instead of `param`")
                    }
                    (SIZE, _) => "build it of integers and constants".to_string(),
                    _ => format!("what depends on {} is written with `let`", kind.words()),
                };
                self.report(error.help(help))
            }
            _ => value,
        }
    }

    fn built_in(&mut self, name: &str, span: Span) -> Option<Option<Value>> {
        let (id, unit) = match name {
            "t" => match self.constant {
                Some(what) => {
                    let message = format!("{what} can't depend on the time `t`");
                    let error = Diagnostic::error(span, message);
                    return Some(
                        self.report(error.help("what depends on time is written with `let`")),
                    );
                }
                None => (self.graph.symbol(Symbol::Time), Unit::Unchecked),
            },
            "pi" => (self.graph.pi(), Unit::Number),
            "deg" => {
                let pi = self.graph.pi();
                let half_turn = self.graph.integer(180);
                (self.graph.div(pi, half_turn), Unit::PURE)
            }
            _ => return None,
        };
        Some(Some(Value::Scalar(Scalar { id, unit })))
    }

    /// Refuses names in a formula that nothing evaluates; some are known there besides.
    pub fn refuse_unknown(&mut self, formula: &Expr, known: &mut Vec<String>) {
        let count = known.len();
        match &formula.kind {
            ExprKind::Name(name) => {
                let built_in = BUILT_IN.iter().any(|(built_in, _)| built_in == name);
                if !built_in && !known.contains(name) && self.scope.get(name).is_none() {
                    self.undeclared(name, formula.span);
                }
            }
            ExprKind::Call(name, _) => self.refuse_unknown_function(name),
            ExprKind::Repeat(range, _) => known.push(range.index.text.clone()),
            _ => {}
        }
        for part in parts(formula) {
            self.refuse_unknown(part, known);
        }
        known.truncate(count);
    }

    fn undeclared(&mut self, name: &str, span: Span) -> Option<Value> {
        if self.scope.unreadable.contains(name) {
            return None;
        }
        if self.parts.known(name) {
            let error = Diagnostic::error(span, format!("`{name}` is a part, no quantity"));
            return self.report(error.help(format!(
                "use it, `let a = {name}(…);`, and write a name in it behind a dot: `a.…`"
            )));
        }
        if let Some(help) = self.elsewhere(name) {
            let error = Diagnostic::error(span, format!("`{name}` is not declared"));
            return self.report(error.help(help));
        }
        if self.scope.outputs.contains(&self.scope.full(name)) {
            return self.output_in_formula(name, span);
        }
        // Whoever writes `phi` or `psi` means no `pi`, nor by `T` the time.
        let built_in = BUILT_IN.iter().map(|(name, _)| *name);
        let built_in = built_in.filter(|known| *known != "pi" && name != "T");
        let near = nearest(name, self.scope.names().chain(built_in)).map(str::to_string);
        let help = if Function::ALL.iter().any(|(_, known)| *known == name)
            || language::known(name)
            || self.functions.contains(name)
        {
            format!("`{name}` is a function: write `{name}(…)`")
        } else if let Some(place) = place_of(name) {
            place
        } else if let Some(unit) = unit_names::in_expression(name) {
            unit
        } else if let Some(near) = near {
            did_you_mean(&near)
        } else if let Some(statement) = begins_a_statement(name) {
            statement
        } else {
            format!("declare it, for example `param {name} = 1;`, or `coord {name};` if it moves")
        };
        self.report(Diagnostic::error(span, format!("`{name}` is not declared")).help(help))
    }

    /// What other languages write for the time and for velocities: `qdot`, `q_dot`, `dq`.
    fn elsewhere(&self, name: &str) -> Option<String> {
        if ["time", "Time", "TIME"].contains(&name) {
            return Some("the time is `t`".to_string());
        }
        if ["Pi", "PI"].contains(&name) {
            return Some("the number π is `pi`".to_string());
        }
        if name == "dt" {
            return Some("a derivative in time is written `der(x)`".to_string());
        }
        if name == "e" {
            return Some("declare it; the exponential function is `exp(x)`".to_string());
        }
        if name == "g" {
            return Some("declare it: `const g: m/s^2 = 9.81;`".to_string());
        }
        if self.constant == Some(SIZE) && unit_names::units().any(|unit| unit == name) {
            return Some(UNIT_BEHIND.to_string());
        }
        let behind = ["_dot", "dot", "Dot", "_d", "d"].map(|end| name.strip_suffix(end));
        let before = ["d", "D", "v_", "v"].map(|start| name.strip_prefix(start));
        let moves = |name: &&str| {
            let entry = self.scope.get(name);
            entry.map_or(self.scope.unreadable.contains(*name), |entry| {
                entry.kind == Kind::Coordinate
            })
        };
        let twice = ["_ddot", "ddot", "DDot", "_dd", "dd"].map(|end| name.strip_suffix(end));
        let twice = twice.into_iter().chain([name.strip_prefix("dd")]);
        if let Some(coordinate) = twice.flatten().find(moves) {
            return Some(format!(
                "the acceleration of `{coordinate}` is written `der(der({coordinate}))`, in \
                 outputs alone"
            ));
        }
        let coordinate = behind.into_iter().chain(before).flatten().find(moves)?;
        Some(format!(
            "the velocity of `{coordinate}` is written `der({coordinate})`"
        ))
    }
}

/// How a statement is written that a word begins, or goes on with behind `draw`.
fn begins_a_statement(name: &str) -> Option<String> {
    if SHAPES.iter().any(|(shape, _)| *shape == name) {
        return Some(format!("`{name}` stands behind `draw`: `draw {name}(…);`"));
    }
    let (.., example) = STATEMENTS.iter().find(|(known, ..)| *known == name)?;
    Some(format!("`{name}` begins a statement: `{example}`"))
}
