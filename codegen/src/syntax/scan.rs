//! The characters of a description: brackets that match, nothing that the lexer
//! would refuse, nothing nested too deeply for a recursive reader.
//!
//! In:  the text.
//! Out: [`Scanned`]: everything that is wrong with its characters, and the text with
//!      blanks in their place, so that one of them does not hide all other mistakes.

use super::blocks::Blocks;
use super::messages::{NAME_INSIDE, NO_QUOTES, NUMBERS, REMOVE};
use super::stray::{instead, shown};
use crate::diagnostic::{Diagnostic, Diagnostics, Position, Span};
use std::iter::Peekable;
use std::ops::Range;
use std::str::CharIndices;

/// Levels of brackets, of `if`, of powers and of signs inside one another. People
/// need about ten; the recursive reader has room for these.
pub const NESTING: usize = 100;

/// The largest description in bytes. Places are 32-bit numbers.
const LARGEST: usize = 1 << 24;

/// What a text looks like to the lexer.
pub struct Scanned {
    /// The text, with blanks for what has no meaning; as many bytes and, but for the
    /// rarest characters, as many columns.
    pub text: String,
    /// The bytes at which something else was, comments aside. A statement around one
    /// of them is not as it was meant.
    pub strays: Vec<usize>,
    /// Everything that is wrong with the characters.
    pub diagnostics: Diagnostics,
    /// Whether the text can be lexed.
    pub readable: bool,
}

/// What to write instead of a tick behind a bracket.
const TRANSPOSED: &str = "the square of a vector's length is `norm2(v)`, a product of two vectors \
                          `dot(a, b)`, a transposed matrix `transpose(R)`";

struct Scanner<'a> {
    text: &'a str,
    characters: Peekable<CharIndices<'a>>,
    line: u32,
    column: u32,
    /// The number of blanks that the line begins with, while there is nothing else.
    indent: usize,
    /// The last character of the line that is no blank.
    before: Option<char>,
    open: Vec<Bracket>,
    /// An opening brace that the brace found for it does not seem to be meant for.
    askew: Option<Span>,
    blocks: Blocks,
    blanks: Vec<Range<usize>>,
    strays: Vec<usize>,
    readable: bool,
    diagnostics: Diagnostics,
}

/// An opening bracket.
struct Bracket {
    sign: char,
    span: Span,
    /// The indentation of its line.
    indent: usize,
}

/// Looks at the characters of a text.
pub fn scan(text: &str) -> Scanned {
    let mut scanner = Scanner {
        text,
        characters: text.char_indices().peekable(),
        line: 1,
        column: 1,
        indent: 0,
        before: None,
        open: Vec::new(),
        askew: None,
        blocks: Blocks::default(),
        blanks: Vec::new(),
        strays: Vec::new(),
        readable: text.len() <= LARGEST,
        diagnostics: Diagnostics::new(),
    };
    if scanner.readable {
        scanner.run();
    } else {
        let message = format!("a description of {} bytes is too large", text.len());
        let help = format!("the limit is {LARGEST} bytes; use arrays and `for`");
        let error = Diagnostic::error(Span::START, message).help(help);
        scanner.diagnostics.push(error);
    }
    Scanned {
        text: blanked(text, &scanner.blanks),
        strays: scanner.strays,
        diagnostics: scanner.diagnostics,
        readable: scanner.readable,
    }
}

/// Looks at the characters of a text that has to be right.
///
/// # Errors
///
/// Everything that is wrong with them.
pub fn clean(text: &str) -> Result<(), Diagnostics> {
    match scan(text).diagnostics {
        wrong if wrong.is_empty() => Ok(()),
        wrong => Err(wrong),
    }
}

/// A text with blanks in places, each as long as what it replaces.
fn blanked(text: &str, places: &[Range<usize>]) -> String {
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    for place in places.iter().filter(|place| !place.is_empty()) {
        result.push_str(text.get(at..place.start).unwrap_or(""));
        for character in text.get(place.clone()).unwrap_or("").chars() {
            result.push_str(match character.len_utf8() {
                1 => " ",
                2 => "\u{a0}",
                3 => "\u{2003}",
                _ => "\u{a0}\u{a0}",
            });
        }
        at = place.end;
    }
    result.push_str(text.get(at..).unwrap_or(""));
    result
}

