//! Where a line and a column are, in bytes.
//!
//! In:  a text; lines and columns, as they rise.
//! Out: offsets. All of them together take one walk through the text.

use proc_macro2::LineColumn;

/// A walk through a text.
pub struct Ruler<'a> {
    source: &'a str,
    at: LineColumn,
    offset: usize,
}

/// Lines count from 1, columns from 0, in characters.
const BEGIN: LineColumn = LineColumn { line: 1, column: 0 };

impl<'a> Ruler<'a> {
    /// At the beginning of a text.
    pub fn new(source: &'a str) -> Self {
        Self {
            source,
            at: BEGIN,
            offset: 0,
        }
    }

    /// The offset of a place, the end of the text for what lies beyond it. A place before the
    /// last one costs a walk from the beginning.
    pub fn offset(&mut self, place: LineColumn) -> usize {
        if place < self.at {
            (self.at, self.offset) = (BEGIN, 0);
        }
        let rest = self.source.get(self.offset..).unwrap_or_default();
        for character in rest.chars() {
            if self.at >= place {
                break;
            }
            self.offset += character.len_utf8();
            match character {
                '\n' => (self.at.line, self.at.column) = (self.at.line + 1, 0),
                _ => self.at.column += 1,
            }
        }
        self.offset
    }
}

#[cfg(test)]
mod tests {
    use super::Ruler;
    use proc_macro2::{LineColumn, TokenStream, TokenTree};

    /// Places of the tokens of a text: line and column, and the bytes as the lexer counts them.
    fn places(source: &str) -> Vec<(LineColumn, usize)> {
        let stream: TokenStream = source.parse().expect("tokens");
        let ends = |tree: TokenTree| {
            let (span, bytes) = (tree.span(), tree.span().byte_range());
            [(span.start(), bytes.start), (span.end(), bytes.end)]
        };
        stream.into_iter().flat_map(ends).collect()
    }

    #[test]
    fn offsets_are_those_of_the_lexer_in_any_order() {
        let source = "größe = 2.5\r\n\n\tθ+ω /* π\n */ \"λ\"\n(a\n[b]) x";
        let places = places(source);
        assert!(places.len() > 10);
        let mut ruler = Ruler::new(source);
        for (place, offset) in places.iter().chain(places.iter().rev()) {
            assert_eq!(ruler.offset(*place), *offset, "{place:?}");
        }
        let beyond = LineColumn { line: 9, column: 0 };
        assert_eq!(ruler.offset(beyond), source.len());
    }
}
