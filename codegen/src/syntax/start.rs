//! The `start` block: values that are held, guesses, and `for` over them.

use super::ast::StartItem;
use super::cursor::{Cursor, Parsed};

const HELP: &str = "an entry is written `q1 = 45*deg;` (held) or `q2 ~ 0.7;` (a guess)";

impl Cursor<'_> {
    /// Reads `{ entries }`.
    pub fn start_block(&mut self) -> Parsed<Vec<StartItem>> {
        self.expect_symbol("{", HELP)?;
        let depth = self.block_depth();
        let mut items = Vec::new();
        while !self.at_block_end(depth) {
            let is_block = |item: &StartItem| matches!(item, StartItem::For(..));
            items.extend(self.statement(depth, Self::start_item, is_block));
        }
        self.expect_symbol("}", "")?;
        Ok(items)
    }

    fn start_item(&mut self) -> Parsed<StartItem> {
        if self.take_word("for") {
            let range = self.range("repetition is written `for i in 0..K { … }`")?;
            let items = self.deeper(Self::start_block)?;
            return Ok(StartItem::For(range, items));
        }
        let target = self.expression()?;
        let held = self.at_symbol("=");
        if !held && !self.at_symbol("~") {
            return Err(self.unexpected("`=` or `~`", HELP));
        }
        self.advance();
        let value = self.expression()?;
        if !self.at_symbol("}") {
            self.expect_symbol(";", HELP)?;
        }
        Ok(StartItem::Entry {
            target,
            held,
            value,
        })
    }
}
