//! What a program needs not be compiled anew for: the values of parameters.
//!
//! In:  the text of a description.
//! Out: the text that its program is known by; the values, told to a program.

use crate::formula::number;
use bricard_codegen::internals::diagnostic::Span;
use bricard_codegen::internals::syntax::parse;
use bricard_driver::{AnyMechanism, Link};

/// A description without the values of its parameters. What its program is compiled from is
/// the description itself; a description that differs in these values has the same program.
pub fn without_values(source: &str) -> String {
    let mut text = source.to_string();
    let mut all = values(source);
    all.sort_by_key(|(_, span, _)| std::cmp::Reverse(span.range().start));
    for (_, span, _) in all {
        text.replace_range(span.range(), "…");
    }
    text
}

/// Tells a program the values of the parameters of a description.
pub fn tell(link: &mut Link, source: &str) {
    let parameters = link.structure().parameters;
    for (name, _, value) in values(source) {
        let place = parameters.iter().position(|known| known.name == name);
        if let Some(place) = place {
            link.set_parameter(place, value);
        }
    }
}

/// The parameters whose values are numbers but zero, not vectors and not what a constant
/// says: their names, and where the values stand.
fn values(source: &str) -> Vec<(String, Span, f64)> {
    // What is wrong with a description is told when it is compiled.
    let Ok(model) = parse(source) else {
        return Vec::new();
    };
    let value = |(name, span): (&str, Span)| {
        let value = number(source.get(span.range())?).ok()?;
        // What is zero may be there for a limit that has a program of its own.
        (value != 0.0).then(|| (name.to_string(), span, value))
    };
    model.values().filter_map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::without_values;

    #[test]
    fn a_program_is_known_by_all_but_the_numbers_of_parameters() {
        let text = "mechanism A { const c = 2; param k: N/m = 3; param v = [1, 2]; param d = c; \
                    param n[2] = 1; param z = 0; input u = 4; coord q; kinetic der(q)^2; }";
        let known = without_values(text);
        assert_eq!(known, text.replace("= 3;", "= …;"));
        assert_eq!(known, without_values(&text.replace("= 3;", "= 2*pi;")));
        assert_eq!(without_values("mechanism {"), "mechanism {");
    }
}
