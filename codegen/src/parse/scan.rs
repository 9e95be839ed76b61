//! The characters of a description: brackets that match, nothing that the lexer
//! would refuse, nothing nested too deeply for a recursive reader.
//!
//! In:  the text.
//! Out: nothing, or everything that is wrong with its characters.

use super::NESTING;
use crate::diagnostic::{Diagnostic, Diagnostics, Position, Span};
use std::iter::Peekable;
use std::str::CharIndices;

/// The largest description in bytes. Places are 32-bit numbers.
const LARGEST: usize = 1 << 24;

struct Scanner<'a> {
    text: &'a str,
    characters: Peekable<CharIndices<'a>>,
    line: u32,
    column: u32,
    open: Vec<(char, Span)>,
    too_deep: bool,
    diagnostics: Diagnostics,
}

/// Checks the characters of a text.
pub fn scan(text: &str) -> Result<(), Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    if text.len() > LARGEST {
        let message = format!("a description of {} bytes is too large", text.len());
        let help = format!("the limit is {LARGEST} bytes; use arrays and `for`");
        diagnostics.push(Diagnostic::error(Span::default(), message).help(help));
        return Err(diagnostics);
    }
    let characters = text.char_indices().peekable();
    let mut scanner = Scanner {
        text,
        characters,
        line: 1,
        column: 1,
        open: Vec::new(),
        too_deep: false,
        diagnostics,
    };
    scanner.run();
    if scanner.diagnostics.is_empty() {
        Ok(())
    } else {
        Err(scanner.diagnostics)
    }
}

impl Scanner<'_> {
    fn run(&mut self) {
        while let Some((_, character)) = self.characters.peek().copied() {
            let start = self.position();
            match character {
                '/' => self.slash(start),
                '(' | '[' | '{' => self.opening(character, start),
                ')' | ']' | '}' => self.closing(character, start),
                _ => self.other(character, start),
            }
        }
        for (bracket, span) in std::mem::take(&mut self.open).into_iter().take(3) {
            let message = format!("this `{bracket}` is never closed");
            let help = format!("write the matching `{}`", partner(bracket));
            self.diagnostics
                .push(Diagnostic::error(span, message).help(help));
        }
    }

    fn position(&mut self) -> Position {
        let offset = self
            .characters
            .peek()
            .map_or(self.text.len(), |(offset, _)| *offset);
        let offset = u32::try_from(offset).unwrap_or(u32::MAX);
        Position {
            line: self.line,
            column: self.column,
            offset,
        }
    }

    fn next(&mut self) -> Option<char> {
        let (_, character) = self.characters.next()?;
        if character == '\n' {
            self.line += 1;
            self.column = 1;
        } else {
            self.column += 1;
        }
        Some(character)
    }

    fn peek(&mut self) -> Option<char> {
        self.characters.peek().map(|(_, character)| *character)
    }

    fn span_from(&mut self, start: Position) -> Span {
        Span {
            start,
            end: self.position(),
        }
    }

    /// A comment or a division.
    fn slash(&mut self, start: Position) {
        self.next();
        match self.peek() {
            Some('/') => {
                while self.peek().is_some_and(|c| c != '\n') {
                    let at = self.position();
                    let character = self.next();
                    if character == Some('\r') && self.peek() != Some('\n') {
                        self.stray('\r', at);
                    }
                }
            }
            Some('*') => self.block_comment(start),
            _ => {}
        }
    }

    fn block_comment(&mut self, start: Position) {
        self.next();
        let begin = self.span_from(start);
        let mut depth = 1_usize;
        let mut last = ' ';
        while depth > 0 {
            let Some(character) = self.next() else {
                let error = Diagnostic::error(begin, "this comment is never closed");
                self.diagnostics.push(error.help("write the matching `*/`"));
                return;
            };
            match (last, character) {
                ('/', '*') => depth += 1,
                ('*', '/') => depth -= 1,
                _ => {
                    last = character;
                    continue;
                }
            }
            last = ' ';
        }
    }

    fn opening(&mut self, bracket: char, start: Position) {
        self.next();
        let span = self.span_from(start);
        self.open.push((bracket, span));
        if self.open.len() > NESTING && !self.too_deep {
            self.too_deep = true;
            let message = format!("more than {NESTING} brackets inside one another");
            let help = "give inner parts names of their own with `let`";
            self.diagnostics
                .push(Diagnostic::error(span, message).help(help));
        }
    }

    fn closing(&mut self, bracket: char, start: Position) {
        self.next();
        let span = self.span_from(start);
        let matching = self
            .open
            .iter()
            .rposition(|(open, _)| partner(*open) == bracket);
        let Some(&(open, place)) = self.open.last() else {
            let message = format!("this `{bracket}` closes nothing");
            self.diagnostics
                .push(Diagnostic::error(span, message).help("remove it"));
            return;
        };
        // What is open inside the bracket that this one closes was forgotten.
        self.open.truncate(matching.unwrap_or(self.open.len() - 1));
        if partner(open) != bracket {
            let message = format!("`{open}` is closed by `{bracket}`");
            let error = Diagnostic::error(span, message).also(place, "opened here");
            let help = format!("write the matching `{}` first", partner(open));
            self.diagnostics.push(error.help(help));
        }
    }

    fn other(&mut self, character: char, start: Position) {
        self.next();
        let blank = match character {
            '\r' => self.peek() == Some('\n'),
            _ => character.is_ascii_whitespace(),
        };
        let known = character.is_ascii_alphanumeric() || "_+-*^=<>!&|%.,:;~".contains(character);
        if !blank && !known {
            self.stray(character, start);
        }
    }

    fn stray(&mut self, character: char, start: Position) {
        let span = self.span_from(start);
        let shown = match character {
            '\r' => "a carriage return without a line feed".to_string(),
            '\u{a0}' => "a no-break space".to_string(),
            c if c.is_control() || c.is_whitespace() => {
                format!("the character U+{:04X}", u32::from(c))
            }
            c => format!("`{c}`"),
        };
        let message = format!("{shown} has no meaning here");
        self.diagnostics
            .push(Diagnostic::error(span, message).help(instead(character)));
    }
}

fn partner(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// What to write instead of a character that has no meaning.
fn instead(character: char) -> String {
    let write = |text: &str| format!("write `{text}`");
    match character {
        '\'' => "the velocity of a coordinate `q` is written `der(q)`".into(),
        '"' => "there is no quoted text; comments begin with `//`, doc comments with `///`".into(),
        '#' => "comments begin with `//`".into(),
        '·' | '×' | '∗' | '⋅' => write("*"),
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
        '?' => "a choice is written `if a < b then x else y`".into(),
        c if greek(c).is_some() => write(greek(c).unwrap_or_default()),
        c if c.is_alphabetic() => {
            "names are made of the letters a–z and A–Z, digits and `_`".into()
        }
        '\r' => "save the file with line feeds".into(),
        c if c.is_whitespace() => "write an ordinary blank".into(),
        _ => "remove it".into(),
    }
}

fn greek(character: char) -> Option<&'static str> {
    const NAMES: [(char, &str); 18] = [
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
    ];
    NAMES
        .iter()
        .find(|(letter, _)| *letter == character)
        .map(|(_, name)| *name)
}
