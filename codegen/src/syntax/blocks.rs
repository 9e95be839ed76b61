//! Braces of blocks that are missing, or that close too much.
//!
//! In:  the words that begin statements, and the braces, in order.
//! Out: which closing brace belongs to a block that was never opened, and which one closes the
//!      mechanism although statements follow.

use crate::diagnostic::Span;

/// Words that a block belongs to.
const WORDS: [&str; 4] = ["mechanism", "start", "for", "part"];

/// What is known of blocks so far.
#[derive(Debug, Default)]
pub struct Blocks {
    /// Where words stand whose block has not been opened yet.
    unopened: Vec<usize>,
    /// A brace that closes such a block.
    pub taken: Option<Span>,
    /// The brace that closes the first block which stands in no other.
    closed: Option<Span>,
    /// Where the first thing stands behind that.
    behind: Option<usize>,
}

impl Blocks {
    /// Hears of something that is neither a blank nor a comment.
    pub fn hear(&mut self, text: &str, at: usize, begins: bool) {
        if self.closed.is_some() {
            self.behind.get_or_insert(at);
        }
        let rest = text.get(at..).unwrap_or("");
        // What is called like such a word is followed by a sign.
        let is_one = |word: &str| {
            let behind = rest.strip_prefix(word).unwrap_or("");
            let next = behind.trim_start();
            let named = next.len() < behind.len();
            next.starts_with(|c: char| c == '{' || named && c.is_ascii_alphabetic())
        };
        if begins && WORDS.iter().any(|word| is_one(word)) {
            self.unopened.push(at);
        }
    }

    /// Hears of an opening brace.
    pub fn open(&mut self) {
        self.unopened.pop();
    }

    /// Whether a closing brace belongs to a block whose opening one is missing behind the
    /// innermost bracket that is open.
    pub fn takes(&mut self, innermost: Option<usize>, brace: Span) -> bool {
        let missing = self.unopened.last();
        let is_missing = missing.is_some_and(|at| innermost.is_none_or(|open| open < *at));
        if is_missing {
            self.unopened.pop();
            self.taken = Some(brace);
        }
        is_missing
    }

    /// Hears of a brace that closes a block which stands in no other.
    pub fn close(&mut self, brace: Span) {
        if self.unopened.is_empty() {
            self.closed.get_or_insert(brace);
        }
    }

    /// The brace that closed the mechanism too early, where another one closes nothing: that
    /// one closes the mechanism now.
    pub fn too_early(&mut self, text: &str, brace: Span) -> Option<Span> {
        let behind = text.get(self.behind?..)?;
        if behind.starts_with(WORDS[0]) {
            return None;
        }
        self.behind = None;
        self.closed.replace(brace)
    }
}
