//! Characters that mean nothing in a description, and what was meant.
//!
//! In:  a character.
//! Out: its name, and what to write instead.

use super::messages::{CHOICE, NAMES, REMOVE};

/// Dots over letters, alone or with the letter: derivatives in time.
const DOTS: [char; 8] = ['\u{307}', '\u{308}', 'ẋ', 'ẏ', 'ż', 'ṙ', 'ẍ', 'ÿ'];

const QUOTED: &str = "quoted text names the file and the columns of a table, `table(\"file.csv\", t)`; \
                      comments begin with `//`, doc comments with `///`";

const VELOCITY: &str = "the velocity of a coordinate `q` is written `der(q)`";

/// A character as a message names it.
pub fn shown(character: char) -> String {
    match character {
        '\r' => "a carriage return without a line feed".to_string(),
        '\u{a0}' => "a no-break space".to_string(),
        c if c.is_control() || c.is_whitespace() || is_unseen(c) => {
            format!("the character U+{:04X}", u32::from(c))
        }
        c => format!("`{c}`"),
    }
}

/// Whether a character has no width, or stands on the one before it.
fn is_unseen(character: char) -> bool {
    matches!(
        character,
        '\u{ad}' | '\u{300}'..='\u{36f}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}'
            | '\u{2060}'..='\u{2064}' | '\u{feff}'
    )
}

/// The ASCII character that one of full width stands for, or a digit that is raised or lowered.
fn plain(character: char) -> Option<char> {
    let digit = |zero: char| u32::from(character).checked_sub(u32::from(zero));
    let digit = |zero| digit(zero).and_then(|value| char::from_digit(value, 10));
    match character {
        '\u{ff01}'..='\u{ff5e}' => char::from_u32(u32::from(character) - 0xfee0),
        '¹' => Some('1'),
        '⁰' | '⁴'..='⁹' => digit('⁰'),
        '₀'..='₉' => digit('₀'),
        _ => None,
    }
}

/// What to write instead of a character that has no meaning.
pub fn instead(character: char) -> String {
    let write = |text: &str| format!("write `{text}`");
    match character {
        '\'' | '‘' | '’' | '′' => VELOCITY.into(),
        c if DOTS.contains(&c) => VELOCITY.into(),
        '"' => QUOTED.into(),
        '“' | '”' | '„' | '«' | '»' => format!("write `\"`; {QUOTED}"),
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
        '¹' | '⁰' | '⁴'..='⁹' => {
            write(&format!("^{}", plain(character).unwrap_or_default()))
        }
        c if plain(c).is_some() => write(&plain(c).unwrap_or_default().to_string()),
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
