//! Tokens: proc-macro2 lexes, this flattens its trees into one list.
//!
//! In:  a text that [`super::scan`] has passed.
//! Out: tokens with their places and nesting, doc comments set apart.

use super::messages::NUMBERS;
use super::ruler::Ruler;
use crate::diagnostic::{Diagnostic, Diagnostics, Position, Span};
use proc_macro2::{Delimiter, Group, Spacing, TokenStream, TokenTree, token_stream};
use std::iter::Peekable;
use std::str::FromStr;

/// A token, how many brackets are open around it, and where it stands.
#[derive(Clone, Debug)]
pub struct Token {
    pub kind: TokenKind,
    pub depth: usize,
    pub span: Span,
}

/// What a token is. A bracket counts as outside itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TokenKind {
    Word(String),
    Number(String),
    /// Quoted text, without the quotes.
    Text(String),
    Symbol(&'static str),
    /// The end of the file.
    End,
}

/// The tokens of a file, the last one being [`TokenKind::End`].
#[derive(Debug)]
pub struct Tokens {
    pub list: Vec<Token>,
    /// Doc comments with the index of the token that follows, in order.
    pub docs: Vec<(usize, String)>,
}

/// Signs of two characters, which have to stand together.
const PAIRS: [&str; 8] = ["..", "<=", ">=", "==", "!=", "&&", "||", "**"];
/// Signs of one character.
const SINGLES: [&str; 17] = [
    "+", "-", "*", "/", "^", "=", "<", ">", "!", "&", "|", "%", "~", ".", ",", ":", ";",
];

struct Flattener<'a> {
    source: &'a str,
    ruler: Ruler<'a>,
    tokens: Tokens,
    frames: Vec<(Peekable<token_stream::IntoIter>, Group)>,
}

/// Lexes a text.
pub fn tokenize(source: &str) -> Result<Tokens, Diagnostics> {
    let stream = TokenStream::from_str(source).map_err(|error| {
        let mut diagnostics = Diagnostics::new();
        let span = place(error.span(), &mut Ruler::new(source));
        diagnostics.push(Diagnostic::error(span, "this can't be read").help(NUMBERS));
        diagnostics
    })?;
    let tokens = Tokens {
        list: Vec::new(),
        docs: Vec::new(),
    };
    let mut flattener = Flattener {
        source,
        ruler: Ruler::new(source),
        tokens,
        frames: Vec::new(),
    };
    flattener.run(stream);
    flattener.end();
    Ok(flattener.tokens)
}

