//! Numbers on the command line, written as in a description: `80*deg`.
//!
//! In:  text.
//! Out: a number, or `NAME=VALUE`; on failure a message that says what to write.

use bricard_codegen::expr::{ExprId, Function, Function2, Graph, Number};
use bricard_codegen::parse::{
    self,
    ast::{Expr, ExprKind},
};

/// `NAME=VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// The name, without blanks.
    pub name: String,
    /// The value (SI).
    pub value: f64,
}

/// Reads `NAME=VALUE`.
pub fn assignment(text: &str) -> Result<Assignment, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("write NAME=VALUE, such as `L1=0.5` or `q1=80*deg`")?;
    let name: String = name.split_whitespace().collect();
    if name.is_empty() {
        return Err("there is no name before `=`".to_string());
    }
    Ok(Assignment {
        name,
        value: number(value)?,
    })
}

/// Reads a formula of numbers, `pi` and `deg`.
///
/// Numbers are exact until the whole is evaluated: `80*deg` is 4/9 times π.
pub fn number(text: &str) -> Result<f64, String> {
    let formula = parse::formula(text).map_err(|diagnostics| {
        let first = diagnostics.sorted().first().map(|d| d.message.clone());
        first.unwrap_or_else(|| "this is no formula".to_string())
    })?;
    let mut graph = Graph::new();
    let value = lower(&mut graph, &formula)?;
    graph
        .constant_value(value)
        .ok_or_else(|| format!("`{}` is not a finite number", text.trim()))
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
    use super::{assignment, number};

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
    fn an_assignment_may_have_blanks() {
        let read = assignment(" der(q1) = -2 ").map(|a| (a.name, a.value));
        assert_eq!(read, Ok(("der(q1)".to_string(), -2.0)));
        assert!(assignment("q1").is_err());
        assert!(assignment("=3").is_err());
    }
}
