//! Characters that mean nothing in a description, and what was meant.
//!
//! In:  a character.
//! Out: its name, and what to write instead.

use super::messages::{CHOICE, NAMES, REMOVE};

/// Dots over letters, alone or with the letter: derivatives in time.
const DOTS: [char; 8] = ['\u{307}', '\u{308}', 'ẋ', 'ẏ', 'ż', 'ṙ', 'ẍ', 'ÿ'];

const VELOCITY: &str = "the velocity of a coordinate `q` is written `der(q)`";

/// A character as a message names it.
pub fn shown(character: char) -> String {
    match character {
        '\r' => "a carriage return without a line feed".to_string(),
        '\u{a0}' => "a no-break space".to_string(),
        c if c.is_control() || c.is_whitespace() || ('\u{300}'..='\u{36f}').contains(&c) => {
            format!("the character U+{:04X}", u32::from(c))
        }
        c => format!("`{c}`"),
    }
}

/// What to write instead of a character that has no meaning.
pub fn instead(character: char) -> String {
    let write = |text: &str| format!("write `{text}`");
    match character {
        '\'' | '’' | '′' => VELOCITY.into(),
        c if DOTS.contains(&c) => VELOCITY.into(),
        '"' => "there is no quoted text; comments begin with `//`, doc comments with `///`".into(),
        '·' | '⋅' => "write `*`, between vectors `dot(a, b)`".into(),
        '×' => "write `*`, between vectors `cross(a, b)`".into(),
        '∗' => write("*"),
        '÷' | '∕' => write("/"),
        '−' | '–' | '—' => write("-"),
        '²' => write("^2"),
        '³' => write("^3"),
        '½' => write("1/2"),
        'π' => write("pi"),
        '°' => write("*deg"),
        'µ' | 'μ' => write("mu"),
        '≤' => write("<="),
        '≥' => write(">="),
        '≠' => write("!="),
        '√' => write("sqrt(…)"),
        '?' => CHOICE.into(),
        c if greek(c).is_some() => write(greek(c).unwrap_or_default()),
        c if c.is_alphabetic() => NAMES.into(),
        '\r' => "save the file with line feeds".into(),
        c if c.is_whitespace() => "write an ordinary blank".into(),
        _ => REMOVE.into(),
    }
}

fn greek(character: char) -> Option<&'static str> {
    const LETTERS: [(char, &str); 28] = [
        ('α', "alpha"),
        ('β', "beta"),
        ('γ', "gamma"),
        ('δ', "delta"),
        ('ε', "epsilon"),
        ('ζ', "zeta"),
        ('η', "eta"),
        ('θ', "theta"),
        ('κ', "kappa"),
        ('λ', "lambda"),
        ('ξ', "xi"),
        ('ρ', "rho"),
        ('σ', "sigma"),
        ('τ', "tau"),
        ('φ', "phi"),
        ('ϕ', "phi"),
        ('ψ', "psi"),
        ('ω', "omega"),
        ('ν', "nu"),
        ('χ', "chi"),
        ('ϑ', "theta"),
        ('ϵ', "epsilon"),
        ('Δ', "Delta"),
        ('Θ', "Theta"),
        ('Φ', "Phi"),
        ('Ψ', "Psi"),
        ('Ω', "Omega"),
        ('Γ', "Gamma"),
    ];
    LETTERS
        .iter()
        .find(|(letter, _)| *letter == character)
        .map(|(_, name)| *name)
}
