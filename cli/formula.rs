//! Numbers on the command line, written as in a description: `80*deg`.
//!
//! In:  text.
//! Out: a number, or `NAME=VALUE`; on failure a message that says what to write. The value
//!      of an input may be a formula of what moves, which is left as it is ([`crate::law`]).

use bricard_codegen::internals::expr::{ExprId, Function, Function2, Graph, Number};
use bricard_codegen::internals::syntax::{
    self,
    ast::{Expr, ExprKind},
};

/// `NAME=VALUE` or `NAME~VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// The name, without blanks.
    pub name: String,
    /// The value (SI).
    pub value: f64,
    /// Whether the value is held (`=`), or a guess (`~`).
    pub held: bool,
}

/// `NAME=VALUE` or `NAME=FORMULA`.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// A number.
    Number(Assignment),
    /// A formula of what has no value before a mechanism is known.
    Law {
        /// The name, without blanks.
        name: String,
        /// The formula.
        text: String,
        /// Why it is no number.
        why: String,
    },
}

impl Setting {
    /// What is set.
    pub fn name(&self) -> &str {
        match self {
            Self::Number(Assignment { name, .. }) | Self::Law { name, .. } => name,
        }
    }
}

/// One value of a name, or several of which each gives a run of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice<T> {
    /// The first value.
    pub first: T,
    /// The others, in the order in which they were given.
    pub others: Vec<T>,
}

impl<T> Choice<T> {
    /// All values.
    pub fn all(&self) -> impl Iterator<Item = &T> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// Reads a list of values with commas between them, each with the name before it.
    fn read(
        name: &str,
        values: &str,
        one: impl Fn(&str, &str) -> Result<T, String>,
    ) -> Result<Self, String> {
        let parts = listed(values);
        if parts.len() > 1 {
            for (i, part) in parts.iter().enumerate() {
                if part.trim().is_empty() {
                    return Err("a value is missing beside a comma".to_string());
                }
                let value = number(part).map_err(|why| format!("{why}; a list holds numbers"))?;
                if parts[..i].iter().any(|other| number(other) == Ok(value)) {
                    return Err(format!("the list has {} twice", part.trim()));
                }
            }
        }
        let mut all = parts.into_iter().map(|part| one(name, part));
        let first = all.next().unwrap_or_else(|| one(name, ""))?;
        let others = all.collect::<Result<_, _>>()?;
        Ok(Self { first, others })
    }
}

