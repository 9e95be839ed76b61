//! Syntax to text, as a person writes it.
//!
//! In:  statements and formulas.
//! Out: text that reads back to the same statements and formulas. Comments are not
//!      part of them; doc comments are.

use super::ast::{
    Argument, Condition, Declaration, Declared, Drawing, Energy, Expr, ExprKind, Item, ItemKind,
    Range, Size, StartItem, UnitExpr,
};
use super::keyword::{DIRECTIONS, SHAPES};
use crate::expr::{Comparison, Number};

/// How tightly a formula holds together.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Choice,
    Sum,
    Product,
    Sign,
    Power,
    Atom,
}

/// A whole description.
pub fn description(name: &str, docs: &str, items: &[Item]) -> String {
    let (docs, items) = (doc_lines(docs, 0), block(items, 1));
    format!("{docs}mechanism {name} {{\n{items}}}\n")
}

fn block(items: &[Item], depth: usize) -> String {
    let line = |item: &Item| {
        let docs = doc_lines(&item.docs, depth);
        format!("{docs}{}{}\n", indent(depth), statement(&item.kind, depth))
    };
    items.iter().map(line).collect()
}

fn indent(depth: usize) -> String {
    "    ".repeat(depth)
}

fn doc_lines(docs: &str, depth: usize) -> String {
    let line = |text: &str| format!("{}{}\n", indent(depth), format!("/// {text}").trim_end());
    docs.lines().map(line).collect()
}

fn statement(kind: &ItemKind, depth: usize) -> String {
    match kind {
        ItemKind::Declaration(d) => declaration(d),
        ItemKind::Coordinate {
            state,
            name,
            size,
            unit: of,
        } => {
            let word = if *state { "state" } else { "coord" };
            let size = size
                .as_ref()
                .map_or(String::new(), |k| format!("[{}]", formula(k)));
            format!("{word} {}{size}{};", name.text, unit(of.as_ref()))
        }
        ItemKind::Let(l) => {
            let index = l.range.as_ref().map(|r| format!("[{}]", range(r)));
            let index = index.unwrap_or_default();
            let unit = unit(l.unit.as_ref());
            format!("let {}{index}{unit} = {};", l.name.text, formula(&l.value))
        }
        ItemKind::Function(f) => {
            let (name, unit) = (&f.name.text, unit(f.unit.as_ref()));
            let arguments = arguments(&f.arguments);
            format!("fn {name}({arguments}){unit} = {};", formula(&f.value))
        }
        ItemKind::Part(p) => {
            let items = block(&p.items, depth + 1);
            let (name, arguments) = (&p.name.text, arguments(&p.arguments));
            format!("part {name}({arguments}) {{\n{items}{}}}", indent(depth))
        }
        ItemKind::Use(library) => format!("use {};", library.text),
        ItemKind::Energy(kind, value) => format!("{} {};", energy(*kind), formula(value)),
        ItemKind::Force { force, on } => format!("force {} on {};", formula(force), formula(on)),
        ItemKind::Rate { of, value } => format!("der({}) = {};", formula(of), formula(value)),
        ItemKind::Constraint {
            name, left, right, ..
        } => {
            let name = name.as_ref().map(|name| format!("{}: ", name.text));
            let name = name.unwrap_or_default();
            format!("constraint {name}{} = {};", formula(left), formula(right))
        }
        ItemKind::Start(entries) => format!("start {}", start_block(entries, depth)),
        ItemKind::Event {
            name,
            value,
            direction,
        } => {
            let direction = word(&DIRECTIONS, *direction);
            format!("event {}: {} {direction};", name.text, formula(value))
        }
        ItemKind::Draw { shape, arguments } => draw(*shape, arguments),
        ItemKind::For(over, items) => {
            let items = block(items, depth + 1);
            format!("for {} {{\n{items}{}}}", range(over), indent(depth))
        }
    }
}

fn energy(kind: Energy) -> &'static str {
    match kind {
        Energy::Kinetic => "kinetic",
        Energy::Potential => "potential",
        Energy::Dissipation => "dissipation",
    }
}

fn declaration(d: &Declaration) -> String {
    let word = match d.kind {
        Declared::Constant => "const",
        Declared::Parameter => "param",
        Declared::Input => "input",
        Declared::Output => "output",
    };
    let size = match d.size.as_deref() {
        None => String::new(),
        Some(Size::Count(count)) => format!("[{}]", formula(count)),
        Some(Size::Each(over)) => format!("[{}]", range(over)),
    };
    let (name, unit, value) = (&d.name.text, unit(d.unit.as_ref()), formula(&d.value));
    format!("{word} {name}{size}{unit} = {value};")
}

fn arguments(arguments: &[Argument]) -> String {
    let text = |x: &Argument| format!("{}{}", x.name.text, unit(x.unit.as_ref()));
    arguments.iter().map(text).collect::<Vec<_>>().join(", ")
}

fn draw(shape: Drawing, arguments: &[Expr]) -> String {
    let word = word(&SHAPES, shape);
    format!("draw {word}({});", list(arguments))
}

