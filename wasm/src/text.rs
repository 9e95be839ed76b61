//! Text in a place that doesn't move.
//!
//! In:  what is written.
//! Out: its bytes, and whether all of it had room.

use core::fmt::{Result, Write};

/// Bytes that there is room for: the longest description of a mechanism by far.
const ROOM: usize = 1 << 16;

/// A text of limited length.
pub struct Text {
    bytes: [u8; ROOM],
    length: usize,
}

impl Text {
    /// Bytes that there is room for.
    #[cfg(test)]
    pub const ROOM: usize = ROOM;

    /// An empty text.
    #[expect(
        clippy::new_without_default,
        reason = "too large for one to be made in passing"
    )]
    pub fn new() -> Self {
        Self {
            bytes: [0; ROOM],
            length: 0,
        }
    }

    /// Forgets what was written.
    pub fn clear(&mut self) {
        self.length = 0;
    }

    /// What was written.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> Result {
        let end = self.length + text.len();
        let room = self.bytes.get_mut(self.length..end);
        room.ok_or(core::fmt::Error)?
            .copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}