/// The parts of a text between commas that stand in no brackets.
fn listed(text: &str) -> Vec<&str> {
    let mut depth = 0_i32;
    let is_between = |sign: char| {
        match sign {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        sign == ',' && depth == 0
    };
    text.split(is_between).collect()
}

/// Reads `NAME=VALUE`, `NAME=VALUE,VALUE,…` or, for an input, `NAME=FORMULA`.
pub fn settings(text: &str) -> Result<Choice<Setting>, String> {
    match text.split_once('=') {
        Some((name, values)) => Choice::read(name, values, |name, value| {
            setting(&format!("{name}={value}"))
        }),
        None => setting(text).map(alone),
    }
}

/// Reads `NAME=VALUE`, `NAME~VALUE` or several values with commas between them.
pub fn starts(text: &str) -> Result<Choice<Assignment>, String> {
    match text.find(['=', '~']) {
        Some(place) => Choice::read(&text[..=place], &text[place + 1..], |name, value| {
            start(&format!("{name}{value}"))
        }),
        None => start(text).map(alone),
    }
}

fn alone<T>(first: T) -> Choice<T> {
    let others = Vec::new();
    Choice { first, others }
}

/// Reads `NAME=VALUE` or, for an input, `NAME=FORMULA`.
pub fn setting(text: &str) -> Result<Setting, String> {
    let split = text.split_once('=');
    let (name, value) = split.ok_or("write NAME=VALUE, such as `L1=0.5` or `q1=80*deg`")?;
    match evaluated(value)? {
        Ok(value) => Ok(Setting::Number(Assignment {
            name: named(name, '=')?,
            value,
            held: true,
        })),
        Err(why) => Ok(Setting::Law {
            name: named(name, '=')?,
            text: value.trim().to_string(),
            why,
        }),
    }
}

/// Reads `NAME=VALUE`, a value that is held, or `NAME~VALUE`, a guess.
pub fn start(text: &str) -> Result<Assignment, String> {
    let place = text.find(['=', '~']);
    let place =
        place.ok_or("write NAME=VALUE, such as `q1=80*deg`, or `NAME~VALUE` for a guess")?;
    let held = text.get(place..).is_some_and(|rest| rest.starts_with('='));
    assigned(&text[..place], &text[place + 1..], held)
}

fn assigned(name: &str, value: &str, held: bool) -> Result<Assignment, String> {
    Ok(Assignment {
        name: named(name, if held { '=' } else { '~' })?,
        value: number(value)?,
        held,
    })
}

/// The name before a sign, without blanks.
fn named(name: &str, sign: char) -> Result<String, String> {
    let name: String = name.split_whitespace().collect();
    match name.is_empty() {
        true => Err(format!("there is no name before `{sign}`")),
        false => Ok(name),
    }
}

/// Reads a formula of numbers, `pi` and `deg`.
///
/// Numbers are exact until the whole is evaluated: `80*deg` is 4/9 times π.
pub fn number(text: &str) -> Result<f64, String> {
    match split(text) {
        Some((number, rest)) if rest != "pi" && with_unit(number, rest).is_none() => {
            Err(format!("`{rest}` means nothing here: write `{number}`"))
        }
        _ => evaluated(text)?,
    }
}

/// The value of a formula. The outer error says that it is not written correctly, the inner
/// one why it has no value all the same.
fn evaluated(text: &str) -> Result<Result<f64, String>, String> {
    if let Some((number, rest)) = split(text) {
        let product = || format!("a product is written `{number}*{rest}`");
        return Err(with_unit(number, rest).unwrap_or_else(product));
    }
    let formula = syntax::formula(text).map_err(|diagnostics| {
        let sorted = diagnostics.sorted();
        let first = sorted.first().map(|first| match &first.help {
            Some(help) => format!("{}; {help}", first.message),
            None => first.message.clone(),
        });
        first.unwrap_or_else(|| "this is no formula".to_string())
    })?;
    let mut graph = Graph::new();
    Ok(lower(&mut graph, &formula).and_then(|value| {
        let value = graph.constant_value(value);
        value.ok_or_else(|| format!("`{}` is not a finite number", text.trim()))
    }))
}

/// What to write instead of a number with a unit behind it: `0.5m`, `60deg`, `2 s`.
fn with_unit(number: &str, unit: &str) -> Option<String> {
    Some(match unit {
        "deg" | "°" | "degree" | "degrees" => format!("write `{number}*deg`"),
        // Tonnes, or the time in the law of an input.
        "t" => format!(
            "values are in SI units: write `{number}*1e3` for tonnes; a product with the time, in the law of an input, is written `{number}*t`"
        ),
        _ => match si(unit)? {
            "1" => format!("values are in SI units and have none behind them: write `{number}`"),
            factor => format!("values are in SI units: write `{number}*{factor}`"),
        },
    })
}

/// A number and what stands behind it, if that begins with a letter. The number is as long as
/// it can be: the exponent of `1e-3*2` is no unit, and that of `1e2mm` no part of one.
fn split(text: &str) -> Option<(&str, &str)> {
    let text = text.trim();
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-');
    let longest = text.find(|c| !is_part(c)).unwrap_or(text.len());
    let mut ends = (1..=longest).rev();
    let end = ends.find(|&end| text[..end].parse::<f64>().is_ok())?;
    let (number, rest) = (&text[..end], text[end..].trim_start());
    let is_letter = |c: char| c.is_ascii_alphabetic() || c == '°';
    rest.starts_with(is_letter).then_some((number, rest))
}

/// The factor that turns a unit into the SI unit.
fn si(unit: &str) -> Option<&'static str> {
    match bricard_codegen::internals::keywords::units().any(|known| known == unit) {
        true => Some("1"),
        false => bricard_codegen::internals::keywords::scaled_units()
            .find(|(known, _)| *known == unit)
            .map(|(_, factor)| factor),
    }
}