/// The word for a meaning.
fn word<T: PartialEq + Copy>(words: &[(&'static str, T)], meaning: T) -> &'static str {
    let found = words.iter().find(|(_, known)| *known == meaning);
    found.map_or("", |(word, _)| word)
}

fn start_block(entries: &[StartItem], depth: usize) -> String {
    let inner = indent(depth + 1);
    let line = |entry: &StartItem| match entry {
        StartItem::Entry {
            target,
            held,
            value,
        } => {
            let sign = if *held { "=" } else { "~" };
            format!("{inner}{} {sign} {};\n", formula(target), formula(value))
        }
        StartItem::For(over, entries) => {
            let entries = start_block(entries, depth + 1);
            format!("{inner}for {} {entries}\n", range(over))
        }
    };
    let entries: String = entries.iter().map(line).collect();
    format!("{{\n{entries}{}}}", indent(depth))
}

fn unit(unit: Option<&UnitExpr>) -> String {
    unit.map(|unit| format!(": {}", unit.text))
        .unwrap_or_default()
}

fn range(range: &Range) -> String {
    let (from, to) = (formula(&range.from), formula(&range.to));
    format!("{} in {from}..{to}", range.index.text)
}

fn list(parts: &[Expr]) -> String {
    let parts: Vec<_> = parts.iter().map(formula).collect();
    parts.join(", ")
}

/// A formula.
pub fn formula(e: &Expr) -> String {
    match &e.kind {
        ExprKind::Number(number) => decimal(*number),
        ExprKind::Name(name) => name.clone(),
        ExprKind::Text(text) => format!("\"{text}\""),
        ExprKind::Negative(x) => format!("-{}", within(x, Binding::Sign)),
        ExprKind::Sum(terms) => chain(terms, [" + ", " - "], Binding::Product),
        ExprKind::Product(factors) => chain(factors, ["*", "/"], Binding::Power),
        ExprKind::Power(base, exponent) => {
            let (base, exponent) = (within(base, Binding::Atom), within(exponent, Binding::Sign));
            format!("{base}^{exponent}")
        }
        ExprKind::Call(name, arguments) => format!("{}({})", name.text, list(arguments)),
        ExprKind::Repeat(over, term) => format!("sum({}, {})", range(over), formula(term)),
        ExprKind::Vector(parts) => format!("[{}]", list(parts)),
        ExprKind::Component(x, axis) => {
            let axis = ["x", "y", "z"].get(*axis).unwrap_or(&"z");
            format!("{}.{axis}", part_of(x))
        }
        ExprKind::Member(x, name) => format!("{}.{}", part_of(x), name.text),
        ExprKind::Index(x, index) => format!("{}[{}]", part_of(x), formula(index)),
        ExprKind::InUnit(inside, unit) => format!("{} {}", formula(inside), unit.text),
        ExprKind::If(condition, then, otherwise) => {
            let condition = self::condition(condition);
            let then = within(then, Binding::Sum);
            format!("if {condition} then {then} else {}", formula(otherwise))
        }
    }
}

/// Terms or factors; the first may have a sign.
fn chain(parts: &[(bool, Expr)], signs: [&str; 2], tight: Binding) -> String {
    let mut text = String::new();
    for (i, (inverse, part)) in parts.iter().enumerate() {
        match i {
            0 => text.push_str(&within(part, tight.min_sign())),
            _ => {
                text.push_str(signs[usize::from(*inverse)]);
                text.push_str(&within(part, tight));
            }
        }
    }
    text
}

impl Binding {
    /// What may stand first in a chain: a sign too.
    fn min_sign(self) -> Binding {
        if self > Binding::Sign {
            Binding::Sign
        } else {
            self
        }
    }
}

/// A formula, in parentheses unless it holds together tightly enough.
fn within(e: &Expr, tight: Binding) -> String {
    let text = formula(e);
    if binding(e) >= tight {
        text
    } else {
        format!("({text})")
    }
}

/// What a component or an index is taken of.
fn part_of(e: &Expr) -> String {
    match e.kind {
        ExprKind::Number(_) => format!("({})", formula(e)),
        _ => within(e, Binding::Atom),
    }
}

fn binding(e: &Expr) -> Binding {
    match &e.kind {
        ExprKind::If(..) => Binding::Choice,
        ExprKind::Sum(_) => Binding::Sum,
        ExprKind::Product(_) => Binding::Product,
        ExprKind::Negative(_) => Binding::Sign,
        ExprKind::Power(..) => Binding::Power,
        _ => Binding::Atom,
    }
}

fn condition(condition: &Condition) -> String {
    match condition {
        Condition::Compare(comparison, sides) => {
            let sign = match comparison {
                Comparison::Less => "<",
                Comparison::LessEqual => "<=",
                Comparison::Equal => "==",
                Comparison::NotEqual => "!=",
            };
            let [left, right] = sides.each_ref().map(|side| within(side, Binding::Sum));
            format!("{left} {sign} {right}")
        }
        Condition::Not(inside) => format!("not {}", joined(inside)),
        Condition::And(a, b) => format!("{} and {}", joined(a), joined(b)),
        Condition::Or(a, b) => format!("{} or {}", joined(a), joined(b)),
    }
}

/// A part of a condition, in parentheses unless it is a comparison.
fn joined(part: &Condition) -> String {
    match part {
        Condition::Compare(..) => condition(part),
        _ => format!("({})", condition(part)),
    }
}

/// Decimals that a person would write out; longer ones get an exponent.
const PLACES: usize = 8;

/// A number as a decimal: exactly, where it is known exactly.
fn decimal(number: Number) -> String {
    let Number::Exact(n, d) = number else {
        return format!("{:e}", number.to_f64());
    };
    let scaled = (0..=38).find_map(|places: u32| {
        let ten = 10_i128.checked_pow(places)?;
        let digits = (ten % d == 0).then(|| n.checked_mul(ten / d))??;
        Some((digits, places as usize))
    });
    match scaled {
        Some((digits, 0)) => digits.to_string(),
        Some((digits, places)) if places <= PLACES => {
            let digits = format!("{digits:0>width$}", width = places + 1);
            let (whole, rest) = digits.split_at(digits.len() - places);
            format!("{whole}.{rest}")
        }
        Some((digits, places)) => format!("{digits}e-{places}"),
        None => format!("{:e}", number.to_f64()),
    }
}
