//! A message of limited length that C can read.
//!
//! In:  anything that can be displayed.
//! Out: text that ends with a zero, in a place of its own: nothing is allocated.

use core::ffi::CStr;
use core::fmt::{Display, Write};

/// Bytes of a message, the last zero included.
const ROOM: usize = 2048;

/// A message.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    bytes: [u8; ROOM],
    length: usize,
    /// Whether it is of the call that is at work.
    pub(crate) is_new: bool,
}

impl Text {
    /// No message.
    pub(crate) fn new() -> Self {
        Self {
            bytes: [0; ROOM],
            length: 0,
            is_new: false,
        }
    }

    /// Forgets the message.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
        self.bytes[0] = 0;
    }

    /// Replaces the message; what there is no room for is left out.
    pub(crate) fn say(&mut self, message: &dyn Display) {
        self.clear();
        self.is_new = true;
        let _cut_off = write!(self, "{message}");
    }

    /// The message, for C.
    pub(crate) fn as_c(&self) -> &CStr {
        CStr::from_bytes_until_nul(&self.bytes).unwrap_or_default()
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        // Letters stay whole, and a zero would end the message.
        for letter in text.chars().filter(|letter| *letter != '\0') {
            let end = self.length + letter.len_utf8();
            if end >= ROOM {
                return Err(core::fmt::Error);
            }
            letter.encode_utf8(&mut self.bytes[self.length..end]);
            self.length = end;
            self.bytes[end] = 0;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{ROOM, Text};

    #[test]
    fn a_long_message_is_cut_between_letters() {
        let mut text = Text::new();
        text.say(&"ä".repeat(ROOM));
        let said = text.as_c().to_str().expect("whole letters");
        assert_eq!(said.len(), ROOM - 2);
        text.say(&"a\0b");
        assert_eq!(text.as_c(), c"ab");
    }
}