fn lower(graph: &mut Graph, formula: &Expr) -> Result<ExprId, String> {
    Ok(match &formula.kind {
        ExprKind::Number(number) => graph.number(*number),
        ExprKind::Name(name) => constant(graph, name)?,
        ExprKind::Negative(x) => {
            let x = lower(graph, x)?;
            graph.neg(x)
        }
        ExprKind::Sum(terms) => {
            let terms = signed(graph, terms)?;
            let weight = |minus| {
                if minus {
                    Number::MINUS_ONE
                } else {
                    Number::ONE
                }
            };
            let terms: Vec<_> = terms
                .into_iter()
                .map(|(x, minus)| (x, weight(minus)))
                .collect();
            graph.weighted_sum(Number::ZERO, &terms)
        }
        ExprKind::Product(factors) => {
            let factors = signed(graph, factors)?;
            let power = |over| if over { -1 } else { 1 };
            let factors: Vec<_> = factors
                .into_iter()
                .map(|(x, over)| (x, power(over)))
                .collect();
            graph.power_product(&factors)
        }
        ExprKind::Power(base, exponent) => {
            let (base, exponent) = (lower(graph, base)?, lower(graph, exponent)?);
            graph.pow(base, exponent)
        }
        ExprKind::Call(name, arguments) => {
            let arguments: Vec<ExprId> = arguments
                .iter()
                .map(|x| lower(graph, x))
                .collect::<Result<_, _>>()?;
            call(graph, &name.text, &arguments)?
        }
        _ => return Err("only numbers, `pi`, `deg`, + - * / ^ and functions may be used".into()),
    })
}

fn signed(graph: &mut Graph, parts: &[(bool, Expr)]) -> Result<Vec<(ExprId, bool)>, String> {
    parts
        .iter()
        .map(|(flag, x)| Ok((lower(graph, x)?, *flag)))
        .collect()
}

fn constant(graph: &mut Graph, name: &str) -> Result<ExprId, String> {
    let pi = graph.pi();
    match name {
        "pi" => Ok(pi),
        "deg" => Ok(graph.scale(pi, Number::Exact(1, 180))),
        _ => Err(format!(
            "`{name}` has no value here; the constants are `pi` and `deg`"
        )),
    }
}

fn call(graph: &mut Graph, name: &str, arguments: &[ExprId]) -> Result<ExprId, String> {
    let one = Function::ALL.iter().find(|(_, known)| *known == name);
    let two = [Function2::Atan2, Function2::Min, Function2::Max];
    let two = two.iter().find(|function| function.name() == name);
    match (one, two, arguments) {
        (Some((function, _)), _, [x]) => Ok(graph.function(*function, *x)),
        (_, Some(function), [x, y]) => Ok(graph.function2(*function, *x, *y)),
        (None, None, _) => Err(format!("there is no function `{name}`")),
        _ => Err(format!("`{name}` has another number of arguments")),
    }
}

#[cfg(test)]
mod tests {
    use super::{Assignment, Setting, number, setting, settings, start, starts};

    #[test]
    fn formulas_of_constants_are_numbers() {
        let near = |text, wanted: f64| number(text).is_ok_and(|x| (x - wanted).abs() < 1e-15);
        assert_eq!(number("-1e-3"), Ok(-0.001));
        assert_eq!(number("1/3 + 2^-1"), Ok(5.0 / 6.0));
        assert!(near("80*deg", 80.0_f64.to_radians()));
        assert!(near("sqrt(2)*cos(pi/4)", 1.0));
        assert!(near("atan2(1, -1) - pi", -std::f64::consts::FRAC_PI_4));
    }

    #[test]
    fn what_is_no_number_is_refused_with_a_reason() {
        assert!(number("80*degrees").is_err_and(|e| e.contains("`degrees` has no value")));
        assert!(number("1/0").is_err_and(|e| e.contains("not a finite number")));
        assert!(number("").is_err());
        assert!(number("1 2").is_err());
        assert!(number("foo(1)").is_err_and(|e| e.contains("no function")));
    }

