//! A reader of tokens that says what it expected, and goes on after a mistake.

use super::ast::Name;
use super::keyword::{RESERVED, Statement};
use super::messages::{NAME_INSIDE, RENAME};
use super::scan::NESTING;
use super::token::{Token, TokenKind, Tokens};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};

/// The mistake has been reported; go on behind the statement.
#[derive(Debug)]
pub struct Reported;

/// What a reader gives.
pub type Parsed<T> = Result<T, Reported>;

/// A place in the list of tokens.
#[derive(Debug)]
pub struct Cursor<'a> {
    pub source: &'a str,
    pub diagnostics: Diagnostics,
    /// The bytes at which something without meaning was taken out.
    pub strays: Vec<usize>,
    /// Names that statements with mistakes may have declared.
    pub unreadable: Vec<String>,
    tokens: Tokens,
    at: usize,
    nesting: usize,
}

impl<'a> Cursor<'a> {
    /// At the first token.
    pub fn new(source: &'a str, tokens: Tokens) -> Self {
        Self {
            source,
            diagnostics: Diagnostics::new(),
            strays: Vec::new(),
            unreadable: Vec::new(),
            tokens,
            at: 0,
            nesting: 0,
        }
    }

    /// The next token. Behind the last one is the last one again.
    pub fn peek(&self) -> &Token {
        self.peek_at(0)
    }

    /// The token some places ahead.
    pub fn peek_at(&self, ahead: usize) -> &Token {
        let last = self.tokens.list.len() - 1;
        &self.tokens.list[(self.at + ahead).min(last)]
    }

    /// The place of the next token.
    pub fn span(&self) -> Span {
        self.peek().span
    }

    /// The place of the token that was read last.
    pub fn last_span(&self) -> Span {
        self.tokens.list[self.at.saturating_sub(1)].span
    }

    /// A token that was read some places ago.
    pub fn behind(&self, back: usize) -> &Token {
        &self.tokens.list[self.at.saturating_sub(back)]
    }

    /// Whether a parenthesis comes next that holds a condition: behind it the condition ends
    /// or is joined with another, where a formula would go on to be compared.
    pub fn parentheses_hold_a_condition(&self) -> bool {
        if !self.at_symbol("(") {
            return false;
        }
        let mut inside = self.tokens.list[self.at + 1..].iter();
        let depth = self.depth();
        inside.by_ref().find(|token| token.depth <= depth);
        match inside.next().map(|token| &token.kind) {
            Some(TokenKind::Word(word)) => ["then", "and", "or"].contains(&word.as_str()),
            Some(TokenKind::Symbol(sign)) => *sign == ")",
            _ => false,
        }
    }

    /// Reads a token.
    pub fn advance(&mut self) -> Token {
        let token = self.peek().clone();
        self.at = (self.at + 1).min(self.tokens.list.len() - 1);
        token
    }

    /// Whether a word comes next.
    pub fn at_word(&self, word: &str) -> bool {
        matches!(&self.peek().kind, TokenKind::Word(text) if text == word)
    }

    /// Whether a sign comes next.
    pub fn at_symbol(&self, symbol: &str) -> bool {
        matches!(&self.peek().kind, TokenKind::Symbol(text) if *text == symbol)
    }

    /// Reads a word if it comes next.
    pub fn take_word(&mut self, word: &str) -> bool {
        let there = self.at_word(word);
        if there {
            self.advance();
        }
        there
    }

    /// Reads a sign if it comes next.
    pub fn take_symbol(&mut self, symbol: &str) -> bool {
        let there = self.at_symbol(symbol);
        if there {
            self.advance();
        }
        there
    }

    /// Reads a sign that has to come next.
    pub fn expect_symbol(&mut self, symbol: &str, help: &str) -> Parsed<()> {
        if self.take_symbol(symbol) {
            return Ok(());
        }
        Err(self.unexpected(&format!("`{symbol}`"), help))
    }

    /// Reads the name of something new.
    pub fn expect_name(&mut self, what: &str, help: &str) -> Parsed<Name> {
        let token = self.peek().clone();
        let text = match token.kind {
            TokenKind::Word(text) => text,
            TokenKind::Number(text) if text.contains(char::is_alphabetic) => {
                return Err(self.unexpected(what, "a name begins with a letter"));
            }
            _ => return Err(self.unexpected(what, help)),
        };
        if RESERVED.contains(&text.as_str()) {
            let message = format!("`{text}` can't be a name: it is a word of the language");
            let message = match text.as_str() {
                "self" | "Self" | "super" | "crate" | "_" => format!("`{text}` can't be a name"),
                _ => message,
            };
            return Err(self.fail(Diagnostic::error(token.span, message).help(RENAME)));
        }
        self.advance();
        Ok(Name {
            text,
            span: token.span,
        })
    }

    /// Records a mistake.
    pub fn fail(&mut self, diagnostic: Diagnostic) -> Reported {
        self.diagnostics.push(diagnostic);
        Reported
    }