impl Flattener<'_> {
    fn run(&mut self, stream: TokenStream) {
        let mut current = stream.into_iter().peekable();
        loop {
            match current.next() {
                Some(TokenTree::Group(group)) => {
                    let span = self.place(group.span_open());
                    self.push(bracket(group.delimiter(), true), span);
                    let inside = group.stream().into_iter().peekable();
                    self.frames
                        .push((std::mem::replace(&mut current, inside), group));
                }
                Some(TokenTree::Punct(punct)) if punct.as_char() == '#' => {
                    let span = self.place(punct.span());
                    self.doc_comment(span, &mut current);
                }
                Some(tree) => self.leaf(tree, &mut current),
                None => match self.frames.pop() {
                    Some((outer, group)) => {
                        current = outer;
                        let span = self.place(group.span_close());
                        self.push(bracket(group.delimiter(), false), span);
                    }
                    None => return,
                },
            }
        }
    }

    fn place(&mut self, span: proc_macro2::Span) -> Span {
        place(span, &mut self.ruler)
    }

    fn push(&mut self, kind: TokenKind, span: Span) {
        if kind != TokenKind::Symbol("") {
            self.tokens.list.push(Token {
                kind,
                depth: self.frames.len(),
                span,
            });
        }
    }

    fn leaf(&mut self, tree: TokenTree, rest: &mut Peekable<token_stream::IntoIter>) {
        let span = self.place(tree.span());
        match tree {
            TokenTree::Ident(word) => self.push(TokenKind::Word(word.to_string()), span),
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                let quoted = text
                    .strip_prefix('"')
                    .and_then(|text| text.strip_suffix('"'));
                let kind = match quoted {
                    Some(quoted) => TokenKind::Text(quoted.to_string()),
                    None => TokenKind::Number(text),
                };
                self.push(kind, span);
            }
            TokenTree::Punct(punct) => {
                let first = punct.as_char();
                let second = match rest.peek() {
                    Some(TokenTree::Punct(next)) if punct.spacing() == Spacing::Joint => {
                        Some((next.as_char(), next.span()))
                    }
                    _ => None,
                };
                if let Some((pair, end)) = second.and_then(|(c, end)| Some((pair(first, c)?, end)))
                {
                    rest.next();
                    let end = self.place(end);
                    self.push(TokenKind::Symbol(pair), span.to(end));
                } else {
                    self.push(TokenKind::Symbol(single(first)), span);
                }
            }
            TokenTree::Group(_) => {}
        }
    }

    /// The lexer turns `/// text` into `#[doc = "text"]`, whose every token has
    /// the place of the comment; `//! text` has a `!` in it and is passed over.
    fn doc_comment(&mut self, span: Span, rest: &mut Peekable<token_stream::IntoIter>) {
        let inner = matches!(rest.peek(), Some(TokenTree::Punct(_)));
        if inner {
            rest.next();
        }
        rest.next();
        let text = span.text(self.source);
        if !inner {
            self.tokens
                .docs
                .push((self.tokens.list.len(), doc_text(text)));
        }
    }

    fn end(&mut self) {
        let before = self.source.bytes().filter(|&b| b == b'\n').count();
        let last = self.source.rsplit('\n').next().unwrap_or("");
        let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let end = Position {
            line: number(before + 1),
            column: number(last.chars().count() + 1),
            offset: number(self.source.len()),
        };
        self.push(
            TokenKind::End,
            Span {
                start: end,
                end,
                library: false,
            },
        );
    }
}

/// The words of a doc comment.
fn doc_text(comment: &str) -> String {
    let line = |text: &str| {
        text.strip_prefix(' ')
            .unwrap_or(text)
            .trim_end()
            .to_string()
    };
    if let Some(text) = comment.strip_prefix("///") {
        return line(text);
    }
    let text = comment.strip_prefix("/**").unwrap_or(comment);
    let text = text.strip_suffix("*/").unwrap_or(text);
    let starless = |text: &str| line(text.trim_start().trim_start_matches('*'));
    let lines: Vec<_> = text.lines().map(starless).collect();
    lines.join("\n").trim().to_string()
}

fn bracket(delimiter: Delimiter, open: bool) -> TokenKind {
    TokenKind::Symbol(match (delimiter, open) {
        (Delimiter::Parenthesis, true) => "(",
        (Delimiter::Parenthesis, false) => ")",
        (Delimiter::Bracket, true) => "[",
        (Delimiter::Bracket, false) => "]",
        (Delimiter::Brace, true) => "{",
        (Delimiter::Brace, false) => "}",
        (Delimiter::None, _) => "",
    })
}

fn pair(first: char, second: char) -> Option<&'static str> {
    PAIRS
        .into_iter()
        .find(|pair| pair.chars().eq([first, second]))
}

fn single(character: char) -> &'static str {
    SINGLES
        .into_iter()
        .find(|sign| sign.starts_with(character))
        .unwrap_or("?")
}

fn place(span: proc_macro2::Span, ruler: &mut Ruler) -> Span {
    let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let mut position = |at: proc_macro2::LineColumn| Position {
        line: number(at.line),
        column: number(at.column + 1),
        offset: number(ruler.offset(at)),
    };
    Span {
        library: false,
        start: position(span.start()),
        end: position(span.end()),
    }
}