    #[test]
    fn a_number_with_a_unit_is_answered_with_the_si_value() {
        for (wrong, right) in [
            ("60deg", "write `60*deg`"),
            ("60°", "write `60*deg`"),
            ("2t", "written `2*t`"),
            ("0.5m", "write `0.5`"),
            ("2 s", "write `2`"),
            ("1e2N*m", "write `1e2`"),
            ("-1.5e2mm", "write `-1.5e2*1e-3`"),
            ("3 rpm", "write `3*2*pi/60`"),
            ("1e-9x", "`x` means nothing here: write `1e-9`"),
            ("2pi", "written `2*pi`"),
        ] {
            assert!(number(wrong).is_err_and(|e| e.contains(right)), "{wrong}");
        }
        assert_eq!(number("1e-3"), Ok(1e-3));
        assert_eq!(number("1e-3*2"), Ok(2e-3));
        assert_eq!(number("-2.5E+1/5"), Ok(-5.0));
        assert!(setting("u=1e3*t").is_ok_and(|set| matches!(set, Setting::Law { .. })));
        assert!(number("2*pi").is_ok() && number("pi").is_ok());
    }

    #[test]
    fn an_assignment_may_have_blanks() {
        let read = setting(" der(q1) = -2 ");
        let wanted = Assignment {
            name: "der(q1)".to_string(),
            value: -2.0,
            held: true,
        };
        assert_eq!(read, Ok(Setting::Number(wanted)));
        let guess = start("q1 ~ 0.8").map(|a| (a.name, a.value, a.held));
        assert_eq!(guess, Ok(("q1".to_string(), 0.8, false)));
        assert!(start("q1=0.8").is_ok_and(|a| a.held));
        assert!(start("~3").is_err_and(|e| e.contains("before `~`")));
        assert!(setting("q1~0.8").is_err());
        assert!(setting("q1").is_err());
        assert!(setting("=3").is_err());
    }

    #[test]
    fn a_list_of_values_is_split_where_no_brackets_are_open() {
        let values = |text| {
            let choice = starts(text)?;
            Ok::<_, String>(choice.all().map(|a| a.value).collect::<Vec<_>>())
        };
        assert_eq!(values("q1=1,2, 3/2"), Ok(vec![1.0, 2.0, 1.5]));
        assert_eq!(values("q1 ~ max(1, 2),4"), Ok(vec![2.0, 4.0]));
        assert_eq!(values("q1=5"), Ok(vec![5.0]));
        let held = starts("q1~1,2").map(|choice| choice.all().any(|a| a.held));
        assert_eq!(held, Ok(false));
        for (wrong, said) in [
            ("q1=1,,2", "missing beside a comma"),
            ("q1=1,", "missing beside a comma"),
            ("q1=1,2/2", "2/2 twice"),
            ("q1=1,x", "a list holds numbers"),
        ] {
            assert!(values(wrong).is_err_and(|e| e.contains(said)), "{wrong}");
        }
        let law = settings("u=table([[0, 1], [2, 3]], t)");
        assert!(law.is_ok_and(|law| law.others.is_empty()));
        assert!(settings("u=sin(t),cos(t)").is_err_and(|e| e.contains("a list holds numbers")));
        assert!(settings("u=").is_err() && settings("u").is_err());
    }

    #[test]
    fn a_formula_of_what_moves_is_left_as_it_is() {
        let Ok(Setting::Law { name, text, why }) = setting("u = 3*sin(t)") else {
            panic!("a law");
        };
        assert_eq!((name.as_str(), text.as_str()), ("u", "3*sin(t)"));
        assert!(why.contains("`t` has no value"), "{why}");
        assert!(matches!(
            setting("u=if t < 1 then 2 else 0"),
            Ok(Setting::Law { .. })
        ));
        assert!(setting("u=3*").is_err());
        assert!(setting("u=2 s").is_err_and(|e| e.contains("write `2`")));
        assert!(setting("u=2x").is_err_and(|e| e.contains("written `2*x`")));
    }
}
