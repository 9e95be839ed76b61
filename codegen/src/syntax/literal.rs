//! Numbers as they are written.

use super::messages::LARGE_AND_SMALL;
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::Number;

/// The smallest number besides zero.
const SMALLEST: f64 = 1e-308;

/// Reads a decimal literal exactly.
pub fn read_number(text: &str, span: Span) -> Result<Number, Box<Diagnostic>> {
    let refuse =
        |message: String, help: String| Box::new(Diagnostic::error(span, message).help(help));
    if text.len() > 2
        && ["0x", "0b", "0o"]
            .iter()
            .any(|prefix| text.starts_with(prefix))
    {
        return Err(refuse(
            format!("`{text}` is not a decimal number"),
            "write it in decimals".into(),
        ));
    }
    let end = text.find(|c: char| c.is_ascii_alphabetic() && c != 'e' && c != 'E');
    let bare_exponent = text.ends_with(['e', 'E']).then(|| text.len() - 1);
    if let Some(end) = end.or(bare_exponent) {
        let (number, name) = text.split_at(end);
        let message = format!("`{text}` is neither a number nor a name");
        return Err(refuse(
            message,
            format!("write `{number}*{name}`, or give the unit behind `:`"),
        ));
    }
    if text.matches(['e', 'E']).count() > 1 {
        let message = format!("`{}` has two exponents", shorten(text));
        return Err(refuse(message, "write one: `1e-3`".into()));
    }
    let number = Number::parse_literal(text);
    let digits = text.split(['e', 'E']).next().unwrap_or("");
    // Smaller ones have lost digits, or all of them.
    let is_zero = !digits.contains(|c: char| ('1'..='9').contains(&c));
    let fits = |n: &Number| is_zero || n.to_f64().abs() >= SMALLEST;
    match number.filter(|n| n.is_finite() && fits(n)) {
        Some(number) => Ok(number),
        None => Err(refuse(
            format!("`{}` is too large or too small", shorten(text)),
            LARGE_AND_SMALL.into(),
        )),
    }
}

fn shorten(text: &str) -> String {
    if text.len() <= 24 {
        text.to_string()
    } else {
        format!("{}…", &text[..20])
    }
}
