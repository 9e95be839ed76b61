//! Names of symbols in LaTeX.

/// Names that are letters of their own in LaTeX.
const GREEK: [&str; 27] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa",
    "lambda", "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi",
    "omega", "Phi", "Psi", "Theta", "Omega",
];

/// A symbol of a description in LaTeX: `q1` is `q_{1}`, `der(theta[0])` is
/// `\dot{\theta}_{0}`.
pub fn latex(name: &str) -> String {
    let inside = name
        .strip_prefix("der(")
        .and_then(|rest| rest.strip_suffix(')'));
    let whole = inside.unwrap_or(name);
    // What a part is called goes behind the name in it; a component behind its vector.
    let (part, plain) = match whole.rsplit_once('.') {
        Some((part, own)) if !["x", "y", "z"].contains(&own) => (part, own),
        _ => ("", whole),
    };
    let end = plain
        .find(|c: char| c.is_ascii_digit() || ['_', '[', '.'].contains(&c))
        .filter(|&end| end > 0)
        .unwrap_or(plain.len());
    let (letters, rest) = plain.split_at(end);
    let letters = letter(letters);
    let letters = if inside.is_some() {
        format!("\\dot{{{letters}}}")
    } else {
        letters
    };
    let index = subscript(&format!("{rest}.{part}"));
    if index.is_empty() {
        letters
    } else {
        format!("{letters}_{{{index}}}")
    }
}

fn letter(word: &str) -> String {
    if GREEK.contains(&word) {
        format!("\\{word}")
    } else if word.chars().count() == 1 {
        word.to_string()
    } else {
        format!("\\mathrm{{{word}}}")
    }
}

/// What stands behind the letters, its parts with commas between them.
fn subscript(rest: &str) -> String {
    let parts = rest
        .split(['_', '[', ']', '.'])
        .filter(|part| !part.is_empty());
    let part = |part: &str| match part.chars().all(|c| c.is_ascii_digit()) {
        true => part.to_string(),
        false => letter(part),
    };
    parts.map(part).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::latex;

    #[test]
    fn names_become_letters_with_subscripts() {
        assert_eq!(latex("q1"), "q_{1}");
        assert_eq!(latex("der(theta[0])"), "\\dot{\\theta}_{0}");
        assert_eq!(latex("L01"), "L_{01}");
        assert_eq!(latex("mass"), "\\mathrm{mass}");
        assert_eq!(latex("x_tip"), "x_{\\mathrm{tip}}");
        assert_eq!(latex("t"), "t");
        assert_eq!(latex("der(leg[2].q1)"), "\\dot{q}_{1,\\mathrm{leg},2}");
        assert_eq!(latex("c.x"), "c_{x}");
    }
}
