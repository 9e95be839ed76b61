//! Values as bytes, between two programs on one machine that were built from the same
//! sources.
//!
//! In:  values.
//! Out: bytes, and the values read back to the same bits.
//!
//! Not here: what the values mean ([`message`]).

mod message;
mod record;
#[cfg(test)]
mod tests;

pub(crate) use message::{Answer, Question, Reply, Request};

use std::io::{self, Read, Write};
use std::time::Duration;

/// A value that can be sent.
pub(crate) trait Wire: Sized {
    /// Appends the value's bytes.
    fn put(&self, out: &mut Vec<u8>);
    /// Takes a value from the front of bytes; `None` if they don't begin with one.
    fn take(from: &mut &[u8]) -> Option<Self>;
}

/// Sends a value.
///
/// # Errors
///
/// What the system says.
pub(crate) fn send(out: &mut impl Write, value: &impl Wire) -> io::Result<()> {
    let mut bytes = vec![0; size_of::<u64>()];
    value.put(&mut bytes);
    let length = (bytes.len() - size_of::<u64>()) as u64;
    bytes[..size_of::<u64>()].copy_from_slice(&length.to_le_bytes());
    out.write_all(&bytes)
}

/// The bytes of [`Reply::Row`], instead of what was there. Rows are most of what is sent.
#[inline]
pub(crate) fn row(values: &[f64], bytes: &mut Vec<u8>) {
    const VARIANT: u64 = 1;
    let count = values.len() as u64;
    let head = [8 * (count + 2), VARIANT, count];
    bytes.clear();
    bytes.extend(head.iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
}

/// Receives a value.
///
/// # Errors
///
/// What the system says, also if the other end has gone or sends something else.
pub(crate) fn receive<W: Wire>(from: &mut impl Read) -> io::Result<W> {
    let mut length = [0; size_of::<u64>()];
    from.read_exact(&mut length)?;
    let mut bytes = Vec::new();
    let length = u64::from_le_bytes(length);
    from.take(length).read_to_end(&mut bytes)?;
    let mut rest = &bytes[..];
    W::take(&mut rest)
        .filter(|_| rest.is_empty() && bytes.len() as u64 == length)
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "these bytes are no message"))
}

impl Wire for u64 {
    fn put(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.to_le_bytes());
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let (bytes, rest) = from.split_first_chunk()?;
        *from = rest;
        Some(Self::from_le_bytes(*bytes))
    }
}

/// Sends a type as another one.
macro_rules! sent_as {
    ($($kind:ty as $other:ty: $to:expr, $back:expr;)*) => {$(
        impl Wire for $kind {
            fn put(&self, out: &mut Vec<u8>) {
                let to: fn(&$kind) -> $other = $to;
                to(self).put(out);
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                let back: fn($other) -> Option<$kind> = $back;
                back(<$other>::take(from)?)
            }
        }
    )*};
}

sent_as! {
    f64 as u64: |x| x.to_bits(), |bits| Some(f64::from_bits(bits));
    usize as u64: |x| *x as u64, |x| usize::try_from(x).ok();
    u32 as u64: |x| u64::from(*x), |x| u32::try_from(x).ok();
    bool as u64: |x| u64::from(*x), |x| match x { 0 => Some(false), 1 => Some(true), _ => None };
    u8 as u64: |x| u64::from(*x), |x| u8::try_from(x).ok();
    Duration as (u64, u32): |x| (x.as_secs(), x.subsec_nanos()),
        |(secs, nanos)| (nanos < 1_000_000_000).then(|| Duration::new(secs, nanos));
}

impl Wire for String {
    fn put(&self, out: &mut Vec<u8>) {
        self.len().put(out);
        out.extend_from_slice(self.as_bytes());
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::take(from)?;
        let (text, rest) = from.split_at_checked(length)?;
        *from = rest;
        String::from_utf8(text.to_vec()).ok()
    }
}

/// What stays the same while the program runs. It is kept until its end: a program reads
/// one structure for each mechanism that it starts.
impl Wire for &'static str {
    fn put(&self, out: &mut Vec<u8>) {
        (*self).to_string().put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(String::take(from)?.leak())
    }
}

impl<W: Wire> Wire for Vec<W> {
    fn put(&self, out: &mut Vec<u8>) {
        self.len().put(out);
        self.iter().for_each(|entry| entry.put(out));
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::take(from)?;
        (0..length).map(|_| W::take(from)).collect()
    }
}

/// As that of text.
impl<W: Wire + Clone + 'static> Wire for &'static [W] {
    fn put(&self, out: &mut Vec<u8>) {
        self.to_vec().put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(Vec::take(from)?.leak())
    }
}

impl<W: Wire> Wire for Option<W> {
    fn put(&self, out: &mut Vec<u8>) {
        self.is_some().put(out);
        if let Some(value) = self {
            value.put(out);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match bool::take(from)? {
            true => W::take(from).map(Some),
            false => Some(None),
        }
    }
}

impl<W: Wire, E: Wire> Wire for Result<W, E> {
    fn put(&self, out: &mut Vec<u8>) {
        self.is_ok().put(out);
        match self {
            Ok(value) => value.put(out),
            Err(error) => error.put(out),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match bool::take(from)? {
            true => W::take(from).map(Ok),
            false => E::take(from).map(Err),
        }
    }
}

impl<A: Wire, B: Wire> Wire for (A, B) {
    fn put(&self, out: &mut Vec<u8>) {
        self.0.put(out);
        self.1.put(out);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some((A::take(from)?, B::take(from)?))
    }
}
