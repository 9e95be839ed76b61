//! Short names for texts.

/// A short name for a text: the hash of Fowler, Noll and Vo (FNV-1a, 64 bits).
pub fn hash<'a>(parts: impl IntoIterator<Item = &'a str>) -> u64 {
    // What ends a part occurs in no text.
    let bytes = |part: &'a str| part.bytes().chain([0xff]);
    let step = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    parts
        .into_iter()
        .flat_map(bytes)
        .fold(0xcbf2_9ce4_8422_2325, step)
}
