//! Numbers as text that reads back to the same bits.
//!
//! In:  a number.
//! Out: its shortest digits.

/// A number in the fewest digits that read back to the same bits.
pub fn exact(value: f64) -> String {
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_string(),
        None => text,
    }
}