    /// Records that something else was expected. Where it is missing at the end
    /// of a line, that end is the place.
    pub fn unexpected(&mut self, expected: &str, help: &str) -> Reported {
        let next = self.peek();
        let new_line = self.at > 0 && next.span.start.line > self.last_span().end.line;
        if !new_line && next.kind != TokenKind::End {
            return self.unexpected_here(expected, help);
        }
        let span = match self.at {
            0 => Span::START,
            _ => self.last_span().after(),
        };
        self.expected(span, format!("expected {expected}"), help)
    }

    /// Records that something else was expected than what comes next, also where that
    /// stands on a line of its own.
    pub fn unexpected_here(&mut self, expected: &str, help: &str) -> Reported {
        let span = self.span();
        let found = span.text(self.source);
        self.expected(span, format!("expected {expected}, found `{found}`"), help)
    }

    fn expected(&mut self, span: Span, message: String, help: &str) -> Reported {
        let mut diagnostic = Diagnostic::error(span, message);
        if !help.is_empty() {
            diagnostic = diagnostic.help(help);
        }
        self.fail(diagnostic)
    }

    /// Reads something one level deeper.
    pub fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.nesting >= NESTING {
            let message = format!("more than {NESTING} levels inside one another");
            let error = Diagnostic::error(self.span(), message);
            return Err(self.fail(error.help(NAME_INSIDE)));
        }
        self.nesting += 1;
        let result = read(self);
        self.nesting -= 1;
        result
    }

    /// The doc comment in front of the next token.
    pub fn docs(&self) -> String {
        let docs = &self.tokens.docs;
        let first = docs.partition_point(|(index, _)| *index < self.at);
        let lines = docs[first..]
            .iter()
            .take_while(|(index, _)| *index == self.at);
        let lines: Vec<_> = lines.map(|(_, line)| line.as_str()).collect();
        lines.join("\n").trim().to_string()
    }

    /// The number of brackets open around the next token.
    pub fn depth(&self) -> usize {
        self.peek().depth
    }

    /// Reads a statement or an entry of a block. If there is a mistake in it, it is
    /// passed over, and what it may have declared is remembered. Where a character was
    /// taken out, that is the mistake, and everything else comes of it. `is_block` says
    /// what has statements of its own, which have been looked at one by one.
    pub fn statement<T>(
        &mut self,
        depth: usize,
        read: fn(&mut Self) -> Parsed<T>,
        is_block: fn(&T) -> bool,
    ) -> Option<T> {
        let (first, said) = (self.at, self.diagnostics.len());
        let start = self.span().range().start;
        let read = read(self);
        if read.is_err() {
            self.recover(depth);
        }
        if read.as_ref().is_ok_and(is_block) {
            return read.ok();
        }
        let whole = start..self.last_span().range().end;
        if self.strays.iter().any(|stray| whole.contains(stray)) {
            self.diagnostics.truncate(said);
        } else if let Ok(statement) = read {
            return Some(statement);
        }
        self.forget(first);
        None
    }

    /// Remembers the names that an unreadable statement may have declared: its first two
    /// words, and those behind commas.
    fn forget(&mut self, first: usize) {
        let tokens = self.tokens.list.get(first..self.at).unwrap_or(&[]);
        let word = |token: &Token| match &token.kind {
            TokenKind::Word(word) => Some(word.clone()),
            _ => None,
        };
        let listed = tokens.windows(2).filter(|pair| {
            pair[0].depth == tokens[0].depth && pair[0].kind == TokenKind::Symbol(",")
        });
        let names = tokens.iter().take(2).chain(listed.map(|pair| &pair[1]));
        let names: Vec<String> = names.filter_map(word).collect();
        self.unreadable.extend(names);
    }

    /// Goes on behind the statement that began at a token: behind its `;` or
    /// `}`, or in front of a word that begins another one on a new line, or at
    /// the end of the block.
    pub fn recover(&mut self, depth: usize) {
        loop {
            let token = self.peek();
            let same = token.depth == depth;
            let closing = |bracket: &'static str| token.kind == TokenKind::Symbol(bracket);
            if token.kind == TokenKind::End || (closing("}") && token.depth < depth) {
                return;
            }
            if same && (closing(";") || closing("}")) {
                let brace = closing("}");
                self.advance();
                // Behind a brace inside a formula the statement goes on.
                let here = self.span().start.line == self.last_span().end.line;
                let begins = self.at_statement() || self.at_symbol("}");
                if brace && here && !begins {
                    continue;
                }
                return;
            }
            let new_line = self.at > 0 && token.span.start.line > self.last_span().end.line;
            if new_line && same && self.at_statement() {
                return;
            }
            self.advance();
        }
    }

    /// Whether a word that begins a statement comes next.
    pub fn at_statement(&self) -> bool {
        match &self.peek().kind {
            TokenKind::Word(word) => word == "for" || Statement::of(word).is_some(),
            _ => false,
        }
    }
}