impl Scanner<'_> {
    fn run(&mut self) {
        while let Some((_, character)) = self.characters.peek().copied() {
            let start = self.position();
            let comment = character == '#'
                || (character == '%' && self.before.is_none_or(|c| ";{}".contains(c)));
            match character {
                '/' => self.slash(start),
                '(' | '[' | '{' => self.opening(character, start),
                ')' | ']' | '}' => self.closing(character, start),
                '"' => self.quoted(start),
                _ if comment => self.foreign_comment(character, start),
                _ => self.other(character, start),
            }
        }
        let mut open = std::mem::take(&mut self.open);
        // Where both braces of a block are missing, the last one is that of the mechanism.
        if let (Some(taken), ['{']) = (self.blocks.taken, &*signs(&open)) {
            self.blanks.retain(|blank| *blank != taken.range());
            open.clear();
        }
        // The last brace is missing rather in front of one that stands elsewhere.
        if let (Some(askew), [one]) = (self.askew, open.as_mut_slice()) {
            one.span = askew;
        }
        self.readable &= open.is_empty();
        for bracket in open.into_iter().take(3) {
            let message = format!("this `{}` is never closed", bracket.sign);
            let help = format!("write the matching `{}`", partner(bracket.sign));
            self.diagnostics
                .push(Diagnostic::error(bracket.span, message).help(help));
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
            (self.line, self.column) = (self.line + 1, 1);
            (self.indent, self.before) = (0, None);
            return Some(character);
        }
        self.column += 1;
        if !character.is_whitespace() {
            self.before = Some(character);
        } else if self.before.is_none() {
            self.indent += 1;
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
            library: false,
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
                self.readable = false;
                // It has swallowed what closes them.
                self.open.clear();
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

    fn opening(&mut self, sign: char, start: Position) {
        let indent = self.indent;
        self.next();
        let span = self.span_from(start);
        if sign == '{' {
            self.blocks.open();
        }
        self.open.push(Bracket { sign, span, indent });
        if self.open.len() == NESTING + 1 && self.readable {
            self.readable = false;
            let message = format!("more than {NESTING} brackets inside one another");
            self.diagnostics
                .push(Diagnostic::error(span, message).help(NAME_INSIDE));
        }
    }

    fn closing(&mut self, bracket: char, start: Position) {
        let first = self.before.is_none();
        self.next();
        let span = self.span_from(start);
        let innermost = self.open.last().map(|open| open.span.range().start);
        if bracket == '}' && self.blocks.takes(innermost, span) {
            return self.take_out(span);
        }
        let matching = self.matching(bracket, span);
        let Some(last) = self.open.last().filter(|last| {
            // A block that a parenthesis can't close is one that it doesn't belong to.
            matching.is_some() || last.sign != '{'
        }) else {
            return self.closes_nothing(bracket, span);
        };
        if partner(last.sign) == bracket {
            if first && last.indent != self.indent && bracket == '}' {
                self.askew.get_or_insert(last.span);
            }
            self.open.pop();
            if self.open.is_empty() && bracket == '}' {
                self.blocks.close(span);
            }
            return;
        }
        let open = last.sign;
        let message = format!("`{open}` is closed by `{bracket}`");
        let error = Diagnostic::error(span, message).also(last.span, "opened here");
        let help = format!("write the matching `{}` first", partner(open));
        self.diagnostics.push(error.help(help));
        self.forget(matching, span);
    }

    /// The open bracket that a closing one belongs to. Statements stand in no parentheses: in
    /// front of them is one that was never closed.
    fn matching(&self, bracket: char, closing: Span) -> Option<usize> {
        let mut inside_out = self.open.iter().enumerate().rev();
        let (place, found) = inside_out.find(|(_, open)| partner(open.sign) == bracket)?;
        let inside = found.span.range().start..closing.range().start;
        let block = || self.open[place..].iter().any(|open| open.sign == '{');
        let statements = || self.text.get(inside).unwrap_or("").contains(';');
        let stands_inside = bracket != '}' && block() && statements();
        (!stands_inside && !self.is_mistyped(closing)).then_some(place)
    }

    /// Whether a closing bracket was typed instead of the one that is due: those behind it close
    /// all that is open around it in the formula.
    fn is_mistyped(&self, closing: Span) -> bool {
        let around = self.open.iter().rev().skip(1);
        let around = around.take_while(|open| open.sign != '{');
        let rest = self.text.get(closing.range().end..).unwrap_or("");
        let mut rest = rest.chars().filter(|c| !c.is_whitespace());
        let last = self.open.last().map(|open| partner(open.sign));
        let other = last
            != self
                .text
                .get(closing.range())
                .and_then(|text| text.chars().next());
        let mut around = around.peekable();
        other
            && around.peek().is_some()
            && around.all(|open| rest.next() == Some(partner(open.sign)))
    }

    fn closes_nothing(&mut self, bracket: char, span: Span) {
        let early = (bracket == '}').then(|| self.blocks.too_early(self.text, span));
        if let Some(early) = early.flatten() {
            let message = "this `}` closes the mechanism, and statements follow";
            let error = Diagnostic::error(early, message);
            self.diagnostics.push(error.help(REMOVE));
            return self.blank(early);
        }
        let message = format!("this `{bracket}` closes nothing");
        let help = match bracket {
            ')' => "remove it, or write the `(` that it closes",
            ']' => "remove it, or write the `[` that it closes",
            _ => REMOVE,
        };
        self.diagnostics
            .push(Diagnostic::error(span, message).help(help));
        self.blank(span);
    }

    /// What is open inside the bracket that a closing one belongs to was forgotten; if
    /// it belongs to none, it stands for the one that is open.
    fn forget(&mut self, matching: Option<usize>, closing: Span) {
        let from = matching.map_or(self.open.len() - 1, |place| place + 1);
        let gone: Vec<Bracket> = self.open.drain(from..).collect();
        gone.iter().for_each(|bracket| self.blank(bracket.span));
        match matching {
            Some(_) => drop(self.open.pop()),
            None => self.blank(closing),
        }
    }

    /// Takes out what has no meaning.
    fn blank(&mut self, span: Span) {
        self.strays.push(span.range().start);
        self.take_out(span);
    }

    fn take_out(&mut self, span: Span) {
        let place = span.range();
        let at = self.blanks.partition_point(|b| b.start <= place.start);
        self.blanks.insert(at, place);
    }

    /// A comment of another language.
    fn foreign_comment(&mut self, sign: char, start: Position) {
        self.next();
        let span = self.span_from(start);
        let error = Diagnostic::error(span, format!("{} has no meaning here", shown(sign)));
        self.diagnostics
            .push(error.help("comments begin with `//`"));
        while self.peek().is_some_and(|c| c != '\n') {
            self.next();
        }
        let line = self.span_from(start);
        self.take_out(line);
    }

    /// Quoted text, which ends at the latest with its line.
    fn quoted(&mut self, start: Position) {
        self.next();
        let opening = self.span_from(start);
        let rest = self.text.get(opening.range().end..).unwrap_or("");
        let line = rest.lines().next().unwrap_or("");
        if !line.contains('"') {
            let error = Diagnostic::error(opening, "this `\"` is never closed");
            let help = match self.names_a_file(start) {
                true => "write the matching `\"` in the same line".to_string(),
                false => instead('"'),
            };
            self.diagnostics.push(error.help(help));
            return self.blank(opening);
        }
        while self.next().is_some_and(|c| c != '"') {}
        let span = self.span_from(start);
        let plain = !span.text(self.text).contains('\\');
        if plain && self.names_a_file(start) {
            return;
        }
        let error = Diagnostic::error(span, NO_QUOTES);
        self.diagnostics.push(error.help(instead('"')));
        self.blank(span);
    }

    /// Whether quoted text at a place is that of a table: `table("file.csv", "column", t)`.
    fn names_a_file(&self, at: Position) -> bool {
        let before = self.text[..at.offset as usize].trim_end();
        let texts = |c: char| c.is_ascii_whitespace() || c == ',';
        let mut before = before;
        while let Some(rest) = before.strip_suffix(',').map(str::trim_end) {
            let Some(inside) = rest.strip_suffix('"') else {
                return false;
            };
            before = match inside.rfind('"') {
                Some(open) => inside[..open].trim_end(),
                None => return false,
            };
        }
        let call = before.trim_end_matches(texts).strip_suffix('(');
        call.is_some_and(|call| {
            let call = call.trim_end();
            call.ends_with("table") || call.ends_with("spline")
        })
    }

    fn other(&mut self, character: char, start: Position) {
        if !character.is_whitespace() {
            let begins = self.before.is_none_or(|c| ";{}".contains(c));
            self.blocks.hear(self.text, start.offset as usize, begins);
        }
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
        let message = format!("{} has no meaning here", shown(character));
        let text = self.text.get(..span.range().start).unwrap_or("");
        let help = match (character, text.ends_with([')', ']'])) {
            ('\'' | '’', true) => TRANSPOSED.to_string(),
            ('\'' | '’', false) if ends_with_number(text) => NUMBERS.to_string(),
            ('π', false) if ends_with_number(text) => "write `*pi`".to_string(),
            _ => instead(character),
        };
        self.diagnostics
            .push(Diagnostic::error(span, message).help(help));
        self.blank(span);
    }
}

fn signs(brackets: &[Bracket]) -> Vec<char> {
    brackets.iter().map(|bracket| bracket.sign).collect()
}

/// Whether a number ends a text.
fn ends_with_number(text: &str) -> bool {
    let before = text.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || "._".contains(c));
    text[before.len()..].starts_with(|c: char| c.is_ascii_digit())
}

fn partner(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}
